-- Benchmark: a forest of 12,000 spruces, each two instances (wood and needles) of one of three trees, on hills: 24,000
-- instances, tens of millions of triangles unrolled, under one sun.
-- 640x360, 4 camera samples a pixel, each with one shadow ray.

local tree = require('lib.tree')

local scene = gr.node('scene')
local bark = gr.material { diffuse = { 0.18, 0.12, 0.08 } }
local kinds = {}
for k, options in ipairs {
  { height = 9.5, reach = 1.9, radius = 0.17, bare = 0.07, boughs = 9, whorl = 0.36, spacing = 0.17 },
  { height = 8.0, reach = 1.9, radius = 0.16, bare = 0.04, boughs = 8, whorl = 0.34, spacing = 0.18 },
  { height = 11.0, reach = 1.7, radius = 0.18, bare = 0.14, boughs = 8, whorl = 0.42, spacing = 0.18 },
} do
  local wood, needles = tree.conifer(options)
  local node = gr.node('spruce')
  node:add_child(wood:node('wood', bark))
  node:add_child(needles:node('needles', gr.material { diffuse = { 0.06 + 0.02 * k, 0.14, 0.05 } }))
  kinds[k] = node
end

local function height(x, z)
  return 9 * gr.noise(x / 60, z / 60, 0.5) + 2 * gr.noise(x / 17, z / 17, 3.5) - z * 0.06
end

for i = 0, 11999 do
  local x, z = i % 120 * 2.6 - 155 + 2 * math.random(), -(i // 120) * 2.6 + 2 * math.random()
  local place = gr.node('place')
  place:add_child(kinds[math.random(3)])
  local size = 0.6 + 0.6 * math.random()
  place:scale(size, size * (0.9 + 0.25 * math.random()), size)
  place:rotate('y', 360 * math.random())
  place:translate(x, height(x, z) - 0.2, z)
  scene:add_child(place)
end

local n, positions, faces = 120, {}, {}
for i = 0, n do
  for j = 0, n do
    local x, z = -180 + 360 * i / n, 20 - 300 * j / n
    local at = #positions
    positions[at + 1], positions[at + 2], positions[at + 3] = x, height(x, z), z
    if i < n and j < n then
      local a = i * (n + 1) + j
      for _, corner in ipairs { a, a + n + 1, a + n + 2, a, a + n + 2, a + 1 } do
        faces[#faces + 1] = corner
      end
    end
  end
end
local ground = gr.mesh { name = 'ground', positions = positions, faces = faces, smooth = true }
ground:set_material(gr.material { diffuse = { 0.16, 0.18, 0.08 } })
scene:add_child(ground)

gr.render {
  scene = scene, output = 'forest.png', size = { 640, 360 },
  camera = { eye = { 0, 24, 34 }, look_at = { 0, 4, -60 }, fov = 45 },
  ambient = { 0.35, 0.38, 0.42 },
  lights = { gr.light { position = { -400, 500, 200 }, colour = { 1.2, 1.1, 0.9 } } },
  samples = 4,
  background = { bottom = { 0.9, 0.92, 0.95 }, top = { 0.35, 0.55, 0.85 } },
  transfer = 'srgb',
}
