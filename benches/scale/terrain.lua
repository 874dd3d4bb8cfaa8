-- A square of hills in FRAME thousand triangles, at least one thousand: every vertex is computed by Lua.
local thousands = math.max(gr.frame_cmd(), 1)
local cells = math.floor(math.sqrt(thousands * 500)) -- two triangles each
local positions, faces, uvs = {}, {}, {}

local at = 0
for row = 0, cells do
  local z = row / cells
  for column = 0, cells do
    local x = column / cells
    positions[at * 3 + 1] = x
    positions[at * 3 + 2] = 0.05 * math.sin(17 * x) * math.sin(13 * z) + 0.01 * math.sin(71 * x + 40 * z)
    positions[at * 3 + 3] = z
    uvs[at * 2 + 1] = x
    uvs[at * 2 + 2] = z
    at = at + 1
  end
end

at = 0
for row = 0, cells - 1 do
  for column = 0, cells - 1 do
    local corner = row * (cells + 1) + column
    local below = corner + cells + 1
    faces[at + 1], faces[at + 2], faces[at + 3] = corner, below, below + 1
    faces[at + 4], faces[at + 5], faces[at + 6] = corner, below + 1, corner + 1
    at = at + 6
  end
end

local hills = gr.mesh{ name = 'hills', positions = positions, faces = faces, uvs = uvs, smooth = true }
hills:set_material(gr.material{ diffuse = { 0.4, 0.6, 0.3 } })
gr.render{
  scene = hills, output = 'terrain.png', size = { 64, 48 },
  camera = { eye = { 0.5, 0.5, 1.7 }, look_at = { 0.5, 0, 0.5 }, fov = 40 },
  ambient = { 0.2, 0.2, 0.2 }, lights = { gr.light{ position = { 3, 5, 2 } } },
}
