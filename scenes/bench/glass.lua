-- Benchmark: deep refraction. A stack of glass balls, each with a bubble, over a mirror and a row of posts: a ray passes
-- a dozen surfaces.
-- 480x360, 16 camera samples a pixel, up to 16 surfaces one after another.

local scene = gr.node('scene')

local function put(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

local glass = gr.material {
  diffuse = { 0, 0, 0 }, specular = { 0.6, 0.6, 0.6 }, shininess = 200, reflection = 1, ior = 1.5, casts_shadow = false,
}
local air = gr.material { diffuse = { 0, 0, 0 }, reflection = 1, ior = 1, casts_shadow = false }

for layer = 0, 2 do
  local edge = 3 - layer
  for i = 0, edge - 1 do
    for j = 0, edge - 1 do
      local x, z = (i - (edge - 1) / 2) * 2, (j - (edge - 1) / 2) * 2
      local y = 1 + layer * 1.42
      put(gr.nh_sphere('ball', { x, y, z }, 1), glass)
      put(gr.nh_sphere('bubble', { x, y, z }, 0.55), air)
    end
  end
end
put(gr.plane('table'), gr.material { diffuse = { 0.25, 0.25, 0.28 }, reflection = 0.5 })
for i = -6, 6 do
  local post = put(gr.cylinder('post'), gr.material { diffuse = { 0.5 + i / 14, 0.4, 0.5 - i / 14 } })
  post:scale(0.25, 2.5, 0.25)
  post:translate(i * 1.1, 2.5, -6)
end

gr.render {
  scene = scene, output = 'glass.png', size = { 480, 360 },
  camera = { eye = { 3, 4.5, 9 }, look_at = { 0, 1.8, 0 }, fov = 40 },
  ambient = { 0.25, 0.25, 0.25 },
  lights = { gr.sphere_light { position = { 5, 9, 6 }, colour = { 0.8, 0.8, 0.8 }, radius = 0.5 } },
  samples = 16, max_depth = 16,
  background = { bottom = { 0.9, 0.9, 0.85 }, top = { 0.25, 0.45, 0.8 } },
}
