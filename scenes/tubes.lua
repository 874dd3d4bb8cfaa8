-- Swimming rings that bob on the waves of a tiled pool, in a loop of 40 frames: FRAME 40 is FRAME 0 again.
-- Look for: rings that lie in the water, and tilt as the waves under them do; tiles that wobble as the water's surface
-- bends the rays; the sky in the slopes that face it.
-- 320x200, 9 camera samples a pixel: a second or two a frame on two CPU cores. The clip:
--   gpu-trace scenes/tubes.lua --frames 0..39 -o tubes.gif

local frames = 40
local phase = 2 * math.pi * gr.frame_cmd() / frames

gr.conventions { transforms = 'pre' }
local Mesh = require('lib.mesh')
local props = require('lib.props')
local shape = require('lib.shape')

local scene = gr.node('scene')
local function put(node, material)
  node:set_material(material)
  scene:add_child(node)
  return node
end

-- Waves {across x, across z, height, whole periods in the loop, start}; whole periods are what closes the loop.
local waves = {
  { 0.55, 0.95, 0.055, 1, 0.0 }, { -0.80, 1.30, 0.035, 1, 1.3 }, { 1.90, 0.60, 0.024, 2, 2.1 },
  { -1.20, 2.60, 0.020, 2, 4.0 }, { 3.10, -2.40, 0.012, 3, 0.7 }, { 2.30, 4.10, 0.010, 3, 5.2 },
}
--- The water's height at (x, z) and its slopes in x and z.
local function wave(x, z)
  local height, slope_x, slope_z = 0, 0, 0
  for _, w in ipairs(waves) do
    local angle = w[1] * x + w[2] * z + w[5] - w[4] * phase
    height = height + w[3] * math.sin(angle)
    slope_x = slope_x + w[3] * w[1] * math.cos(angle)
    slope_z = slope_z + w[3] * w[2] * math.cos(angle)
  end
  return height, slope_x, slope_z
end

local surface = Mesh.new()
local columns, rows = 130, 130
for j = 0, rows do
  for i = 0, columns do
    local x, z = shape.mix(-9, 9, i / columns), shape.mix(-13, 5, j / rows)
    local y, sx, sz = wave(x, z)
    surface:vertex(x, y, z, -sx, 1, -sz, x, z)
  end
end
for j = 0, rows - 1 do
  for i = 0, columns - 1 do
    local a = j * (columns + 1) + i
    surface:quad(a, a + columns + 1, a + columns + 2, a + 1)
  end
end
scene:add_child(surface:node('water', gr.material {
  diffuse = { 0, 0.01, 0.015 }, specular = { 0.6, 0.6, 0.6 }, shininess = 250, reflection = 1, ior = 1.33,
  casts_shadow = false,
}))

-- The basin: tiles of a few blues, and a rim of stone.
local blues = {}
for k = 1, 4 do
  local t = k / 4
  blues[k] = gr.material { diffuse = { 0.10 + 0.10 * t, 0.42 + 0.12 * t, 0.52 + 0.14 * t } }
end
put(gr.plane('grout'), gr.material { diffuse = { 0.50, 0.64, 0.66 } }):translate(0, -1.32, 0)
for i = -12, 11 do
  for j = -18, 6 do
    local tile = put(gr.cube('tile'), blues[1 + (5 * i * i + 3 * j * j + i * j) % 4])
    tile:scale(0.67, 0.05, 0.67)
    tile:translate(0.7 * i, -1.35, 0.7 * j)
  end
end
local wall = put(gr.cube('wall'), gr.material { diffuse = { 0.62, 0.58, 0.52 } })
wall:scale(24, 1.75, 1.2)
wall:translate(-12, -1.4, -9.2)

local cloths = {
  gr.material { texture = 'assets/stripes.png', specular = { 0.4, 0.4, 0.4 }, shininess = 50 },
  gr.material { diffuse = { 0.95, 0.72, 0.10 }, specular = { 0.4, 0.4, 0.4 }, shininess = 50 },
  gr.material { diffuse = { 0.20, 0.62, 0.36 }, specular = { 0.4, 0.4, 0.4 }, shininess = 50 },
}
local valve = gr.material { diffuse = { 0.85, 0.85, 0.80 }, specular = { 0.3, 0.3, 0.3 }, shininess = 30 }
--- `node` at rest at (x, z), moved by the wave: it drifts a little, rises and tilts.
local function float(node, x, z, scale, turn)
  local y, sx, sz = wave(x, z)
  x, z = x + 0.10 * math.sin(phase + x), z + 0.08 * math.cos(phase + z)
  shape.place(scene, node, x, y + 0.08, z, scale, turn + 5 * math.sin(phase + 2 * x), math.deg(math.atan(sz)),
    -math.deg(math.atan(sx)))
end
float(props.ring(cloths[1], valve), -1.25, 0.1, 1.0, 20)
float(props.donut(), 1.15, 0.9, 0.95, 75)
float(props.ring(cloths[2], valve), 0.6, -2.6, 1.0, 130)
float(props.ring(cloths[3], valve), -2.7, -4.2, 1.0, 300)

gr.background { image = 'assets/sky.png' }
local sun = gr.sphere_light { position = { -50, 70, 40 }, radius = 2.5, colour = { 0.88, 0.84, 0.74 } }
gr.render {
  scene = scene, output = 'tubes.png', size = { 320, 200 }, samples = 9, max_depth = 4,
  camera = { eye = { 0.2, 2.7, 6.0 }, look_at = { 0, -0.1, -0.6 }, fov = 36 }, lights = { sun },
  ambient = { 0.42, 0.44, 0.48 },
}
