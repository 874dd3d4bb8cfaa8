--- Water: the pool's waves, the falling sheet with its strands, foam and drops. `time` is in seconds.

local Mesh = require('lib.mesh')
local shape = require('lib.shape')
local valley = require('lib.valley')
local between, mix, step, fractal = shape.between, shape.mix, shape.step, shape.fractal
local fall = valley.fall
local noise = gr.noise

local water = {}

--- Height of the pool's surface: wind waves, rings that run from the fall's foot, and chop about it.
function water.wave(x, z, time)
  local dx, dz = x - fall.x, z - fall.foot_z
  local r = math.sqrt(0.55 * dx * dx + dz * dz)
  local wind = 0.050 * fractal(0.42 * x + 0.25 * time, 0.75 * z + 0.3 * time, 0.35 * time, 3)
  local rings = 0.042 * math.exp(-r / 5) * math.sin(4.6 * r - 5 * time + 2.5 * noise(0.5 * x, 0.5 * z, 2.5))
  local chop = r < 7 and 0.16 * math.exp(-r / 1.7) * noise(1.5 * x, 1.5 * z, 1.6 * time) or 0
  return wind + rings + chop
end

--- The waves' slope at (x, z) in x and in z.
function water.slope(x, z, time)
  local e = 0.3
  return (water.wave(x + e, z, time) - water.wave(x - e, z, time)) / (2 * e),
    (water.wave(x, z + e, time) - water.wave(x, z - e, time)) / (2 * e)
end

--- The pool's surface over the box, where `wet(x, z)`.
function water.pool(x0, x1, z0, z1, cell, time, wet)
  local mesh = Mesh.new()
  local columns, rows = math.ceil((x1 - x0) / cell), math.ceil((z1 - z0) / cell)
  local row_above
  for j = 0, rows do
    local z = mix(z0, z1, j / rows)
    local row = {}
    for i = 0, columns do
      local x = mix(x0, x1, i / columns)
      if wet(x, z) then
        row[i] = mesh:vertex(x, water.wave(x, z, time), z, 0, 1, 0, x, z)
      end
    end
    if row_above then
      for i = 0, columns - 1 do
        local a, b, c, d = row_above[i], row[i], row[i + 1], row_above[i + 1]
        if a and b and c and d then mesh:quad(a, b, c, d) end
      end
    end
    row_above = row
  end
  return mesh:smooth()
end

--- Where water of the strand `u` (-1 to 1 across the edge) is, as a function of the seconds since it left the edge;
--- before that it comes over the plateau. The edge is uneven: some strands leave faster and lower than others.
local function course(fall, u)
  local speed = 1.15 + 0.35 * noise(2.6 * u, 3.3, 0.5)
  local edge_y = fall.lip_y - 0.22 * math.abs(u) ^ 3 + 0.25 * noise(1.9 * u, 0.3, 8.8)
  local x = fall.x + 0.5 * fall.width * u
  return function(t)
    if t < 0 then return x, edge_y - 0.02 * t, fall.lip_z + 2.0 * t end
    local drop = 4.9 * t * t
    local share = drop / fall.lip_y
    return x + (0.34 * u + 0.16 * noise(5 * u, 1.1 * drop, 2.2)) * share, edge_y - drop, fall.lip_z + speed * t
  end
end

--- Seconds from the edge to the pool, from where the edge is highest.
local function fall_time(fall)
  return math.sqrt((fall.lip_y + 0.25) / 4.9)
end

--- The body of the fall: a sheet over its width with folds that run down.
function water.sheet(fall, columns, rows, time, inset)
  local mesh = Mesh.new()
  for i = 0, columns do
    local u = mix(-1, 1, i / columns) * inset
    local at = course(fall, u)
    for j = 0, rows do
      local q = j / rows
      local t = mix(-0.5, fall_time(fall) + 0.02, q ^ 0.8)
      local x, y, z = at(t)
      local fold = 0.13 * noise(5.5 * u, 0.5 * y + 1.5 * time, 0.5) + 0.06 * noise(15 * u, 0.8 * y + 2.6 * time, 1.5)
      mesh:vertex(x, y, z - 0.10 + fold * step(-0.3, 0.3, t), 0, 0, 1, u, -y / 2)
    end
  end
  for i = 0, columns - 1 do
    for j = 0, rows - 1 do
      local a = i * (rows + 1) + j
      mesh:quad(a, a + 1, a + rows + 2, a + rows + 1)
    end
  end
  return mesh:smooth()
end

