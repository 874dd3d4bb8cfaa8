-- More work in one camera sample than some drivers let an invocation do: 48 lights with 64 shadow rays each, 25 glossy
-- rays, and shapes that overlap. Mesa before 23 ends every loop after 65,535 turns without a word; the renderer must
-- notice, and the picture must come out the same: a ring of coloured lights over a heap of shells.
-- 48x32, 1 camera sample a pixel, about 5 million shadow rays: some seconds on two CPU cores.

local scene = gr.node('scene')

local function add(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

add(gr.plane('floor'), gr.refl_material({ 0.7, 0.7, 0.7 }, { 0, 0, 0 }, 1, 0.3, 0.3))

-- Rays pass through many bounding boxes here: rings in rings, balls in balls.
for i = 1, 12 do
  local ring = add(gr.torus('ring', 0.25 + 0.1 * i, 0.04), gr.refl_material(
    { 0.6, 0.55, 0.5 }, { 0.3, 0.3, 0.3 }, 30, 0.4, 0.2))
  ring:rotate('x', 15 * i)
  ring:rotate('y', 40 * i)
  ring:translate(0, 1.5, 0)
end
for i = 1, 6 do
  add(gr.nh_sphere('shell', { 0, 1.5, 0 }, 0.08 * i), gr.refl_material({ 0, 0, 0 }, { 0.2, 0.2, 0.2 }, 60, 1, 0,
    i % 2 == 0 and 1.5 or 1.333))
end

local lights = {}
local count = 48
for i = 1, count do
  local a = 2 * math.pi * i / count
  local function wave(shift) return (1 + math.cos(a - shift)) / count end
  lights[i] = gr.light({ 4 * math.cos(a), 5, 4 * math.sin(a) },
    { wave(0), wave(2 * math.pi / 3), wave(4 * math.pi / 3) }, { 1, 0, 0 })
end

gr.render(scene, 'work.png', 48, 32,
  { 0, 2.6, 6 }, { 0, 1.2, 0 }, { 0, 1, 0 }, 40,
  { 0.1, 0.1, 0.1 }, lights,
  1, 25, 64) -- AA, GLOSSY, SHADOW
