-- Every primitive, and each again as an instance: stretched, squashed and mirrored.
-- Front row: sphere, cube, cylinder, cone, torus, a mesh from a table, a mesh from an OBJ file, all on the plane.
-- Look for even highlights on the stretched shapes of the back row, whose normals go by the inverse transpose.
-- 640x360, 9 camera samples a pixel: some seconds on two CPU cores.

-- A mesh from a table alone would mean the transform order of old scenes.
gr.conventions { transforms = 'pre' }

local scene = gr.node('scene')

local floor = gr.plane('floor')
floor:set_material(gr.material({ 0.62, 0.63, 0.67 }, { 0, 0, 0 }, 1))
scene:add_child(floor)

local octahedron = gr.mesh('octahedron',
  { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } },
  { { 2, 4, 0 }, { 2, 0, 5 }, { 2, 5, 1 }, { 2, 1, 4 }, { 3, 0, 4 }, { 3, 5, 0 }, { 3, 1, 5 }, { 3, 4, 1 } })

-- Each shape, how it is brought to a size of about 1 standing at the origin, its colour, and its second form.
local shapes = {
  { gr.sphere('sphere'), { 0.85, 0.25, 0.22 },
    function(n) n:scale(0.5, 0.5, 0.5); n:translate(0, 0.5, 0) end,
    function(n) n:scale(0.55, 1.9, 0.55) end },
  { gr.cube('cube'), { 0.90, 0.52, 0.18 },
    function(n) n:translate(-0.5, 0, -0.5); n:scale(0.85, 0.85, 0.85); n:rotate('y', 30) end,
    function(n) n:scale(1.2, 0.7, 0.5); n:rotate('z', 20); n:translate(0, 0.22, 0) end },
  { gr.cylinder('cylinder'), { 0.92, 0.80, 0.25 },
    function(n) n:scale(0.42, 0.5, 0.42); n:translate(0, 0.5, 0) end,
    function(n) n:scale(1.2, 1.8, 0.35); n:rotate('y', -25) end },
  { gr.cone('cone'), { 0.35, 0.70, 0.30 },
    function(n) n:scale(0.5, 1, 0.5); n:translate(0, 1, 0) end,
    function(n) n:scale(1, -1.5, 1); n:translate(0, 1.5, 0) end },
  { gr.torus('torus', 0.36, 0.16), { 0.20, 0.62, 0.66 },
    function(n) n:rotate('x', 68); n:translate(0, 0.5, 0) end,
    function(n) n:scale(1, 1.7, 1); n:rotate('y', 35) end },
  { octahedron, { 0.28, 0.42, 0.85 },
    function(n) n:scale(0.5, 0.5, 0.5); n:rotate('y', 20); n:translate(0, 0.5, 0) end,
    function(n) n:scale(0.8, 1.9, 0.8) end },
  { gr.mesh('suzanne', 'assets/suzanne.obj'), { 0.62, 0.36, 0.74 },
    function(n) n:rotate('y', -20) end,
    function(n) n:scale(-1, 1.7, 1) end },
}

for column, shape in ipairs(shapes) do
  local node, colour, place, distort = table.unpack(shape)
  local x = 1.25 * (column - 4)
  node:set_material(gr.material(colour, { 0.4, 0.4, 0.4 }, 50))
  place(node)

  local front = gr.node('front')
  front:add_child(node)
  front:translate(x, 0, 1.1)
  scene:add_child(front)

  local back = gr.node('back') -- the same geometry node again
  back:add_child(node)
  distort(back)
  back:translate(x * 1.1, 0, -1.7)
  scene:add_child(back)
end

-- The placed shapes: a row of beads and blocks in front.
for i = -6, 6 do
  local bead
  if i % 2 == 0 then
    bead = gr.nh_sphere('bead', { 0.6 * i, 0.12, 2.35 }, 0.12)
  else
    bead = gr.nh_box('block', { 0.6 * i - 0.1, 0, 2.25 }, 0.2)
  end
  bead:set_material(gr.material({ 0.85, 0.83, 0.78 }, { 0.3, 0.3, 0.3 }, 30))
  scene:add_child(bead)
end

local key = gr.light({ -6, 10, 8 }, { 0.88, 0.85, 0.78 }, { 1, 0, 0 })
local fill = gr.light({ 7, 5, 6 }, { 0.20, 0.22, 0.28 }, { 1, 0, 0 })

gr.render(scene, 'primitives.png', 640, 360,
  { 0, 4.9, 10.2 }, { 0, 0.55, 0 }, { 0, 1, 0 }, 28,
  { 0.28, 0.28, 0.31 }, { key, fill },
  3, 1, 2) -- AA, GLOSSY, SHADOW
