-- Hills of an OBJ file, which benches/scale/run writes beside a copy of this scene.
local hills = gr.mesh('hills', 'hills.obj')
hills:set_material(gr.material{ diffuse = { 0.4, 0.6, 0.3 } })
gr.render{
  scene = hills, output = 'hills.png', size = { 64, 48 },
  camera = { eye = { 0.5, 0.5, 1.7 }, look_at = { 0.5, 0, 0.5 }, fov = 40 },
  ambient = { 0.2, 0.2, 0.2 }, lights = { gr.light{ position = { 3, 5, 2 } } },
}
