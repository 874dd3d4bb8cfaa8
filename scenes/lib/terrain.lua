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

--- How far the rock stands out at (x, y): buttresses and gullies, beds of stone with ledges, blocks, and roughness.
local function relief(x, y)
  local bed = y + 0.9 * fractal(0.13 * x, 0.15 * y, 3.1, 3)
  local layer = bed / 1.15 + 0.5 * math.sin(1.3 * bed)
  local number = math.floor(layer)
  local within = layer - number
  local undercut = 0.22 * step(0.7, 1, within) * (1 + gr.noise(0.5 * x, 3.1 * number, 0.5))
  local ledge = 0.75 * gr.noise(0.23 * x + 7.7 * number, 2.3 * number, 0.5) - undercut
  local block = 0.5 * gr.noise(0.75 * x + 3.3 * number, 0.3 * bed, 1.5 * number + 0.5)
  local buttress = 3.6 * (ridged(0.11 * x + 0.06 * y, 0.04 * y, 5.5, 3) - 0.5)
  local crag = 0.8 * (ridged(0.45 * x, 0.30 * y + 0.1 * x, 2.5, 3) - 0.5)
  return buttress + ledge + block + crag + 0.13 * fractal(1.7 * x, 1.7 * y, 6.1, 3)
end

--- Depth z of the cliff's face at (x, y); `t` is the height's share of the cliff's, above 1 beyond the edge.
local function face(x, y, t)
  local behind = math.exp(-((x - valley.fall.x) / 2.7) ^ 4)
  local back = t < 1 and 1.6 * t or 1.6 + 34 * (t - 1) ^ 1.3
  local out = relief(x, y) * (1 - 0.75 * step(0.97, 1.08, t)) * (1 - 0.8 * behind)
  local talus = 1.8 * (1 - step(-0.5, 2.6, y + 0.8 * gr.noise(0.3 * x, 0.5, 0.5))) * (1 - behind)
  return valley.cliff_z(x) + 1.1 + out + talus - back
end

function terrain.face(x, y)
  return face(x, y, (y + 2.5) / (valley.cliff_top(x) + 2.5))
end

--- The cliff of the valley between x0 and x1: a curtain from below the pool's level to its top, and from there back
--- onto the plateau.
function terrain.cliff(x0, x1, columns, rows)
  local mesh = Mesh.new()
  for i = 0, columns do
    local x = shape.mix(x0, x1, i / columns)
    local top = valley.cliff_top(x)
    for j = 0, rows do
      local t = 1.16 * j / rows
      local y = t < 1 and shape.mix(-2.5, top, t) or top + 1.0 * (t - 1)
      mesh:vertex(x + 0.25 * gr.noise(0.8 * x, 0.8 * y, 4.5), y, face(x, y, t), 0, 0, 1, x / 6, -y / 6)
    end
  end
  for i = 0, columns - 1 do
    for j = 0, rows - 1 do
      local a = i * (rows + 1) + j
      mesh:quad(a, a + rows + 1, a + rows + 2, a + 1)
    end
  end
  return mesh:smooth():facets()
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
      local crack = 0.28 * step(0.55, 0.95, ridged(0.8 * x + seed, 0.8 * y, 0.8 * z, 2))
      local r = 1 + 0.42 * gr.noise(0.9 * x + seed, 0.9 * y, 0.9 * z) - crack
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
  return mesh:smooth():facets()
end

return terrain
