-- Perlin bumps on a sphere, drawn through the third axis of the noise: frame n shows the slice z = n / 100.
-- Look for: relief that flows from frame to frame without a jump (FRAME 0 to 199 is a good length); the outline, which
-- stays round; the small mirror ball, in which the same bumps are seen from behind.
-- 320x240, 16 camera samples a pixel: a second or two on two CPU cores.

local z = gr.frame_cmd() / 100
local scene = gr.node('scene')

local ball = gr.sphere('ball')
ball:set_material(gr.material { diffuse = { 0.75, 0.36, 0.16 }, specular = { 0.5, 0.5, 0.5 }, shininess = 40,
  noise = z })
ball:scale(1.5, 1.5, 1.5)
ball:translate(0, 1.5, 0)
scene:add_child(ball)

local mirror = gr.nh_sphere('mirror', { -1.9, 0.55, 0.9 }, 0.55)
mirror:set_material(gr.material { diffuse = { 0.02, 0.02, 0.02 }, specular = { 0.8, 0.8, 0.8 }, shininess = 200,
  reflection = 0.85 })
scene:add_child(mirror)

local floor = gr.plane('floor')
floor:set_material(gr.material { diffuse = { 0.62, 0.63, 0.66 } })
scene:add_child(floor)

local lamp = gr.sphere_light { position = { -4, 6, 5 }, radius = 0.8, colour = { 0.85, 0.82, 0.76 } }
local fill = gr.light { position = { 6, 3, 4 }, colour = { 0.16, 0.20, 0.28 } }
gr.background { bottom = { 0.50, 0.52, 0.56 }, top = { 0.70, 0.76, 0.86 } }
gr.render {
  scene = scene, output = 'perlin-sphere.png', size = { 320, 240 }, samples = 16,
  camera = { eye = { 0, 2.2, 7.2 }, look_at = { -0.3, 1.35, 0 }, fov = 30 }, lights = { lamp, fill },
  ambient = { 0.34, 0.34, 0.37 },
}
