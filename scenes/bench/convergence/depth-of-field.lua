-- Convergence of depth of field alone: bright balls and rods far out of focus before an even sky. Every edge
-- is many pixels wide, so that the error is that of the integral over the lens.
-- 160x120, a square lens.

local scene = gr.node('scene')
local colours = { { 0.9, 0.55, 0.45 }, { 0.5, 0.7, 0.9 }, { 0.9, 0.8, 0.5 }, { 0.55, 0.8, 0.55 } }
for i = 0, 23 do
  local column, row = i % 6, i // 6
  local shape = row % 2 == 0 and gr.sphere('ball') or gr.cylinder('rod')
  shape:set_material(gr.material { diffuse = { 0, 0, 0 }, emission = colours[(i * 7 + row) % 4 + 1] })
  if row % 2 == 0 then shape:scale(0.45, 0.45, 0.45) else shape:scale(0.2, 0.6, 0.2) end
  shape:rotate('z', 40 * i)
  shape:translate((column - 2.5) * 1.3, (row - 1.5) * 1.2, -(i * 5 % 7) * 0.4)
  scene:add_child(shape)
end

gr.render {
  scene = scene, output = 'depth-of-field.png', size = { 160, 120 },
  camera = { eye = { 0, 0, 9 }, look_at = { 0, 0, 0 }, fov = 32, focus = 3, lens = 0.6 },
  ambient = { 0, 0, 0 }, lights = {},
  samples = 16, max_depth = 0,
  background = { 0.25, 0.3, 0.4 },
}
