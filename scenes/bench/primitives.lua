-- Benchmark: 59 analytic shapes on a plane under one square light, mirrors and water; the twin of
-- benches/peers/primitives.pov, shape for shape (POV-Ray's axes are left-handed: z is the opposite here).
-- 320x240, 16 camera samples a pixel, each with 16 shadow rays at its first hit.

local scene = gr.node('scene')

local function put(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

local function matte(r, g, b)
  return gr.material { diffuse = { 0.7 * r, 0.7 * g, 0.7 * b }, specular = { 0.5, 0.5, 0.5 }, shininess = 40 }
end

local function mirror(r, g, b)
  return gr.material {
    diffuse = { 0.3 * r, 0.3 * g, 0.3 * b }, specular = { 0.8, 0.8, 0.8 }, shininess = 80, reflection = 0.6,
  }
end

local silver, red, blue = mirror(0.8, 0.8, 0.85), matte(0.8, 0.3, 0.2), matte(0.2, 0.5, 0.8)
local gold, green = mirror(0.9, 0.7, 0.1), matte(0.4, 0.8, 0.4)
-- POV-Ray lets light through what is clear.
local water = gr.material { diffuse = { 0.05, 0.05, 0.05 }, reflection = 1, ior = 1.33, casts_shadow = false }

put(gr.plane('ground'), gr.material { diffuse = { 0.4, 0.44, 0.4 } })
local kinds = { [0] = silver, water, red }
for i = -2, 2 do
  for j = -2, 2 do
    local ball = put(gr.sphere('ball'), kinds[(i + j + 10) % 3])
    ball:scale(0.6, 0.6, 0.6)
    ball:translate(i * 2.2, 0.6, -j * 2.2)
  end
end
for i = -1, 1 do
  for j = -1, 1 do
    local post = put(gr.cylinder('post'), blue)
    post:scale(0.3, 0.6, 0.3)
    post:translate(i * 2.2 + 1.1, 0.6, -(j * 2.2 + 1.1))
    local ring = put(gr.torus('ring', 0.5, 0.15), gold)
    ring:translate(i * 2.2 + 1.1, 1.5, -(j * 2.2 + 1.1))
  end
end
for i = 0, 15 do
  local box = put(gr.cube('box'), green)
  box:translate(-0.5, 0, -0.5)
  box:scale(0.6, 0.5 + i % 4 * 0.4, 0.6)
  box:rotate('y', -17 * i)
  box:translate(math.cos(i * math.pi / 8) * 7.5, 0, -math.sin(i * math.pi / 8) * 7.5)
end

local lamp = gr.area_light { position = { 8, 14, 10 }, colour = { 0.9, 0.9, 0.9 }, u = { 3, 0, 0 }, v = { 0, 0, 3 } }

gr.render {
  scene = scene, output = 'primitives.png', size = { 320, 240 },
  camera = { eye = { 0, 6, 14 }, look_at = { 0, 0.5, 0 }, fov = 38.55 },
  ambient = { 0.2, 0.2, 0.2 }, lights = { lamp },
  samples = 16, shadow = 16, max_depth = 5,
  background = { 0.3, 0.45, 0.7 },
  transfer = 'srgb',
}