--- Strands of white water: ribbons that run down the fall, `count` of them in `kinds` meshes. Near the edge the water
--- is still whole, and they are thin; towards the foot they part.
function water.strands(fall, count, kinds, thickness, time)
  local meshes = {}
  for k = 1, kinds do meshes[k] = Mesh.new() end
  local total = fall_time(fall)
  for i = 1, count do
    local mesh = meshes[1 + i % kinds]
    local u = 2 * ((i + between(-0.5, 0.5)) * 0.6180339887 % 1) - 1
    -- Denser in some tongues of the sheet than in others.
    u = u + 0.13 * noise(4.2 * u, 0.7, 3.5) + 0.06 * noise(11 * u, 0.7, 1.5)
    local length = between(0.25, 0.8)
    local from = (between(0, total + length) + time) % (total + length) - length
    local thick = thickness * between(0.25, 1) ^ 1.5
    local forward = between(-0.04, 0.24)
    local wobble = between(0, 100)
    local whole_until = 0.25 * noise(wobble, 2.5, 0.5)
    local at = course(fall, u)
    local pieces = 18
    local previous
    for k = 0, pieces do
      local t = from + length * k / pieces
      if t > -0.12 and t < total + 0.03 then
        local x, y, z = at(t)
        local q = math.max(0, t / total)
        local ends = math.max(0, math.sin(math.pi * k / pieces)) ^ 0.6
        local whole = 0.25 + 0.75 * step(0.02, 0.30, q + whole_until)
        local half = thick * ends * whole * (1 + 0.6 * noise(wobble, 1.7 * y, 4.5)) * (1 - 0.3 * q)
        x = x + (0.02 + 0.13 * q) * noise(wobble, 1.1 * y, 1.5)
        z = z + forward * (0.10 + q)
        -- A little round across, and turned up where it goes over the edge.
        local over = t < 0.15 and 1 or 0.4
        local a = mesh:vertex(x - half, y, z, -0.35, over, 0.9)
        local b = mesh:vertex(x + half, y, z, 0.35, over, 0.9)
        if previous then mesh:quad(previous[1], a, b, previous[2]) end
        previous = { a, b }
      else
        previous = nil
      end
    end
  end
  return meshes
end

--- Where the middle of the fall, `t` seconds after the edge or later, meets the rock whose depth at (x, y) is
--- `face(x, y)`.
function water.landing(fall, t, face)
  local at = course(fall, 0)
  local x, y, z = at(t)
  while y > 0 and face(x, y) < z do
    t = t + 0.01
    x, y, z = at(t)
  end
  return x, y, z
end

--- Calls `put(x, y, z, radius)` for drops thrown up about the foot.
function water.drops(count, time, put)
  for _ = 1, count do
    local u, age = between(-1.1, 1.1), (between(0, 0.8) + time) % 0.8
    local up, out, aside = between(0.8, 3.4), between(-0.5, 2.2), between(-1.3, 1.3)
    local y = up * age - 4.9 * age * age
    local radius = between(0.006, 0.024)
    if y > 0 then put(fall.x + 0.55 * fall.width * u + aside * age, y, fall.foot_z - 0.3 + out * age, radius) end
  end
  -- And torn off the sheet on its way down.
  for _ = 1, count do
    local u, t = between(-1.12, 1.12), (between(0.35, 1) * fall_time(fall) + time) % fall_time(fall)
    local x, y, z = course(fall, u)(t)
    local q = t / fall_time(fall)
    local radius, aside, forward = between(0.005, 0.018), between(-0.35, 0.35), between(-0.1, 0.5)
    if q > 0.3 then put(x + aside * q, y, z + forward * q, radius) end
  end
end

--- Calls `put(x, y, z, radius)` for foam: a line that boils under the fall, and bubbles that drift from there.
function water.foam(count, time, put)
  for _ = 1, count do
    local u, out = between(-1.15, 1.15), between(-0.25, 0.8)
    local x, z = fall.x + 0.56 * fall.width * u, fall.foot_z + out
    local boil = 0.30 * math.exp(-(out / 0.4) ^ 2) * (0.7 + 0.6 * noise(1.5 * x, 2.2 * time, 2 * z))
    put(x, water.wave(x, z, time) + boil * math.random(), z, between(0.010, 0.035))
  end
  for _ = 1, count do
    local r, angle = 0.35 + 4.8 * between(0, 1) ^ 2.0, between(-0.35, math.pi + 0.35)
    local x, z = fall.x + (1.2 + r) * math.cos(angle) * 1.15, fall.foot_z + (0.15 + r) * math.sin(angle) - 0.2
    local radius = between(0.010, 0.040) * math.exp(-r / 4)
    local streak = noise(1.3 * x, 1.3 * z, 7.5) + 0.55 * noise(3.7 * x, 3.7 * z, 1.5)
    if streak > -0.25 + 0.16 * r and valley.inside_pool(x, z) > 0.1 then
      put(x, water.wave(x, z, time) + 0.1 * radius, z, radius)
    end
  end
end

return water
