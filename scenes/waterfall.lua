-- A waterfall in a forest, on a late afternoon.
-- Look for: the water that bends over the edge, breaks into strands and ends in mist; the pool, which shows its bed
-- near the viewer and the cliff further off; hundreds of trees, each with its own size and turn, and thousands of tufts
-- of grass; ivy, ferns and moss where the rock has ledges; three swimming rings, one of them a doughnut, that lie in the
-- water as the waves tilt them; the haze between the hills; the lens, which is focused on the fall.
-- 1280x720, 40 camera samples a pixel: about six minutes on two CPU cores, two seconds of them for the script.
-- FRAME n is n / 25 seconds later: the waves run, the water falls, the rings bob.

local quality = 'full' -- or 'preview': fewer plants, 640x360, 4 samples: ten seconds or so

local levels = {
  full = { size = { 1280, 720 }, samples = 40, grid = 0.8, grass = 12000, trees = 1, strands = 2400, foam = 2000,
    drops = 700, cell = 0.11 },
  preview = { size = { 640, 360 }, samples = 4, grid = 0.6, grass = 6000, trees = 0.6, strands = 1800, foam = 1000,
    drops = 300, cell = 0.14 },
}
local level = levels[quality]
local time = gr.frame_cmd() / 25

gr.conventions { transforms = 'pre' }
local shape = require('lib.shape')
local valley = require('lib.valley')
local terrain = require('lib.terrain')
local scatter = require('lib.scatter')
local tree = require('lib.tree')
local water = require('lib.water')
local props = require('lib.props')
local between, step, place = shape.between, shape.step, shape.place
local fall = valley.fall

local scene = gr.node('scene')
-- Each part begins with math.randomseed, so that a change to one leaves the others as they are.

-------------------------------------------------------------------------------------------------------------- ground

math.randomseed(1)

local rock = gr.material { texture = 'assets/rock.png', bump = 'assets/rock.png', specular = { 0.02, 0.02, 0.02 },
  shininess = 10 }
local wet_rock = gr.material { diffuse = { 0.045, 0.046, 0.042 }, specular = { 0.25, 0.25, 0.25 }, shininess = 40,
  bump = 'assets/rock.png' }
local moss = gr.material { texture = 'assets/forest-floor.png', bump = 'assets/forest-floor.png' }
local bed = gr.material { texture = 'assets/pebbles.png', bump = 'assets/pebbles.png' }
local far_green = gr.material { diffuse = { 0.05, 0.075, 0.025 } }

local grid = math.floor(170 * level.grid)
local ground = terrain.ground(valley.height, grid, grid, 17, 130, 200, 12)
ground:split('ground', { bed = bed, floor = moss, rock = rock, far = far_green }, function(_, ny, _, x, y, z)
  if y < 0.06 + 0.05 * gr.noise(3 * x, 3 * z, 0.5) and z > -12 and math.abs(x) < 30 then return 'bed' end
  if ny < 0.66 then return 'rock' end
  return z < -60 and 'far' or 'floor'
end, scene)
local height_at = terrain.lookup(ground, grid, grid)

local cliff = terrain.cliff(-32, 36, math.floor(330 * level.grid), math.floor(110 * level.grid))
cliff:split('cliff', { rock = rock, wet = wet_rock, moss = moss }, function(_, ny, _, x, y, z)
  local patch = gr.noise(0.5 * x, 0.7 * y, 0.3 * z) + 0.5 * gr.noise(1.7 * x, 1.7 * y, 1.7 * z)
  if ny > 0.62 - 0.35 * patch and math.abs(x - fall.x) > 1.2 then return 'moss' end
  if math.abs(x - fall.x) < 2.3 + 0.9 * patch or y < 0.35 + 0.3 * patch then return 'wet' end
  return 'rock'
end, scene)

