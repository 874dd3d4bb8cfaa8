-- Convergence of depth of field alone: six bright balls far out of focus before an even sky. Every edge
-- is many pixels wide, so that the error is that of the integral over the lens.
-- 320x240, a square lens.

local scene = gr.node('scene')
local colours = { { 0.9, 0.55, 0.45 }, { 0.5, 0.7, 0.9 }, { 0.9, 0.8, 0.5 }, { 0.55, 0.8, 0.55 } }
for i = 0, 5 do
  local column, row = i % 3, i // 3
  local ball = gr.sphere('ball')
  ball:set_material(gr.material { diffuse = { 0, 0, 0 }, emission = colours[i * 7 % 4 + 1] })
  ball:translate((column - 1) * 2.6, (row - 0.5) * 2.6, -i % 3)
  scene:add_child(ball)
end

gr.render {
  scene = scene, output = 'depth-of-field.png', size = { 320, 240 },
  camera = { eye = { 0, 0, 9 }, look_at = { 0, 0, 0 }, fov = 32, focus = 3, lens = 0.7 },
  ambient = { 0, 0, 0 }, lights = {},
  samples = 16, max_depth = 0,
  background = { 0.25, 0.3, 0.4 },
}
