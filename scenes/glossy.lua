-- Glossy reflection: a folding screen of five leaves, the first a mirror, each next one rougher, and pencils before it.
-- Look for: the mirror images, which are sharp where a pencil stands close to its leaf and blur with the distance;
-- the AREA of the glossy square goes 0, 0.06, 0.15, 0.35, 0.8 from left to right; the floor is a little glossy too.
-- 480x270, 16 camera samples a pixel, each with 6 glossy rays: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

put(scene, gr.plane('floor'), gr.refl_material({ 0.50, 0.47, 0.43 }, { 0, 0, 0 }, 1, 0.22, 0.12))

local frame = gr.material({ 0.20, 0.13, 0.09 }, { 0.3, 0.3, 0.3 }, 40)
for i, area in ipairs { 0, 0.06, 0.15, 0.35, 0.8 } do
  local leaf = gr.node('leaf')
  local plate = put(leaf, gr.cube('plate'), gr.refl_material({ 0.05, 0.05, 0.06 }, { 0.3, 0.3, 0.3 }, 40, 0.85, area))
  plate:translate(-0.5, 0, -0.5)
  plate:scale(1.24, 2.3, 0.06)
  plate:translate(0, 0.1, 0)
  for side = -1, 1, 2 do
    local post = put(leaf, gr.cylinder('post'), frame)
    post:scale(0.05, 1.25, 0.05)
    post:translate(0.64 * side, 1.25, 0)
  end
  -- The leaves stand along a shallow arc.
  leaf:translate(0, 0, -5.2)
  leaf:rotate('y', -15 * (i - 3))
  leaf:translate(0, 0, 3.6)
  scene:add_child(leaf)
end

-- A pencil of length 1, standing on its end.
local wood = gr.material({ 0.86, 0.70, 0.48 }, { 0.1, 0.1, 0.1 }, 10)
local function pencil(colour, height)
  local root = gr.node('pencil')
  local paint = gr.material(colour, { 0.4, 0.4, 0.4 }, 50)
  local shaft = put(root, gr.cylinder('shaft'), paint)
  shaft:scale(0.09, height / 2, 0.09)
  shaft:translate(0, height / 2, 0)
  local bare = put(root, gr.cone('bare'), wood)
  bare:scale(0.09, 0.28, 0.09)
  bare:translate(0, height + 0.28, 0)
  local tip = put(root, gr.cone('tip'), paint)
  tip:scale(0.036, 0.11, 0.036)
  tip:translate(0, height + 0.284, 0)
  return root
end
local colours = { { 0.86, 0.20, 0.16 }, { 0.93, 0.62, 0.12 }, { 0.24, 0.62, 0.28 }, { 0.16, 0.44, 0.78 },
  { 0.56, 0.26, 0.66 } }
-- Before each leaf one pencil close to it and one further off.
for i = 1, 5 do
  for j, distance in ipairs { 4.75, 3.7 } do
    local place = gr.node('place')
    place:add_child(pencil(colours[(i + 2 * j) % 5 + 1], j == 1 and 1.3 or 0.8))
    place:translate(j == 1 and -0.3 or 0.16, 0, -distance)
    place:rotate('y', -15 * (i - 3))
    place:translate(0, 0, 3.6)
    scene:add_child(place)
  end
end

-- Posts far behind the viewer, for all leaves to mirror.
for i = -9, 9 do
  local post = put(scene, gr.cylinder('post'), gr.material(colours[i % 5 + 1], { 0.3, 0.3, 0.3 }, 30))
  post:scale(0.45, 2, 0.45)
  post:translate(0, 2, 6)
  post:rotate('y', 13 * i + 5)
  post:translate(0, 0, 4)
end

local key = gr.light({ -3, 6, 6 }, { 0.80, 0.77, 0.70 }, { 1, 0, 0 })
local fill = gr.light({ 5, 4, 6 }, { 0.26, 0.29, 0.35 }, { 1, 0, 0 })

gr.render(scene, 'glossy.png', 480, 270,
  { 0, 2.0, 6.4 }, { 0, 1.08, -1.2 }, { 0, 1, 0 }, 30,
  { 0.30, 0.30, 0.33 }, { key, fill },
  4, 6, 1) -- AA, GLOSSY, SHADOW
