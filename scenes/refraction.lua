-- Refraction: five balls of growing index, a pencil in a tank of water, a prism and a magnifying glass.
-- Look for: the balls, from index 1 (there is nothing to see) by ice, glass and sapphire to diamond, which bend the
-- wall more and more; the pencil, broken at the water; the prism's two images; the squares larger through the lens.
-- 640x360, 16 camera samples a pixel: under ten seconds on two CPU cores.

-- A mesh from a table alone would mean the transform order of old scenes.
gr.conventions { transforms = 'pre' }

local function transparent(ior)
  return gr.refl_material({ 0, 0, 0 }, { 0.7, 0.7, 0.7 }, 250, 1, 0, ior)
end

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

put(scene, gr.plane('table'), gr.material({ 0.68, 0.52, 0.38 }, { 0, 0, 0 }, 1))

-- A wall of squares: blue ones on white.
local wall = put(scene, gr.plane('wall'), gr.material({ 0.86, 0.85, 0.80 }, { 0, 0, 0 }, 1))
wall:rotate('x', 90)
wall:translate(0, 0, -2)
local square = gr.cube('square')
square:set_material(gr.material({ 0.16, 0.34, 0.56 }, { 0, 0, 0 }, 1))
square:scale(0.4, 0.4, 0.01)
for row = 0, 9 do
  for column = -12, 11 do
    if (row + column) % 2 == 0 then
      local place = gr.node('place')
      place:add_child(square)
      place:translate(0.4 * column, 0.4 * row, -2)
      scene:add_child(place)
    end
  end
end

-- Five balls on stands.
local brass = gr.refl_material({ 0.55, 0.38, 0.10 }, { 0.7, 0.6, 0.3 }, 50, 0.2)
for i, ior in ipairs { 1, 1.31, 1.5, 1.77, 2.42 } do
  local x = 1.06 * (i - 3)
  put(scene, gr.nh_sphere('ball', { x, 1.65, -0.6 }, 0.46), transparent(ior))
  local stand = put(scene, gr.cylinder('stand'), brass)
  stand:scale(0.05, 0.58, 0.05)
  stand:translate(x, 0.58, -0.6)
  local ring = put(scene, gr.torus('ring', 0.2, 0.035), brass)
  ring:translate(x, 1.2, -0.6)
end

-- A block of water, and a pencil that leans in it and out of its top. Nothing lights what is inside but the ambient
-- light and a small lamp of its own: solids cast full shadows, glass and water too.
local tank = put(scene, gr.cube('water'), transparent(1.333))
tank:scale(1.5, 0.72, 0.8)
tank:translate(-2.3, 0.01, 0.45)
local pencil = gr.node('pencil')
local paint = gr.material({ 0.92, 0.60, 0.10 }, { 0.4, 0.4, 0.4 }, 50)
local shaft = put(pencil, gr.cylinder('shaft'), paint)
shaft:scale(0.065, 0.62, 0.065)
shaft:translate(0, 0.90, 0)
local bare = put(pencil, gr.cone('bare'), gr.material({ 0.88, 0.74, 0.54 }, { 0.1, 0.1, 0.1 }, 10))
bare:scale(0.065, -0.28, 0.065)
local tip = put(pencil, gr.cone('tip'), paint)
tip:scale(0.025, -0.11, 0.025)
tip:translate(0, -0.003, 0)
pencil:rotate('z', -48)
pencil:translate(-2.0, 0.05, 0.85)
scene:add_child(pencil)

-- A prism: six corners, five faces.
local prism = put(scene, gr.mesh('prism',
  { { -0.6, 0, 0.35 }, { 0.6, 0, 0.35 }, { 0.6, 0, -0.35 }, { -0.6, 0, -0.35 }, { -0.6, 0.62, 0 }, { 0.6, 0.62, 0 } },
  { { 0, 1, 5, 4 }, { 2, 3, 4, 5 }, { 1, 2, 5 }, { 3, 0, 4 }, { 3, 2, 1, 0 } }), transparent(1.5))
prism:rotate('y', 65)
prism:translate(0.05, 0.01, 1.15)

-- A magnifying glass: a flattened ball in a ring.
local lens = gr.node('lens')
put(lens, gr.sphere('glass'), transparent(1.5)):scale(0.5, 0.5, 0.045)
put(lens, gr.torus('rim', 0.5, 0.04), brass):rotate('x', 90)
local handle = put(lens, gr.cylinder('handle'), gr.material({ 0.16, 0.10, 0.08 }, { 0.5, 0.5, 0.5 }, 60))
handle:scale(0.06, 0.32, 0.06)
handle:translate(0, -0.84, 0)
lens:rotate('z', -46)
lens:rotate('y', -14)
lens:translate(2.15, 0.62, 0.7)
scene:add_child(lens)

local key = gr.light({ -1.0, 4.6, 9 }, { 0.45, 0.43, 0.40 }, { 1, 0, 0 })
local fill = gr.light({ 3, 5, 8 }, { 0.18, 0.19, 0.22 }, { 1, 0, 0 })
local inside = gr.light({ -1.2, 0.6, 1.1 }, { 0.8, 0.8, 0.8 }, { 1, 0, 0.8 })

gr.render(scene, 'refraction.png', 640, 360,
  { 0, 1.9, 6.6 }, { 0, 1.0, 0 }, { 0, 1, 0 }, 27,
  { 0.52, 0.52, 0.54 }, { key, fill, inside },
  4) -- AA
