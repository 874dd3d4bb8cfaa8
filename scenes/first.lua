-- A gold ring, a glass ball and a mirror ball, in a spiral of small coloured balls.
-- Look for the ring's reflection in the floor, the world upside down in the glass, and soft shadows of two lights.
-- 640x360, 9 camera samples a pixel: some seconds on two CPU cores.

local function hue(h) -- a colour circle of even brightness, h in turns
  local function wave(shift) return 0.5 + 0.42 * math.cos(2 * math.pi * (h - shift)) end
  return { wave(0), wave(1 / 3), wave(2 / 3) }
end

local gold = gr.refl_material({ 0.66, 0.40, 0.06 }, { 0.9, 0.75, 0.4 }, 50, 0.32)
local mirror = gr.refl_material({ 0.04, 0.04, 0.05 }, { 0.9, 0.9, 0.9 }, 200, 0.85)
local glass = gr.refl_material({ 0, 0, 0 }, { 0.8, 0.8, 0.8 }, 200, 1, 0, 1.5)
local floor = gr.refl_material({ 0.62, 0.60, 0.58 }, { 0, 0, 0 }, 1, 0.18)

local scene = gr.node('scene')

local function add(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

add(gr.plane('floor'), floor)

-- The ring stands on the floor, turned a little to the right.
local ring = add(gr.torus('ring', 1.15, 0.34), gold)
ring:rotate('x', 90)
ring:rotate('y', 24)
ring:translate(-0.1, 1.49, -0.6)

add(gr.nh_sphere('glass', { -1.45, 0.85, 1.15 }, 0.85), glass)
add(gr.nh_sphere('mirror', { 1.75, 0.7, 0.55 }, 0.7), mirror)

-- Sunflower spiral (Vogel 1979): each ball is the golden angle further round. Some places are taken; the hue goes
-- with the distance.
local taken = { { -1.45, 1.15, 0.85 }, { 1.75, 0.55, 0.7 }, { -0.1, -0.6, 0.75 } }
for i = 5, 260 do
  local angle, distance = i * math.pi * (3 - math.sqrt(5)), 0.36 * math.sqrt(i)
  local x, z, r = distance * math.cos(angle), distance * math.sin(angle), 0.12
  local free = true
  for _, t in ipairs(taken) do
    free = free and math.sqrt((x - t[1]) ^ 2 + (z - t[2]) ^ 2) > t[3] + r
  end
  if free then
    local ball = gr.nh_sphere('ball' .. i, { x, r, z }, r)
    add(ball, gr.material(hue((distance - 1.1) / 5.8), { 0.35, 0.35, 0.35 }, 40))
  end
end

local key = gr.light({ -5, 9, 6 }, { 0.86, 0.82, 0.73 }, { 1, 0, 0 })
local fill = gr.light({ 6, 4, 4 }, { 0.25, 0.28, 0.35 }, { 1, 0, 0 })

gr.render(scene, 'first.png', 640, 360,
  { 0.5, 4.4, 8.0 }, { 0.05, 0.80, 0 }, { 0, 1, 0 }, 32.5,
  { 0.27, 0.27, 0.30 }, { key, fill },
  3, 1, 2) -- AA, GLOSSY, SHADOW
