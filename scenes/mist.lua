-- Mist: a thin layer over the ground, and three denser bodies of it on plinths.
-- Look for: columns that fade with the distance and towards their feet; the ball, the block and the ring of mist, which
-- are denser to the eye the longer the way through them is; the lamp that shines out of one; two that overlap; shadows,
-- to which the mist adds nothing.
-- 480x270, 196 camera samples a pixel: some twenty seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

put(scene, gr.plane('ground'), gr.material({ 0.26, 0.30, 0.24 }, { 0, 0, 0 }, 1))

-- An avenue of columns.
local stone = gr.material({ 0.66, 0.62, 0.55 }, { 0.1, 0.1, 0.1 }, 10)
local column = gr.node('column')
local shaft = put(column, gr.cylinder('shaft'), stone)
shaft:scale(0.26, 1.3, 0.26)
shaft:translate(0, 1.5, 0)
for _, y in ipairs { 0.1, 2.9 } do
  local slab = put(column, gr.cube('slab'), stone)
  slab:translate(-0.5, -0.5, -0.5)
  slab:scale(0.8, 0.2, 0.8)
  slab:translate(0, y, 0)
end
for row = 0, 8 do
  for side = -1, 1, 2 do
    local place = gr.node('place')
    place:add_child(column)
    place:translate(2.1 * side, 0, 1.0 - 2.4 * row)
    scene:add_child(place)
  end
end

-- The layer of ground mist is a flat box, 1.1 high.
local layer = put(scene, gr.cube('layer'), gr.volumetric_material({ 0.72, 0.76, 0.82 }, { 0, 0, 0 }, 1, 0.10))
layer:translate(-0.5, 0, -1)
layer:scale(60, 1.1, 47)
layer:translate(0, 0.01, 8.2)
-- A second, thin one fills the whole avenue behind the first columns, over and in the first.
local haze = put(scene, gr.cube('haze'), gr.volumetric_material({ 0.66, 0.72, 0.82 }, { 0, 0, 0 }, 1, 0.035))
haze:translate(-0.5, 0, -1)
haze:scale(60, 7, 44)
haze:translate(0, 0.02, 1.5)

-- Three plinths with bodies of mist.
local function plinth(x, z)
  local block = put(scene, gr.cube('plinth'), stone)
  block:translate(-0.5, 0, -0.5)
  block:scale(0.85, 0.5, 0.85)
  block:rotate('y', 20)
  block:translate(x, 0, z)
end
local rose = gr.volumetric_material({ 0.95, 0.55, 0.50 }, { 0, 0, 0 }, 1, 1.0)
local blue = gr.volumetric_material({ 0.45, 0.62, 0.95 }, { 0, 0, 0 }, 1, 1.0)
plinth(-1.15, 1.7)
local ball = put(scene, gr.sphere('ball'), rose)
ball:scale(0.5, 0.5, 0.5)
ball:translate(-1.15, 1.1, 1.7)
plinth(0.1, 0.7)
local ring = put(scene, gr.torus('ring', 0.42, 0.24), gr.volumetric_material({ 0.95, 0.9, 0.7 }, { 0, 0, 0 }, 1, 1.0))
ring:rotate('x', 80)
ring:translate(0.1, 1.2, 0.7)
plinth(1.25, 1.7)
for i, turn in ipairs { 0, 45 } do
  local cube = put(scene, gr.cube('cube'), i == 1 and blue or rose)
  cube:translate(-0.5, 0, -0.5)
  cube:scale(0.62, 0.85, 0.62)
  cube:rotate('y', turn)
  cube:translate(1.25, 0.52, 1.7)
end

local moon = gr.light({ -8, 10, 6 }, { 0.56, 0.58, 0.62 }, { 1, 0, 0 })
local lamp = gr.light({ 0.1, 1.2, 0.7 }, { 0.75, 0.52, 0.26 }, { 0.5, 0, 1.2 })

gr.background { bottom = { 0.62, 0.68, 0.76 }, top = { 0.26, 0.36, 0.54 } }
gr.render(scene, 'mist.png', 480, 270,
  { 0.35, 1.9, 7.0 }, { 0.05, 1.15, 0 }, { 0, 1, 0 }, 34,
  { 0.28, 0.29, 0.32 }, { moon, lamp },
  14) -- AA
