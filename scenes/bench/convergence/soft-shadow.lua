-- Convergence of soft shadows alone: a floor that fills the picture, wholly within the penumbra of bars that are out of
-- sight, under a square light. No edge is seen, so that the error is that of the integral over the light.
-- Nothing is near black, where the sRGB curve bends so much that even independent samples would fall faster than N^-0.5.
-- 320x240, one shadow ray a camera sample.

local scene = gr.node('scene')
local floor = gr.plane('floor')
floor:set_material(gr.material { diffuse = { 0.8, 0.8, 0.8 } })
scene:add_child(floor)
for i = -2, 2 do
  local bar = gr.cube('bar')
  bar:set_material(gr.material { diffuse = { 0.2, 0.2, 0.2 } })
  bar:translate(-0.5, -0.5, -0.5)
  bar:scale(0.7, 0.2, 14)
  bar:rotate('y', 25 * i)
  bar:translate(1.9 * i, 6, 0)
  scene:add_child(bar)
end

gr.render {
  scene = scene, output = 'soft-shadow.png', size = { 320, 240 },
  camera = { eye = { 0, 4, 5 }, look_at = { 0, 0, 0 }, fov = 45 },
  ambient = { 0.3, 0.3, 0.3 },
  lights = { gr.area_light { position = { 1, 12, 1 }, colour = { 0.6, 0.6, 0.6 }, u = { 5, 0, 0 }, v = { 0, 0, 5 } } },
  samples = 16, shadow = 1, max_depth = 0,
}
