-- FRAME thousand leaves, at least one thousand, each an instance of one of three small meshes, moved, turned and scaled.
local count = 1000 * math.max(gr.frame_cmd(), 1)
local green = gr.material{ diffuse = { 0.3, 0.6, 0.2 } }

local leaves = {}
for kind = 1, 3 do
  local positions, faces = {}, {}
  for row = 0, 10 do
    local y = row / 10
    local width = 0.2 * math.sin(math.pi * y ^ (0.5 + 0.25 * kind)) + 0.001
    positions[#positions + 1] = { -width, y, 0 }
    positions[#positions + 1] = { width, y, 0.1 * y }
    if row > 0 then
      faces[#faces + 1] = { 2 * row - 2, 2 * row - 1, 2 * row + 1, 2 * row }
    end
  end
  leaves[kind] = gr.mesh{ name = 'leaf', positions = positions, faces = faces, smooth = true }
  leaves[kind]:set_material(green)
end

local field = gr.node('field')
local edge = math.ceil(math.sqrt(count))
for i = 0, count - 1 do
  local leaf = gr.node('place')
  leaf:add_child(leaves[1 + i % 3])
  leaf:scale(0.5 + math.random(), 1 + math.random(), 1)
  leaf:rotate('y', 360 * math.random())
  leaf:translate(i % edge, 0, i // edge)
  field:add_child(leaf)
end

gr.render{
  scene = field, output = 'instances.png', size = { 64, 48 },
  camera = { eye = { edge / 2, edge / 3, edge * 1.3 }, look_at = { edge / 2, 0, edge / 2 }, fov = 40 },
  ambient = { 0.2, 0.2, 0.2 }, lights = { gr.light{ position = { edge, edge * 2, edge } } },
}
