--- Ground from a height function, and rock faces from noise.

local Mesh = require('lib.mesh')
local shape = require('lib.shape')
local valley = require('lib.valley')
local step, fractal, ridged = shape.step, shape.fractal, shape.ridged

local terrain = {}

--- A mesh of `height(x, z)` over a grid that is fine about the origin and coarse far off: grid coordinate t in [-1, 1]
--- lies at `near * t + far * t^5`.
function terrain.ground(height, columns, rows, near, far_x, far_back, far_front)
  local mesh = Mesh.new()
  for j = 0, rows do
    local t = 2 * j / rows - 1
    local z = near * t + (t < 0 and far_back or far_front) * t ^ 5
    for i = 0, columns do
      local s = 2 * i / columns - 1
      local x = near * s + far_x * s ^ 5
      mesh:vertex(x, height(x, z), z, 0, 1, 0, x / 3, z / 3)
    end
  end
  for j = 0, rows - 1 do
    for i = 0, columns - 1 do
      local a = j * (columns + 1) + i
      mesh:quad(a, a + columns + 1, a + columns + 2, a + 1)
    end
  end
  return mesh:smooth()
end

--- A function of x and z that gives the height of such a mesh, by its own grid.
function terrain.lookup(mesh, columns, rows)
  local p = mesh.positions
  local function cell(value, count, coordinate)
    local low, high = 0, count
    while high - low > 1 do
      local middle = (low + high) // 2
      if coordinate(middle) <= value then low = middle else high = middle end
    end
    local a = coordinate(low)
    return low, shape.clamp((value - a) / (coordinate(high) - a), 0, 1)
  end
  local function x_of(i) return p[3 * i + 1] end
  local function z_of(j) return p[3 * j * (columns + 1) + 3] end
  return function(x, z)
    local i, s = cell(x, columns, x_of)
    local j, t = cell(z, rows, z_of)
    local a = 3 * (j * (columns + 1) + i) + 2
    local b = a + 3 * (columns + 1)
    return shape.mix(shape.mix(p[a], p[a + 3], s), shape.mix(p[b], p[b + 3], s), t)
  end
end

--- How far the rock stands out at (x, y): beds of stone with ledges, upright cracks between blocks, and roughness.
local function relief(x, y)
  local bed = y + 0.5 * fractal(0.22 * x, 0.15 * y, 3.1, 2)
  local layer = bed / 0.9 + 0.35 * math.sin(1.7 * bed)
  local within = layer - math.floor(layer)
  local number = math.floor(layer)
  local ledge = 0.38 * gr.noise(0.35 * x + 7.7 * number, 2.3 * number, 0.5) + 0.10 * step(0, 0.25, within) - 0.16 * step(0.8, 1, within)
  local block = 0.26 * gr.noise(0.9 * x + 3.3 * number, 0.25 * bed, 1.5 * number + 0.5)
  local buttress = 1.9 * (ridged(0.16 * x, 0.07 * y, 5.5, 2) - 0.5)
  return buttress + ledge + block + 0.10 * fractal(1.7 * x, 1.7 * y, 6.1, 3)
end

--- The cliff of the valley between x0 and x1: a curtain from below the pool's level to its top, and from there back onto
--- the plateau.
function terrain.cliff(x0, x1, columns, rows)
  local mesh = Mesh.new()
  local fall = valley.fall
  for i = 0, columns do
    local x = shape.mix(x0, x1, i / columns)
    local foot, top = valley.cliff_z(x), valley.cliff_top(x)
    local behind = math.exp(-((x - fall.x) / 2.4) ^ 4)
    for j = 0, rows do
      local t = 1.16 * j / rows
      local y, back
      if t < 1 then
        y, back = shape.mix(-2.5, top, t), 0.9 * t
      else
        y, back = top + 1.0 * (t - 1), 0.9 + 30 * (t - 1) ^ 1.3
      end
      local out = relief(x, y) * (1 - 0.75 * step(0.97, 1.08, t)) * (1 - 0.55 * behind)
      local talus = 1.6 * (1 - step(-0.5, 2.4, y)) * (1 - behind)
      mesh:vertex(x + 0.25 * gr.noise(0.8 * x, 0.8 * y, 4.5), y, foot + 0.9 + out + talus - back, 0, 0, 1, x / 3.5, -y / 3.5)
    end
  end
  for i = 0, columns - 1 do
    for j = 0, rows - 1 do
      local a = i * (rows + 1) + j
      mesh:quad(a, a + rows + 1, a + rows + 2, a + 1)
    end
  end
  return mesh:smooth()
end

--- A ball of triangles about the origin, radius about 1, dented and cracked by noise; `seed` makes another one.
function terrain.rock(seed, rings, flatness)
  local mesh = Mesh.new()
  local around = 2 * rings
  for j = 0, rings do
    local polar = math.pi * j / rings
    for i = 0, around do
      local azimuth = 2 * math.pi * (i % around) / around
      local x, y, z = math.sin(polar) * math.cos(azimuth), math.cos(polar), math.sin(polar) * math.sin(azimuth)
      local r = 1 + 0.42 * gr.noise(0.9 * x + seed, 0.9 * y, 0.9 * z) - 0.28 * step(0.55, 0.95, ridged(0.8 * x + seed, 0.8 * y, 0.8 * z, 2))
        + 0.16 * fractal(2.4 * x, 2.4 * y + seed, 2.4 * z, 3)
      -- Cut by a few planes, which gives it faces.
      for k = 1, 6 do
        local ax, ay, az = gr.noise(seed, 3.7 * k, 0.5), gr.noise(seed, 0.5, 5.3 * k), gr.noise(0.5, seed, 7.1 * k)
        local size = math.sqrt(ax * ax + ay * ay + az * az) + 1e-6
        local along = (x * ax + y * ay + z * az) / size
        if along * r > 0.72 then r = shape.mix(r, 0.72 / along, 0.75) end
      end
      mesh:vertex(r * x, r * y * flatness, r * z, x, y, z, 2 * i / around, j / rings)
    end
  end
  for j = 0, rings - 1 do
    for i = 0, around - 1 do
      local a = j * (around + 1) + i
      mesh:quad(a, a + 1, a + around + 2, a + around + 1)
    end
  end
  return mesh:smooth()
end

return terrain
