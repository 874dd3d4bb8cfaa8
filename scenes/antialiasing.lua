-- Antialiasing: one scene, rendered twice: antialiasing-off.png with one ray through the middle of each pixel,
-- antialiasing-on.png with 25 jittered ones. `scenes/render-gallery` puts the two side by side, twice as large.
-- Look for: the spokes, staircases without and lines with; the tiles far off, moire without and an even grey with;
-- the thin hoops, which fall to pieces without.
-- 2 x 240x200, 1 and 25 camera samples a pixel: some seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

put(scene, gr.plane('dark tiles'), gr.material({ 0.16, 0.20, 0.26 }, { 0, 0, 0 }, 1))
local tile = gr.cube('light tile')
tile:set_material(gr.material({ 0.86, 0.85, 0.80 }, { 0, 0, 0 }, 1))
tile:scale(1, 0.002, 1)
-- A row of tiles along x, and rows of rows: 7,200 tiles, 182 nodes.
local rows = {}
for parity = 0, 1 do
  rows[parity] = gr.node('row')
  for column = -30, 29 do
    local place = gr.node('place')
    place:add_child(tile)
    place:translate(2 * column + parity, 0, 0)
    rows[parity]:add_child(place)
  end
end
for row = -116, 3 do
  local place = gr.node('place')
  place:add_child(rows[row % 2])
  place:translate(0, 0, row)
  scene:add_child(place)
end

-- A wheel of thin spokes; each hoop is thinner than the one before.
local wheel = gr.node('wheel')
local ivory = gr.material({ 0.95, 0.93, 0.86 }, { 0, 0, 0 }, 1)
local red = gr.material({ 0.80, 0.16, 0.12 }, { 0.3, 0.3, 0.3 }, 30)
for i = 0, 17 do
  local spoke = put(wheel, gr.cylinder('spoke'), i % 2 == 0 and ivory or red)
  spoke:scale(0.014, 0.79, 0.014)
  spoke:translate(0, 0.99, 0)
  spoke:rotate('z', 20 * i + 4)
end
for i, radius in ipairs { 1.8, 1.5, 1.2, 0.9, 0.6 } do
  local hoop = put(wheel, gr.torus('hoop', radius, 0.05 / i ^ 1.3), red)
  hoop:rotate('x', 90)
end
put(wheel, gr.sphere('hub'), red):scale(0.2, 0.2, 0.2)
wheel:rotate('y', 18)
wheel:translate(0, 1.95, 0)
scene:add_child(wheel)

local sun = gr.light({ -5, 9, 8 }, { 0.80, 0.77, 0.70 }, { 1, 0, 0 })
for _, picture in ipairs { { 'off', 1 }, { 'on', 5 } } do
  local name, samples = table.unpack(picture)
  gr.render(scene, 'antialiasing-' .. name .. '.png', 240, 200,
    { 0.3, 2.3, 7.4 }, { 0, 1.75, 0 }, { 0, 1, 0 }, 33,
    { 0.32, 0.32, 0.34 }, { sun },
    samples) -- AA
end