-- Beyond the edges of what is modelled, for the rays that get there by way of the water.
local land = gr.plane('land')
land:set_material(far_green)
land:translate(0, -4, 0)
scene:add_child(land)

-- Boulders: about the foot of the fall, along the shore, under the cliff.
local boulders = {}
for k = 1, 5 do
  local boulder = gr.node('boulder')
  local mesh = terrain.rock(13.7 * k, math.floor(34 * level.grid), 0.72)
  mesh:split('rock', { rock = rock, wet = wet_rock, moss = moss }, function(_, ny, _, x, y, z)
    local patch = gr.noise(1.9 * x + k, 1.9 * y, 1.9 * z)
    if ny > 0.62 - 0.3 * patch then return 'moss' end
    return y < -0.12 + 0.1 * patch and 'wet' or 'rock'
  end, boulder)
  boulders[k] = boulder
end
local stones = {}
for k = 1, 3 do
  local stone = gr.node('stone')
  terrain.rock(71.3 * k, 12, 0.6):split('stone', { wet = wet_rock, rock = rock }, function(_, ny)
    return ny > 0.1 and 'rock' or 'wet'
  end, stone)
  stones[k] = stone
end
local function boulder(k, x, y, z, size, turn)
  place(scene, boulders[k], x, y, z, size, turn, between(-9, 9), between(-9, 9))
end
boulder(1, -5.6, 0.1, -6.6, 1.15, 20)
boulder(2, -0.5, 0.0, -6.7, 1.0, 130)
boulder(3, -3.9, -0.25, -5.9, 0.75, 70)
boulder(4, -1.9, -0.2, -5.6, 0.62, 200)
boulder(5, 0.9, 0.1, -6.9, 1.35, 310)
boulder(2, -7.6, 0.3, -5.4, 1.5, 50)
boulder(1, 5.6, 0.0, -3.6, 0.9, 80)
boulder(3, 3.2, -0.2, -5.8, 0.8, 10)
boulder(5, -2.9, -0.15, 8.4, 0.55, 110)
boulder(4, -4.2, 0.15, 9.1, 0.7, 33)
boulder(1, 6.9, 0.0, 1.6, 1.2, 222)
boulder(2, 2.1, -0.30, 8.7, 0.5, 170)
for _, p in ipairs(scatter.points { count = 260, tries = 12, x0 = -13, x1 = 16, z0 = -9, z1 = 13, spacing = 0.25,
  chance = function(x, z)
  local w = valley.inside_pool(x, z)
  return math.exp(-((w + 0.1) / 0.55) ^ 2)
end }) do
  local size = 0.06 + 0.34 * math.random() ^ 3
  place(scene, stones[math.random(3)], p[1], height_at(p[1], p[2]) + 0.2 * size, p[2], size, between(0, 360))
end

for _ = 1, 90 do
  local x, size = between(0, 13), 0.10 + 0.35 * math.random() ^ 2
  place(scene, stones[math.random(3)], x, between(-0.05, 0.1), terrain.face(x, 0.1) + between(-0.1, 0.4), size,
    between(0, 360))
end

--------------------------------------------------------------------------------------------------------------- water

math.randomseed(2)

local pool = water.pool(-13, 20, -9.2, 13.4, level.cell, time, function(x, z)
  return height_at(x, z) < 0.3
end):node('pool', gr.material {
  diffuse = { 0, 0, 0 }, specular = { 0.5, 0.45, 0.35 }, shininess = 200, reflection = 1, ior = 1.33,
  casts_shadow = false,
})
scene:add_child(pool)
-- The water's own colour: light that it scatters on the way to the bed.
local depth = gr.cube('depth')
depth:set_material(gr.material { diffuse = { 0.020, 0.058, 0.042 }, density = 0.48 })
depth:translate(-0.5, -1, -0.5)
depth:scale(44, 4, 34)
depth:translate(3, -0.16, 3)
scene:add_child(depth)

