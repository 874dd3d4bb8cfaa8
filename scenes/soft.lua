-- All five sampling counts at work: AA, GLOSSY, SHADOW, DOF and LENS.
-- Look for reflections that blur from the first ball (a mirror) to the last, the floor's reflections that blur with
-- height, shadows that are sharp at the foot and soft further on, and the far and near balls out of focus.
-- 480x270, 16 camera samples a pixel, each with 3 shadow and 3 glossy rays: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function add(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

add(gr.plane('floor'), gr.refl_material({ 0.50, 0.51, 0.54 }, { 0, 0, 0 }, 1, 0.30, 0.25))

-- Five balls along a diagonal through the focal plane; the glossy square grows from ball to ball.
local tints = {
  { 0.10, 0.10, 0.11 }, { 0.30, 0.20, 0.08 }, { 0.32, 0.10, 0.08 }, { 0.08, 0.24, 0.20 }, { 0.12, 0.14, 0.32 },
}
for i, tint in ipairs(tints) do
  local gloss = 0.22 * (i - 1)
  local ball = gr.nh_sphere('ball', { 1.4 * (i - 3), 0.7, -1.0 * (i - 3) }, 0.7)
  add(ball, gr.refl_material(tint, { 0.5, 0.5, 0.5 }, 160 / i ^ 2, 0.7, gloss))
end

-- Upright rods behind and between, for the reflections to show.
for i = 0, 9 do
  local rod = add(gr.cylinder('rod'), gr.material(
    { 0.55 + 0.4 * math.cos(0.7 * i), 0.5, 0.55 - 0.4 * math.cos(0.7 * i) }, { 0.2, 0.2, 0.2 }, 30))
  rod:scale(0.09, 0.8, 0.09)
  rod:translate(-4.5 + 0.95 * i, 0.8, -3.4 + 0.25 * i * (i % 2))
end

for i = 0, 4 do
  local bead = gr.nh_sphere('bead', { -1.9 + 1.25 * i, 0.16, 2.0 - 0.55 * i }, 0.16)
  add(bead, gr.material({ 0.92, 0.80 - 0.14 * i, 0.25 }, { 0.4, 0.4, 0.4 }, 50))
end

local key = gr.light({ 2.5, 5, 3.5 }, { 0.95, 0.92, 0.84 }, { 1, 0, 0 })

gr.render(scene, 'soft.png', 480, 270,
  { -0.2, 3.3, 7.6 }, { -0.2, 0.5, 0 }, { 0, 1, 0 }, 35,
  { 0.31, 0.31, 0.34 }, { key },
  2, 3, 3, 4, 0.22) -- AA, GLOSSY, SHADOW, DOF, LENS
