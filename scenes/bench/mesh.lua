-- Benchmark: one mesh of 264,320 triangles, nine bumpy balls over a rippled floor, under a square light; two of the
-- balls' neighbours are mirrors. The peers' mesh, made by the same formulas.
-- 640x360, 16 camera samples a pixel, each with 4 shadow rays at its first hit.

local sin, cos, sqrt = math.sin, math.cos, math.sqrt
local golden = (1 + sqrt(5)) / 2

local function unit(x, y, z)
  local length = sqrt(x * x + y * y + z * z)
  return x / length, y / length, z / length
end

-- An icosahedron, each face split into four, over and over: positions in one row, and triangles.
local function icosphere(subdivisions)
  local positions, faces = {}, {
    0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,
    3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1,
  }
  local count = 0
  local function add(x, y, z)
    x, y, z = unit(x, y, z)
    positions[3 * count + 1], positions[3 * count + 2], positions[3 * count + 3] = x, y, z
    count = count + 1
    return count - 1
  end
  for _, p in ipairs {
    { -1, golden, 0 }, { 1, golden, 0 }, { -1, -golden, 0 }, { 1, -golden, 0 }, { 0, -1, golden }, { 0, 1, golden },
    { 0, -1, -golden }, { 0, 1, -golden }, { golden, 0, -1 }, { golden, 0, 1 }, { -golden, 0, -1 }, { -golden, 0, 1 },
  } do
    add(p[1], p[2], p[3])
  end
  for _ = 1, subdivisions do
    local middles, split = {}, {}
    local function middle(a, b)
      local key = a < b and a * 1000000 + b or b * 1000000 + a
      if not middles[key] then
        middles[key] = add(
          positions[3 * a + 1] + positions[3 * b + 1],
          positions[3 * a + 2] + positions[3 * b + 2],
          positions[3 * a + 3] + positions[3 * b + 3])
      end
      return middles[key]
    end
    for i = 1, #faces, 3 do
      local a, b, c = faces[i], faces[i + 1], faces[i + 2]
      local ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
      for _, corner in ipairs { a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca } do
        split[#split + 1] = corner
      end
    end
    faces = split
  end
  return positions, faces
end

local function bump(x, y, z)
  return sin(7 * x) * cos(9 * y) * sin(8 * z) * 0.05 + sin(31 * x) * sin(37 * z) * 0.01
end

local scene = gr.node('scene')
local clay = gr.material { diffuse = { 0.7, 0.6, 0.5 }, specular = { 0.2, 0.2, 0.2 }, shininess = 30 }
local mirror = gr.material { diffuse = { 0.2, 0.2, 0.25 }, specular = { 0.5, 0.5, 0.5 }, shininess = 80, reflection = 0.6 }

local directions, ball_faces = icosphere(5)
for k = 0, 8 do
  local ox, oz = k % 3 * 1.3 - 1.3, -(k // 3) * 1.4
  local positions = {}
  for i = 1, #directions, 3 do
    local x, y, z = directions[i], directions[i + 1], directions[i + 2]
    local r = 0.6 * (1 + bump(1.8 * x + 2 * ox, 1.8 * y, 1.8 * z + 2 * oz))
    positions[i], positions[i + 1], positions[i + 2] = x * r + ox, y * r, z * r + oz
  end
  local ball = gr.mesh { name = 'ball', positions = positions, faces = ball_faces, smooth = true }
  ball:set_material(k % 4 == 1 and mirror or clay)
  scene:add_child(ball)
end

local n, positions, faces = 200, {}, {}
for i = 0, n do
  for j = 0, n do
    local x, z = (i / n - 0.5) * 12, (j / n - 0.5) * 12
    local at = #positions
    positions[at + 1], positions[at + 2], positions[at + 3] = x, -0.8 + 0.1 * sin(5 * x) * cos(4 * z), z
    if i < n and j < n then
      local a = i * (n + 1) + j
      for _, corner in ipairs { a, a + n + 2, a + n + 1, a, a + 1, a + n + 2 } do
        faces[#faces + 1] = corner
      end
    end
  end
end
local floor = gr.mesh { name = 'floor', positions = positions, faces = faces, smooth = true }
floor:set_material(gr.material { diffuse = { 0.45, 0.5, 0.45 } })
scene:add_child(floor)

gr.render {
  scene = scene, output = 'mesh.png', size = { 640, 360 },
  camera = { eye = { 0.6, 2.4, 4.2 }, look_at = { 0, -0.3, -1.4 }, fov = 42 },
  ambient = { 0.2, 0.2, 0.22 },
  lights = { gr.area_light { position = { 4, 8, 4 }, colour = { 0.85, 0.85, 0.8 }, u = { 2, 0, 0 }, v = { 0, 0, 2 } } },
  samples = 16, shadow = 4, max_depth = 5,
  background = { bottom = { 0.8, 0.85, 0.9 }, top = { 0.4, 0.55, 0.8 } },
}
