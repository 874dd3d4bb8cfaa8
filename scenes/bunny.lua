-- The Stanford bunny: one mesh of 22,592 triangles in memory, many bunnies in the picture.
-- Look for the mirror that shows their backs, the glass bunny on the right, and soft shadows.
-- 640x360, 9 camera samples a pixel: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function add(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

-- The file is read once; each node of it may have a material of its own.
local function bunny(material)
  local node = gr.mesh('bunny', 'assets/bunny.obj')
  node:set_material(material)
  return node
end

local function place(node, size, turn, x, y, z)
  local at = gr.node('place')
  at:add_child(node)
  at:scale(size, size, size)
  at:rotate('y', turn)
  at:translate(x, y, z)
  scene:add_child(at)
end

local clay = bunny(gr.material({ 0.72, 0.42, 0.28 }, { 0.15, 0.15, 0.15 }, 20))
local gold = bunny(gr.refl_material({ 0.62, 0.38, 0.07 }, { 0.9, 0.75, 0.4 }, 50, 0.35))
local glass = bunny(gr.refl_material({ 0, 0, 0 }, { 0.7, 0.7, 0.7 }, 200, 1, 0, 1.5))
local porcelain = bunny(gr.refl_material({ 0.78, 0.79, 0.80 }, { 0.6, 0.6, 0.6 }, 120, 0.08))
local teal = bunny(gr.material({ 0.20, 0.52, 0.52 }, { 0.3, 0.3, 0.3 }, 40))

add(gr.plane('floor'), gr.material({ 0.60, 0.59, 0.57 }, { 0, 0, 0 }, 1))

local wall = add(gr.plane('wall'), gr.material({ 0.36, 0.46, 0.44 }, { 0, 0, 0 }, 1))
wall:rotate('x', 90)
wall:translate(0, 0, -2.6)

-- A mirror in a wooden frame, hung so that it leans forward.
local frame = gr.node('frame')
local wood = gr.material({ 0.36, 0.22, 0.13 }, { 0.2, 0.2, 0.2 }, 30)
local function slab(material, x, y, z, w, h, d)
  local box = gr.cube('slab')
  box:set_material(material)
  box:translate(-0.5, 0, -0.5)
  box:scale(w, h, d)
  box:translate(x, y, z)
  frame:add_child(box)
end
slab(wood, 0, 0, -0.06, 4.2, 1.9, 0.1)
slab(gr.refl_material({ 0.03, 0.03, 0.03 }, { 0, 0, 0 }, 1, 0.9), 0, 0.1, 0, 4.0, 1.7, 0.04)
frame:rotate('x', 12)
frame:translate(0, 0.75, -2.35)
scene:add_child(frame)

local stand = add(gr.cylinder('stand'), gr.material({ 0.30, 0.31, 0.34 }, { 0.4, 0.4, 0.4 }, 60))
stand:scale(0.85, 0.08, 0.85)
stand:translate(0, 0.08, 0)
place(porcelain, 1.5, 20, 0, 0.16, 0)
place(gold, 1.05, 40, -1.75, 0, 0.35)
place(glass, 1.05, -15, 1.75, 0, 0.45)

-- A litter of small ones in front.
local litter = { clay, teal, porcelain }
for i = 0, 6 do
  local angle = math.pi * (0.12 + 0.76 * i / 6)
  place(litter[1 + i % 3], 0.42, 60 * i, -2.6 * math.cos(angle), 0, 0.2 + 1.7 * math.sin(angle))
end

local key = gr.light({ -3.5, 6, 4.5 }, { 0.88, 0.85, 0.78 }, { 1, 0, 0 })
local fill = gr.light({ 5, 4, 3 }, { 0.24, 0.26, 0.32 }, { 1, 0, 0 })

gr.render(scene, 'bunny.png', 640, 360,
  { 0.2, 2.0, 7.0 }, { 0, 0.8, 0 }, { 0, 1, 0 }, 30,
  { 0.28, 0.28, 0.31 }, { key, fill },
  3, 1, 2) -- AA, GLOSSY, SHADOW
