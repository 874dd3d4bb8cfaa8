-- Perlin noise, as bumps and as numbers: a harbour at the golden hour.
-- Look for: waves on a plane that is flat, and the sky broken in them; five gourds, whose skins are slices of one noise at
-- different heights of the third axis; the basalt steps behind, whose heights come from gr.noise.
-- 640x360, 9 camera samples a pixel: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

-- KD, KS, p, REFL, AREA, IOR, Z_HEIGHT
local water = gr.perlin_bump_material({ 0.02, 0.07, 0.09 }, { 0.6, 0.55, 0.45 }, 120, 0.75, 0, -1, 0.3)
-- The plane's coordinates are u = x and v = z: a larger plane has longer waves.
local sea = put(scene, gr.plane('sea'), water)
sea:scale(2.4, 1, 1.2)
sea:rotate('y', 20)

-- Basalt: prisms in hexagonal order, as high as the noise says, lower towards the water.
local tones = {}
for i = 1, 4 do
  local c = 0.20 + 0.05 * i
  tones[i] = gr.perlin_bump_material({ c, 0.92 * c, 0.85 * c }, { 0.15, 0.15, 0.15 }, 20, 0, 0, -1, i)
end
for row = 0, 9 do
  for column = -14, 14 do
    local x, z = 0.46 * (column + 0.5 * (row % 2)), -2.6 - 0.40 * row
    local height = 0.16 * row + 0.9 * gr.noise(0.55 * x, 0.55 * z, 1.7) + 0.25 * gr.noise(1.9 * x, 1.9 * z, 4.2)
    if height > 0 then
      local prism = put(scene, gr.cylinder('prism'), tones[1 + (3 * column + 5 * row) % 4])
      prism:scale(0.235, height / 2 + 0.1, 0.235)
      prism:rotate('y', 47 * column + 31 * row)
      prism:translate(x, height / 2 - 0.1, z)
    end
  end
end

-- A jetty of planks, and gourds on it.
local plank = gr.cube('plank')
plank:set_material(gr.texture_material('assets/floor.png', { 0.1, 0.1, 0.1 }, 10))
plank:translate(-0.5, -1, 0)
plank:scale(4.6, 0.09, 0.42)
for i = 0, 4 do
  local place = gr.node('place')
  place:add_child(plank)
  place:translate(0.05 * (i % 2), 0.34, 0.5 + 0.45 * i)
  scene:add_child(place)
end

local function gourd(colour, shine, z, radius, stretch, x, depth, turn)
  local ball = put(scene, gr.sphere('gourd'),
    gr.perlin_bump_material(colour, { shine, shine, shine }, 40, 0, 0, -1, z))
  ball:scale(radius * stretch, radius, radius)
  ball:rotate('y', turn)
  ball:translate(x, 0.34 + radius, depth)
end
gourd({ 0.95, 0.48, 0.06 }, 0.35, 0.0, 0.44, 1, -0.95, 1.2, 0)
gourd({ 0.92, 0.42, 0.05 }, 0.35, 5.5, 0.42, 1, -0.12, 0.85, 80)
gourd({ 0.95, 0.80, 0.14 }, 0.40, 2.5, 0.32, 1.3, 0.62, 1.5, 25)
gourd({ 0.42, 0.27, 0.15 }, 0.12, 9.0, 0.20, 1.1, -0.22, 1.95, 60)
gourd({ 0.55, 0.68, 0.16 }, 0.35, 7.0, 0.29, 1.15, 1.35, 0.95, -20)

gr.background { bottom = { 1.7, 0.98, 0.46 }, top = { 0.24, 0.42, 0.74 } }
local sun = gr.light({ -14, 9, 8 }, { 0.95, 0.78, 0.55 }, { 1, 0, 0 })
local sky = gr.light({ 6, 10, 6 }, { 0.18, 0.23, 0.32 }, { 1, 0, 0 })

gr.render(scene, 'perlin.png', 640, 360,
  { 0.3, 2.2, 7.2 }, { 0.1, 0.62, 0 }, { 0, 1, 0 }, 32,
  { 0.24, 0.24, 0.28 }, { sun, sky },
  3) -- AA
