-- A turntable: Suzanne and two small bunnies on a revolving wooden disc, once around in 60 frames.
-- Look for: FRAME 60, which is FRAME 0 again; the glossy black rim, which mirrors them; highlights and shadows that
-- stay where the lamp is while everything turns.
-- 320x240, 16 camera samples a pixel: three seconds on two CPU cores.

local turn = 6 * gr.frame_cmd()
local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

local table_top = gr.node('table')
local disc = put(table_top, gr.cylinder('disc'), gr.material { texture = 'assets/floor.png',
  specular = { 0.2, 0.2, 0.2 }, shininess = 30 })
disc:scale(1.6, 0.06, 1.6)
disc:translate(0, -0.06, 0)
local rim = put(table_top, gr.torus('rim', 1.62, 0.07),
  gr.material { diffuse = { 0.03, 0.03, 0.03 }, specular = { 0.6, 0.6, 0.6 }, shininess = 80, reflection = 0.35,
  glossy = 0.05 })
rim:translate(0, -0.06, 0)
for i = 0, 11 do
  local stud = put(table_top, gr.sphere('stud'), gr.material { diffuse = { 0.75, 0.55, 0.18 },
    specular = { 0.6, 0.5, 0.3 }, shininess = 60 })
  stud:scale(0.035, 0.035, 0.035)
  stud:translate(1.47, 0.01, 0)
  stud:rotate('y', 30 * i)
end

local suzanne = put(table_top, gr.mesh('suzanne', 'assets/suzanne.obj'),
  gr.material { diffuse = { 0.20, 0.46, 0.48 }, specular = { 0.5, 0.5, 0.5 }, shininess = 50 })
suzanne:scale(1.25, 1.25, 1.25)
suzanne:translate(-0.1, 0, 0)
for k, place in ipairs { { 1.02, 0.42, 115 }, { 0.30, -1.05, 200 } } do
  local bunny = put(table_top, gr.mesh('bunny', 'assets/bunny.obj'),
    gr.material { diffuse = k == 1 and { 0.80, 0.62, 0.42 } or { 0.72, 0.30, 0.28 }, specular = { 0.2, 0.2, 0.2 },
      shininess = 20 })
  bunny:scale(0.52, 0.52, 0.52)
  bunny:rotate('y', place[3])
  bunny:translate(place[1], 0, place[2])
end
table_top:rotate('y', turn)
table_top:translate(0, 0.25, 0)
scene:add_child(table_top)

put(scene, gr.plane('ground'), gr.material { diffuse = { 0.62, 0.60, 0.57 } })
local foot = put(scene, gr.cone('foot'), gr.material { diffuse = { 0.10, 0.10, 0.11 },
  specular = { 0.3, 0.3, 0.3 }, shininess = 30 })
foot:scale(0.8, 0.5, 0.8)
foot:translate(0, 0.5, 0)

local lamp = gr.sphere_light { position = { -4, 6.5, 4 }, radius = 0.7, colour = { 0.95, 0.90, 0.82 } }
local fill = gr.light { position = { 6, 3, 3 }, colour = { 0.14, 0.18, 0.26 } }
gr.background { bottom = { 0.60, 0.58, 0.56 }, top = { 0.44, 0.52, 0.66 } }
gr.render {
  scene = scene, output = 'turntable.png', size = { 320, 240 }, samples = 16,
  camera = { eye = { 0, 2.5, 6.2 }, look_at = { 0, 0.72, 0 }, fov = 33 }, lights = { lamp, fill },
  ambient = { 0.36, 0.36, 0.39 },
}
