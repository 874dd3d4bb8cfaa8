-- For `cargo bench --bench batch`: a bunny and a monkey of files on a turntable, and a flag of a table that waves.
gr.conventions{transforms="pre"}
local turn = 360 * gr.frame() / gr.frames()
local scene = gr.node('scene')

local function add(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

local floor = add(gr.plane('floor'), gr.texture_material('assets/floor.png', {0.2, 0.2, 0.2}, 40, 0.1))
floor:translate(0, -1, 0)
local bunny = add(gr.mesh('bunny', 'assets/bunny.obj'), gr.material({0.72, 0.42, 0.28}, {0.2, 0.2, 0.2}, 20))
bunny:rotate('y', turn)
bunny:translate(-1.2, 0, 0)
local monkey = add(gr.mesh('monkey', 'assets/suzanne.obj'), gr.refl_material({0.2, 0.5, 0.5}, {0.5, 0.5, 0.5}, 60, 0.2))
monkey:rotate('y', -turn)
monkey:translate(1.2, 0, 0)

-- 32 x 32 squares, which are other triangles in each frame.
local vertices, faces = {}, {}
for row = 0, 32 do
  for column = 0, 32 do
    local x, y = column / 16 - 1, row / 16 - 1
    vertices[#vertices + 1] = {x, y, 0.15 * (x + 1) * math.sin(4 * x - math.rad(2 * turn))}
    if row < 32 and column < 32 then
      local corner = 33 * row + column
      faces[#faces + 1] = {corner, corner + 1, corner + 34, corner + 33}
    end
  end
end
local flag = add(gr.mesh('flag', vertices, faces), gr.material({0.7, 0.15, 0.12}, {0, 0, 0}, 1))
flag:translate(0, 1.2, -3)

gr.render{scene=scene, output='batch.png', size={480, 270}, samples=9, shadow=4, ambient={0.2, 0.2, 0.2},
  camera={eye={0, 1.2, 6}, look_at={0, 0.2, 0}, fov=40}, lights={gr.light({4, 7, 5}, {0.9, 0.9, 0.9}, {1, 0, 0})}}
