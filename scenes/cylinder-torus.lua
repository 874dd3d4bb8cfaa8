-- Cylinder and torus, whole and stretched: a colonnade around a fountain of rings.
-- Look for: the tori of different tubes, one with no hole left (R = r) and one so fat that it meets itself (R < r);
-- flat caps on the drums; highlights that stay smooth on the leaning, squashed rings; a ring reflected in a ring.
-- 640x360, 9 camera samples a pixel: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

local marble = gr.material({ 0.74, 0.70, 0.63 }, { 0.25, 0.25, 0.25 }, 40)
local dark = gr.material({ 0.30, 0.33, 0.38 }, { 0.4, 0.4, 0.4 }, 60)
local gold = gr.refl_material({ 0.62, 0.38, 0.07 }, { 0.9, 0.75, 0.4 }, 60, 0.35)
local teal = gr.refl_material({ 0.08, 0.36, 0.40 }, { 0.7, 0.7, 0.7 }, 90, 0.22)
local rose = gr.refl_material({ 0.62, 0.18, 0.20 }, { 0.7, 0.7, 0.7 }, 90, 0.15)

put(scene, gr.plane('ground'), gr.refl_material({ 0.46, 0.50, 0.52 }, { 0, 0, 0 }, 1, 0.12))

-- A column of a drum between two rings, with a flat cylinder above and below.
local column = gr.node('column')
local shaft = put(column, gr.cylinder('shaft'), marble)
shaft:scale(0.24, 1.15, 0.24)
shaft:translate(0, 1.35, 0)
for _, y in ipairs { 0.24, 2.46 } do
  local ring = put(column, gr.torus('ring', 0.26, 0.08), marble)
  ring:translate(0, y, 0)
end
for _, y in ipairs { 0.08, 2.62 } do
  local cap = put(column, gr.cylinder('cap'), marble)
  cap:scale(0.42, 0.08, 0.42)
  cap:translate(0, y, 0)
end

-- They stand in three quarters of a circle, under a torus squashed to a band.
for i = 0, 9 do
  local place = gr.node('place')
  place:add_child(column)
  place:translate(3.3, 0, 0)
  place:rotate('y', -22 + 224 * i / 9)
  scene:add_child(place)
end
local architrave = put(scene, gr.torus('architrave', 3.3, 0.34), marble)
architrave:scale(1, 0.5, 1)
architrave:translate(0, 2.87, 0)

-- The fountain: drums in steps, rings of growing tubes on them.
for i, step in ipairs { { 1.7, 0.12 }, { 1.35, 0.30 }, { 0.5, 0.85 } } do
  local drum = put(scene, gr.cylinder('drum'), i == 3 and dark or marble)
  drum:scale(step[1], step[2] / 2, step[1])
  drum:translate(0, step[2] / 2, 0)
end
local basin = put(scene, gr.torus('basin', 1.0, 0.18), teal)
basin:translate(0, 0.45, 0)
local horn = put(scene, gr.torus('horn', 0.35, 0.35), rose) -- R = r: the hole closes to a point
horn:scale(1, 0.8, 1)
horn:translate(0, 1.10, 0)
local great = put(scene, gr.torus('great', 0.78, 0.13), gold)
great:rotate('x', 90)
great:rotate('y', 30)
great:translate(0, 2.12, 0)
local small = put(scene, gr.torus('small', 0.42, 0.09), gold)
small:rotate('x', 60)
small:rotate('y', -50)
small:translate(0, 2.12, 0)

-- Outside, in front: a leaning stretched ring, an apple (R < r) and a rod through a ring.
local leaning = put(scene, gr.torus('leaning', 0.5, 0.14), teal)
leaning:scale(1, 1, 1.6)
leaning:rotate('x', 62)
leaning:rotate('y', 24)
leaning:translate(-2.65, 0.78, 2.1)
local apple = put(scene, gr.torus('apple', 0.17, 0.34), rose)
apple:translate(2.45, 0.34, 2.35)
local rod = put(scene, gr.cylinder('rod'), gold)
rod:scale(0.09, 0.6, 0.09)
rod:rotate('z', 78)
rod:translate(1.05, 0.22, 2.75)
local collar = put(scene, gr.torus('collar', 0.18, 0.07), teal)
collar:rotate('z', 78)
collar:translate(1.02, 0.24, 2.75)

local key = gr.light({ -5, 8, 7 }, { 0.86, 0.82, 0.73 }, { 1, 0, 0 })
local fill = gr.light({ 6, 4, 5 }, { 0.22, 0.25, 0.32 }, { 1, 0, 0 })

gr.render(scene, 'cylinder-torus.png', 640, 360,
  { 0.5, 5.0, 9.2 }, { 0, 0.98, 0 }, { 0, 1, 0 }, 31,
  { 0.28, 0.28, 0.31 }, { key, fill },
  3, 1, 2) -- AA, GLOSSY, SHADOW
