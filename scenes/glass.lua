-- Glass and water on a tiled floor, with coloured columns behind.
-- Look for: the columns upside down in the big ball; the ball of glass that is faint in the water block, since the two
-- indices are close; the air bubble beside it, bright at the rim by total internal reflection; the ring.
-- 640x360, 16 camera samples a pixel: under ten seconds on two CPU cores.

local function transparent(ior)
  return gr.refl_material({ 0, 0, 0 }, { 0.7, 0.7, 0.7 }, 250, 1, 0, ior)
end
local glass, water, air = transparent(1.5), transparent(1.333), transparent(1)

local scene = gr.node('scene')

local function add(shape, material)
  shape:set_material(material)
  scene:add_child(shape)
  return shape
end

-- The floor is a plane of grout with instances of one tile on it.
add(gr.plane('grout'), gr.material({ 0.30, 0.31, 0.33 }, { 0, 0, 0 }, 1))
local tiles = {}
for i, colour in ipairs({ { 0.86, 0.85, 0.82 }, { 0.34, 0.44, 0.50 } }) do
  tiles[i] = gr.cube('tile')
  tiles[i]:set_material(gr.material(colour, { 0.1, 0.1, 0.1 }, 20))
  tiles[i]:scale(0.77, 0.02, 0.77)
end
for row = -7, 6 do
  for column = -9, 8 do
    local place = gr.node('place')
    place:add_child(tiles[1 + (row + column) % 2])
    place:translate(0.8 * column, 0, 0.8 * row)
    scene:add_child(place)
  end
end

local wall = add(gr.plane('wall'), gr.material({ 0.66, 0.69, 0.72 }, { 0, 0, 0 }, 1))
wall:rotate('x', 90)
wall:translate(0, 0, -5.2)

local colours = {
  { 0.82, 0.22, 0.20 }, { 0.93, 0.58, 0.16 }, { 0.93, 0.82, 0.28 }, { 0.36, 0.68, 0.32 },
  { 0.18, 0.58, 0.66 }, { 0.26, 0.38, 0.80 }, { 0.58, 0.32, 0.70 },
}
for i, colour in ipairs(colours) do
  local column = add(gr.cylinder('column'), gr.material(colour, { 0.3, 0.3, 0.3 }, 40))
  column:scale(0.28, 1.5, 0.28)
  column:translate(1.35 * (i - 4), 1.5, -3.6)
end

add(gr.nh_sphere('ball', { -1.75, 0.97, 0.25 }, 0.95), glass)

-- Water: media nest by themselves, as a ray knows what it is in.
add(gr.nh_box('water', { 0.25, 0.03, -0.75 }, 1.7), water)
add(gr.nh_sphere('glass in water', { 0.82, 0.62, 0.2 }, 0.42), glass)
add(gr.nh_sphere('air in water', { 1.52, 1.12, 0.0 }, 0.3), air)
-- Shapes do not let light through to what they hold, so the berries have a light of their own in the water.
add(gr.nh_sphere('berry', { 1.5, 0.25, 0.45 }, 0.2), gr.material({ 0.90, 0.25, 0.22 }, { 0.4, 0.4, 0.4 }, 40))
add(gr.nh_sphere('berry', { 1.2, 0.17, 0.7 }, 0.12), gr.material({ 0.95, 0.75, 0.20 }, { 0.4, 0.4, 0.4 }, 40))

local ring = add(gr.torus('ring', 0.5, 0.17), glass)
ring:translate(-0.45, 0.2, 1.75)

local key = gr.light({ -4, 8, 5 }, { 0.72, 0.70, 0.65 }, { 1, 0, 0 })
local fill = gr.light({ 6, 5, 6 }, { 0.22, 0.24, 0.28 }, { 1, 0, 0 })
local inside = gr.light({ 1.0, 1.5, 0.75 }, { 0.6, 0.6, 0.6 }, { 1, 0, 0.4 })

gr.render(scene, 'glass.png', 640, 360,
  { -0.3, 2.3, 7.2 }, { 0.05, 0.85, 0 }, { 0, 1, 0 }, 34,
  { 0.34, 0.34, 0.36 }, { key, fill, inside },
  4) -- AA