-- A rock on the edge parts the water.
local left = { x = -3.75, width = 2.5, lip_y = 7.3, lip_z = fall.lip_z }
local right = { x = -1.55, width = 0.9, lip_y = 7.0, lip_z = fall.lip_z + 0.15 }
boulder(3, -2.25, 7.05, fall.lip_z - 0.1, 0.62, 10)
boulder(4, -2.45, 0.9, -7.1, 0.85, 170)
boulder(2, -4.9, 0.5, -6.9, 0.9, 250)
local side = { x = 1.3, width = 0.42, lip_y = 6.4 }
side.lip_z = terrain.face(side.x, side.lip_y) + 0.25
local whites = { { 0.16, 0.20, 0.22 }, { 0.26, 0.295, 0.31 }, { 0.37, 0.39, 0.40 } }
-- Whole and dark where it bends over the edge, whiter as it breaks up.
local sheets = {
  glass = gr.material { diffuse = { 0.06, 0.095, 0.09 }, specular = { 0.5, 0.5, 0.5 }, shininess = 60,
    reflection = 0.25, glossy = 0.1 },
  clear = gr.material { diffuse = { 0.085, 0.12, 0.13 }, specular = { 0.4, 0.4, 0.4 }, shininess = 40 },
  torn = gr.material { diffuse = { 0.19, 0.225, 0.24 }, specular = { 0.2, 0.2, 0.2 }, shininess = 20 },
}
for _, falls in ipairs { { left, level.strands, 0.021 }, { right, level.strands // 3, 0.019 }, { side, 160, 0.012 } } do
  local f = falls[1]
  water.sheet(f, 70, 70, time, 0.9):split('sheet', sheets, function(_, _, _, x, y)
    local broken = (f.lip_y - y) / f.lip_y + 0.22 * gr.noise(4.5 * x, 0.5 * y, 0.5)
      + 0.10 * gr.noise(13 * x, 1.1 * y, 3.5)
    return broken < 0.10 and 'glass' or broken < 0.32 and 'clear' or 'torn'
  end, scene)
  for k, mesh in ipairs(water.strands(f, falls[2], #whites, falls[3], time)) do
    scene:add_child(mesh:node('strands', gr.material {
      diffuse = whites[k], specular = { 0.2, 0.2, 0.2 }, shininess = 20, casts_shadow = false,
    }))
  end
end
local white = gr.material { diffuse = { 0.40, 0.43, 0.44 }, specular = { 0.4, 0.4, 0.4 }, shininess = 40 }
local drop = gr.sphere('drop')
drop:set_material(white)
local function flying(x, y, z, radius) place(scene, drop, x, y, z, radius) end
local function floating(x, y, z, radius) place(scene, drop, x, y, z, radius, 0, 0, 0, 0.4) end
water.drops(level.drops, time, flying)
water.foam(level.foam, time, floating)
-- Where the small fall ends on the rock: stones, and froth between them.
for _, after in ipairs { 0.3, 0.8 } do
  local x, y, z = water.landing(side, after, terrain.face)
  for _ = 1, 14 do
    place(scene, stones[math.random(3)], x + between(-0.7, 0.7), y + between(-0.25, 0.05), z + between(0, 0.5),
      between(0.08, 0.26), between(0, 360))
  end
  for _ = 1, 260 do
    local out = math.random()
    flying(x + between(-0.35, 0.35) * (1 + out), y + 0.3 * (1 - out) * math.random(), z + 0.5 * out,
      between(0.005, 0.018))
  end
end

-- Mist: spray about the foot, a thinner cloud above it, and haze between the hills.
-- A ray may be in four mists at a time: these three, and the water's.
local function cloud(x, y, z, sx, sy, sz, density, colour)
  local ball = gr.sphere('mist')
  ball:set_material(gr.material { diffuse = colour or { 0.225, 0.24, 0.25 }, density = density })
  ball:scale(sx, sy, sz)
  ball:translate(x, y, z)
  scene:add_child(ball)
end
cloud(fall.x, 0.1, fall.foot_z + 0.2, 3.1, 1.1, 1.2, 0.65)
cloud(fall.x + 0.3, 0.3, fall.foot_z + 0.6, 4.2, 2.2, 2.0, 0.10)
cloud(fall.x + 0.8, 0.6, fall.foot_z + 1.0, 6.2, 3.4, 3.0, 0.055)
local haze = gr.cube('haze')
haze:set_material(gr.material { diffuse = { 0.20, 0.215, 0.24 }, density = 0.0045 })
haze:translate(-0.5, 0, -1)
haze:scale(420, 40, 230)
haze:translate(0, 0.3, -13)
scene:add_child(haze)

-------------------------------------------------------------------------------------------------------------- plants

math.randomseed(3)

local bark = gr.material { texture = 'assets/trunk.png', bump = 'assets/trunk.png' }
local function leafy(colour, glow)
  return gr.material { diffuse = colour, specular = { 0.03, 0.03, 0.02 }, shininess = 12,
    emission = { 0.05 * colour[1], 0.05 * colour[2], 0.03 * colour[3] } }
end

--- One node for each tint of each tree.
local function grown(kinds, grow, tints)
  local nodes = {}
  for _, options in ipairs(kinds) do
    local wood, leaves = grow(options)
    local trunk = wood:node('wood', bark)
    for _, tint in ipairs(tints) do
      local node = gr.node('tree')
      node:add_child(trunk)
      node:add_child(leaves:node('leaves', leafy(tint)))
      nodes[#nodes + 1] = node
    end
  end
  return nodes
end
local spruces = grown({
  { height = 9.5, reach = 1.9, radius = 0.17, bare = 0.07, boughs = 9, whorl = 0.36, spacing = 0.17 },
  { height = 8.0, reach = 1.9, radius = 0.16, bare = 0.04, boughs = 8, whorl = 0.34, spacing = 0.18 },
  { height = 11.0, reach = 1.7, radius = 0.18, bare = 0.14, boughs = 8, whorl = 0.42, spacing = 0.18 },
}, tree.conifer, { { 0.030, 0.060, 0.030 }, { 0.045, 0.080, 0.028 }, { 0.035, 0.070, 0.050 } })
local broadleaves = grown({
  { height = 7.0, crown = 2.6, radius = 0.20, per_twig = 13, leaf = 0.26 },
  { height = 6.0, crown = 2.5, radius = 0.17, per_twig = 13, leaf = 0.24 },
  { height = 8.0, crown = 2.4, radius = 0.19, per_twig = 12, leaf = 0.26 },
}, tree.broadleaf, {
  { 0.085, 0.130, 0.022 }, { 0.130, 0.150, 0.025 }, { 0.200, 0.150, 0.025 }, { 0.055, 0.105, 0.030 },
})

local function forest(count, x0, x1, z0, z1, spacing, chance, share_of_spruces, low, high)
  math.randomseed(count)
  for _, p in ipairs(scatter.points { count = math.floor(count * level.trees), tries = 8, x0 = x0, x1 = x1,
    z0 = z0, z1 = z1, spacing = spacing, chance = chance }) do
    local x, z = p[1], p[2]
    local kinds = math.random() < share_of_spruces and spruces or broadleaves
    place(scene, kinds[math.random(#kinds)], x, height_at(x, z) - 0.1, z, between(low, high), between(0, 360),
      between(-3, 3), between(-3, 3), between(0.9, 1.15))
  end
end
-- One near the viewer, whose boughs frame the picture.
local framing = { height = 6.4, crown = 3.4, radius = 0.24, per_twig = 30, leaf = 0.15 }
place(scene, grown({ framing }, tree.broadleaf, { { 0.095, 0.140, 0.022 } })[1],
  -3.3, height_at(-3.3, 10.4), 10.4, 1, 200)
-- On the plateau, open along the river.
forest(150, -40, 44, -42, 4, 1.6, function(x, z)
  local s = valley.cliff_z(x) - z
  if s < 2.2 then return 0 end
  return 0.9 * step(3.0, 12.0, math.abs(x - fall.x - 1.5 * step(5, 30, s)))
end, 0.6, 0.35, 0.85)
-- On the hills.
forest(420, -150, 150, -190, -40, 3.2, function(x, z) return 0.9 end, 0.75, 0.7, 1.3)
-- At both sides of the pool.
local function away_from_water(distance)
  return function(x, z)
    return valley.inside_pool(x, z) < -distance and valley.cliff_z(x) < z - 1.5 and 0.9 or 0
  end
end
forest(20, -24, -10, -8, 12, 2.0, away_from_water(2.0), 0.3, 0.6, 1.0)
forest(26, 9, 27, -8, 8, 2.0, away_from_water(1.6), 0.4, 0.6, 1.0)

-- Bushes along the foot of the cliff.
for _, p in ipairs(scatter.points { count = 70, tries = 12, x0 = -18, x1 = 21, z0 = -9, z1 = 3, spacing = 0.9,
  chance = function(x, z)
  local s = z - valley.cliff_z(x)
  return s > 1.6 and s < 5 and valley.inside_pool(x, z) < -0.4 and 0.8 or 0
end }) do
  local bush = broadleaves[math.random(#broadleaves)]
  place(scene, bush, p[1], height_at(p[1], p[2]) - 0.3, p[2], between(0.15, 0.42), between(0, 360))
end

-- Ferns and grass, the nearer the denser.
local ferns = {}
for k, tint in ipairs { { 0.060, 0.125, 0.020 }, { 0.085, 0.140, 0.022 }, { 0.045, 0.105, 0.026 } } do
  ferns[k] = tree.fern(9 + k, 0.85):node('fern', leafy(tint))
end
for _, p in ipairs(scatter.points { count = 240, tries = 10, x0 = -16, x1 = 18, z0 = -8, z1 = 13, spacing = 0.5,
  chance = function(x, z)
  local w = valley.inside_pool(x, z)
  if w > -0.25 or valley.cliff_z(x) > z - 1 then return 0 end
  return 0.5 * step(-0.1, 0.5, gr.noise(0.4 * x, 0.4 * z, 4.5)) * math.exp(w / 5)
end }) do
  place(scene, ferns[math.random(3)], p[1], height_at(p[1], p[2]), p[2], between(0.5, 1.15), between(0, 360),
    between(-8, 8), between(-8, 8))
end
local tufts = {}
local grass_tints = { { 0.090, 0.140, 0.022 }, { 0.130, 0.165, 0.030 }, { 0.065, 0.120, 0.025 },
  { 0.175, 0.165, 0.050 }, { 0.105, 0.150, 0.018 } }
for k = 1, 10 do
  tufts[k] = tree.tuft(30, k <= 7 and 0.34 or 0.55, 0.16, 0.019):node('tuft', leafy(grass_tints[1 + k % #grass_tints]))
end
for _, p in ipairs(scatter.points { count = level.grass, tries = 8, x0 = -15, x1 = 17, z0 = -7, z1 = 14.5,
  chance = function(x, z)
  if math.random() > 0.25 + 0.75 * step(4, 11, z) then return 0 end
  if height_at(x, z) < 0.1 or valley.cliff_z(x) > z - 0.8 then return 0 end
  if (x + 0.35) ^ 2 + (z - 9.4) ^ 2 < 0.2 then return 0 end
  return 0.35 + 0.65 * step(-0.4, 0.3, gr.noise(0.6 * x, 0.6 * z, 9.5))
end }) do
  local x, z = p[1], p[2]
  local meadow = gr.noise(0.35 * x, 0.35 * z, 2.5)
  local k = 1 + math.floor(shape.clamp((meadow + 0.6 + between(-0.3, 0.3)) * 7, 0, 9.99))
  place(scene, tufts[k], x, height_at(x, z), z, between(0.6, 1.2) * (1 + 0.4 * meadow), between(0, 360))
end

-- Daisies and buttercups in the grass.
local flowers = {}
for k, petals in ipairs { { 0.80, 0.80, 0.76 }, { 0.85, 0.62, 0.05 }, { 0.45, 0.25, 0.65 } } do
  local flower, petal = gr.node('flower'), gr.material { diffuse = petals }
  for i = 0, 6 do
    local leaf = gr.sphere('petal')
    leaf:set_material(petal)
    leaf:scale(0.016, 0.003, 0.008)
    leaf:translate(0.017, 0, 0)
    leaf:rotate('z', 15)
    leaf:rotate('y', 360 * i / 7)
    flower:add_child(leaf)
  end
  local middle = gr.nh_sphere('middle', { 0, 0.003, 0 }, 0.008)
  middle:set_material(gr.material { diffuse = { 0.75, 0.45, 0.03 } })
  flower:add_child(middle)
  local stalk = gr.cylinder('stalk')
  stalk:set_material(leafy(grass_tints[1]))
  stalk:scale(0.0025, 0.15, 0.0025)
  stalk:translate(0, -0.15, 0)
  flower:add_child(stalk)
  flowers[k] = flower
end
for _, p in ipairs(scatter.points { count = 420, tries = 10, x0 = -6, x1 = 9, z0 = 7, z1 = 13.5, chance = function(x, z)
  return valley.inside_pool(x, z) < -0.25 and step(0.0, 0.45, gr.noise(0.9 * x, 0.9 * z, 3.5)) or 0
end }) do
  local x, z = p[1], p[2]
  local k = 1 + math.floor(shape.clamp(1.5 + 2.2 * gr.noise(0.5 * x, 0.5 * z, 1.5) + between(-0.3, 0.3), 0, 2.99))
  place(scene, flowers[k], x, height_at(x, z) + between(0.16, 0.30), z, between(0.8, 1.5), between(0, 360),
    between(0, 25), between(-15, 15))
end

-- On the cliff's ledges and along its edge: grass, ferns, small bushes and hanging ivy.
local ivies = {}
for k, tint in ipairs { { 0.040, 0.085, 0.018 }, { 0.065, 0.110, 0.020 }, { 0.090, 0.105, 0.020 } } do
  ivies[k] = tree.ivy(16, 1.5 + 0.5 * k, 0.6 + 0.2 * k):node('ivy', leafy(tint))
end
local p, n = cliff.positions, cliff.normals
for i = 0, cliff.count - 1 do
  local x, y, z = p[3 * i + 1], p[3 * i + 2], p[3 * i + 3]
  local nx, ny, nz = n[3 * i + 1], n[3 * i + 2], n[3 * i + 3]
  local up = ny / math.sqrt(nx * nx + ny * ny + nz * nz)
  local overgrown = gr.noise(0.21 * x, 0.25 * y, 3.5)
  if y > 2.5 and up > 0.1 and overgrown > 0.12 and math.abs(x - fall.x) > 2.6 and x > -22 and x < 24
    and math.random() < 0.028 / level.grid ^ 2 then
    place(scene, ivies[math.random(3)], x, y, z, between(0.6, 1.1), between(-20, 20))
  end
  if up > 0.45 and y > 0.4 and math.abs(x - fall.x) > 2.1 and x > -22 and x < 24
    and math.random() < 0.13 / level.grid ^ 2 then
    local pick = math.random()
    if pick < 0.70 then
      place(scene, tufts[math.random(10)], x, y, z, between(0.5, 1.2), between(0, 360), 14)
    elseif pick < 0.95 then
      place(scene, ferns[math.random(3)], x, y, z, between(0.4, 1.0), between(0, 360), 20)
    else
      place(scene, broadleaves[math.random(#broadleaves)], x, y - 0.1, z, between(0.10, 0.24), between(0, 360), 15)
    end
  end
end

---------------------------------------------------------------------------------------------------------------- props

math.randomseed(4)

local bone = gr.material { diffuse = { 0.55, 0.50, 0.40 }, specular = { 0.2, 0.2, 0.2 }, shininess = 20 }
local stripes = gr.material { texture = 'assets/stripes.png', specular = { 0.35, 0.35, 0.35 }, shininess = 50 }
--- Floats `node` at (x, z): sunk by `draught`, and tilted as the waves are.
local function float(node, x, z, scale, turn, draught)
  local sx, sz = water.slope(x, z, time)
  place(scene, node, x, water.wave(x, z, time) - draught, z, scale, turn, math.deg(math.atan(sz)) + 4,
    -math.deg(math.atan(sx)) - 2)
end
float(props.ring(stripes, bone), 2.9, 3.4, 0.85, 30, -0.08)
float(props.donut(), 0.55, 5.6, 0.80, 75, -0.11)
local yellow = gr.material { diffuse = { 0.80, 0.50, 0.05 }, specular = { 0.35, 0.35, 0.35 }, shininess = 50 }
float(props.ring(yellow, bone), 4.6, -1.0, 0.85, 200, -0.08)

local tones = {}
for k, tone in ipairs { { 0.17, 0.125, 0.085 }, { 0.21, 0.16, 0.11 }, { 0.135, 0.105, 0.08 } } do
  tones[k] = gr.material { diffuse = tone, bump = 'assets/floor.png', specular = { 0.05, 0.05, 0.05 }, shininess = 15 }
end
local post = gr.material { texture = 'assets/trunk.png', bump = 'assets/trunk.png' }
local iron = gr.material { diffuse = { 0.02, 0.02, 0.02 }, specular = { 0.3, 0.3, 0.3 }, shininess = 50,
  reflection = 0.15, glossy = 0.2 }
local flame = gr.material { diffuse = { 0.5, 0.3, 0.1 }, emission = { 1.6, 0.95, 0.35 }, casts_shadow = false }
place(scene, props.jetty(20, tones, post, iron, flame), -4.9, 0.52, 8.2, 1, -38)

local bunny = gr.mesh('bunny', 'assets/bunny.obj')
bunny:set_material(gr.material { diffuse = { 0.21, 0.14, 0.085 }, noise = 0.5 })
place(scene, bunny, -0.35, height_at(-0.35, 9.3) - 0.02, 9.3, 0.5, 35)

--------------------------------------------------------------------------------------------------------------- picture

math.randomseed(5)

gr.background { image = 'assets/afternoon.png' }
-- Far away: 2.3 degrees wide, a sun in thin haze. The sky is a ball so large and near that it fills most of the sky.
local sun = gr.sphere_light { position = { -430, 500, 700 }, radius = 20, colour = { 2.5, 1.86, 1.12 } }
local sky = gr.sphere_light { position = { 0, 2000, 200 }, radius = 1900, colour = { 0.62, 0.76, 0.98 } }

local eye, focus = { 1.3, 2.9, 16.6 }, { fall.x, 2.5, fall.foot_z }
gr.render {
  scene = scene, output = 'waterfall.png', size = level.size, samples = level.samples, transfer = 'srgb', max_depth = 4,
  camera = {
    eye = eye, look_at = { -0.5, 3.0, -8 }, fov = 38.5, lens = 0.036,
    focus = math.sqrt((eye[1] - focus[1]) ^ 2 + (eye[2] - focus[2]) ^ 2 + (eye[3] - focus[3]) ^ 2),
  },
  lights = { sun, sky }, ambient = { 0.20, 0.22, 0.24 },
}
