-- Benchmark: 1,000 tori of all proportions, tumbled over a plane under a square light.
-- 640x360, 16 camera samples a pixel, each with 4 shadow rays at its first hit.

local scene = gr.node('scene')
local colours = { { 0.8, 0.3, 0.2 }, { 0.2, 0.5, 0.8 }, { 0.9, 0.7, 0.2 }, { 0.4, 0.7, 0.4 } }
local materials = {}
for i, colour in ipairs(colours) do
  materials[i] = gr.material {
    diffuse = colour, specular = { 0.4, 0.4, 0.4 }, shininess = 40, reflection = i == 3 and 0.4 or 0,
  }
end
for i = 0, 999 do
  local column, row = i % 40, i // 40
  local ring = gr.torus('ring', 0.45, 0.03 + 0.2 * (i * 7 % 11) / 11)
  ring:set_material(materials[i % 4 + 1])
  ring:rotate('x', i * 37 % 180)
  ring:rotate('y', i * 61 % 360)
  ring:translate((column - 19.5) * 1.1, 0.7, -row * 1.1)
  scene:add_child(ring)
end
local ground = gr.plane('ground')
ground:set_material(gr.material { diffuse = { 0.5, 0.5, 0.5 } })
scene:add_child(ground)

gr.render {
  scene = scene, output = 'torus-field.png', size = { 640, 360 },
  camera = { eye = { 0, 9, 12 }, look_at = { 0, 0, -8 }, fov = 45 },
  ambient = { 0.2, 0.2, 0.2 },
  lights = { gr.area_light { position = { 12, 20, 12 }, colour = { 0.8, 0.8, 0.8 }, u = { 4, 0, 0 }, v = { 0, 0, 4 } } },
  samples = 16, shadow = 4, max_depth = 5,
  background = { 0.5, 0.65, 0.8 },
}
