-- Soft shadows: a sundial, a fence and a hoop under two square lights, one warm and one cool.
-- Look for: shadows that are sharp where a post meets the ground and soft at its tip; the umbra, in which neither half
-- of a light is seen, within the penumbra; two shadows of each thing, each lit by the other light's colour.
-- 480x270, 9 camera samples a pixel, each with 9 shadow rays to 2 lights: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

local white = gr.material({ 0.80, 0.79, 0.76 }, { 0, 0, 0 }, 1)
put(scene, gr.plane('ground'), white)

-- The sundial: a disc with twelve studs and a gnomon.
local brass = gr.refl_material({ 0.56, 0.40, 0.12 }, { 0.7, 0.6, 0.3 }, 50, 0.15)
local stone = gr.material({ 0.62, 0.60, 0.57 }, { 0.1, 0.1, 0.1 }, 10)
local dial = gr.node('dial')
local disc = put(dial, gr.cylinder('disc'), stone)
disc:scale(1.1, 0.1, 1.1)
disc:translate(0, 0.1, 0)
for i = 1, 12 do
  local stud = put(dial, gr.cylinder('stud'), brass)
  stud:scale(i % 3 == 0 and 0.08 or 0.05, 0.02, i % 3 == 0 and 0.08 or 0.05)
  stud:translate(0.92, 0.22, 0)
  stud:rotate('y', 30 * i)
end
local gnomon = put(dial, gr.cone('gnomon'), brass)
gnomon:scale(0.09, 1.5, 0.09)
gnomon:translate(0, 1.7, 0)
dial:translate(-1.75, 0, 0.35)
scene:add_child(dial)

-- A picket fence that runs towards the viewer: the same gap, a longer way to the ground.
local red = gr.material({ 0.76, 0.22, 0.16 }, { 0.3, 0.3, 0.3 }, 40)
for i = 0, 8 do
  local picket = put(scene, gr.cylinder('picket'), red)
  local height = 0.3 + 0.17 * i
  picket:scale(0.035, height / 2, 0.035)
  picket:translate(0.18 * i, height / 2, -1.0 + 0.02 * i)
end

-- A hoop and a ball that float: no sharp shadow anywhere.
local hoop = put(scene, gr.torus('hoop', 0.42, 0.07), gr.material({ 0.18, 0.46, 0.60 }, { 0.4, 0.4, 0.4 }, 50))
hoop:rotate('z', 20)
hoop:translate(1.75, 0.8, 0.9)
put(scene, gr.nh_sphere('ball', { 0.35, 0.26, 1.25 }, 0.26), gr.material({ 0.90, 0.68, 0.20 }, { 0.4, 0.4, 0.4 }, 50))
put(scene, gr.nh_sphere('bead', { -0.2, 1.0, -0.75 }, 0.16), gr.material({ 0.42, 0.62, 0.30 }, { 0.4, 0.4, 0.4 }, 50))

local warm = gr.light({ -3.4, 3.6, 2.2 }, { 0.84, 0.68, 0.47 }, { 1, 0, 0 })
local cool = gr.light({ 2.6, 3.8, 3.0 }, { 0.38, 0.49, 0.68 }, { 1, 0, 0 })

gr.render(scene, 'soft-shadows.png', 480, 270,
  { 0.1, 3.3, 5.9 }, { 0, 0.42, 0 }, { 0, 1, 0 }, 32,
  { 0.13, 0.13, 0.15 }, { warm, cool },
  3, 1, 9) -- AA, GLOSSY, SHADOW
