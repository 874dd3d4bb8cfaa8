--- The shape of the place, in metres: a pool (water level y = 0) under a cliff that runs across the view, a plateau
--- behind it that climbs to wooded hills, and slopes at both sides. The viewer looks towards -z.

local shape = require('lib.shape')
local step, mix, fractal = shape.step, shape.mix, shape.fractal
local noise = gr.noise

local valley = {}

--- Where the water goes over the edge, and where it meets the pool.
valley.fall = { x = -3.0, width = 3.8, lip_y = 7.3, lip_z = -8.4, foot_z = -6.6 }

--- Metres to the pool's edge: positive in the water, negative on land.
function valley.inside_pool(x, z)
  local dx, dz = (x - 0.6) / 1.2, z + 0.4
  local r = math.sqrt(dx * dx + dz * dz) + 1e-9
  local basin = 7.8 + 1.5 * noise(1.3 * dx / r + 3.1, 1.3 * dz / r, 0.4) - r
  -- The outflow, a stream towards the lower right: distance to a line.
  local t = shape.clamp(((x - 2) * 0.8 + (z - 3) * 0.6), 0, 60)
  local sx, sz = x - 2 - 0.8 * t, z - 3 - 0.6 * t
  local stream = 3.9 + 0.8 * noise(0.2 * t, 2.5, 1.5) - math.sqrt(sx * sx + sz * sz)
  local m = math.max(basin, stream)
  return m + 0.35 * noise(0.7 * x, 0.7 * z, 8.2) + 0.15 * noise(1.9 * x, 1.9 * z, 3.2)
end

--- The cliff's line z(x): a bay around the fall, whose arms reach towards the viewer.
function valley.cliff_z(x)
  local d = x - valley.fall.x
  local arm = 16 * (1 - math.exp(-(d / 19) ^ 2))
  return -9.4 + arm * (d > 0 and 0.75 or 1) + 1.3 * noise(0.13 * x, 4.4, 0.7)
end

--- The cliff's height above the pool at x.
function valley.cliff_top(x)
  local d = x - valley.fall.x
  local near = math.exp(-(d / 2.5) ^ 4)
  local line = 8.6 + 1.7 * noise(0.11 * x, 9.1, 2.2) + 0.9 * noise(0.33 * x, 1.1, 6.2) + 0.35 * noise(0.9 * x, 2.1, 4.2)
    - 0.16 * math.max(0, d) - 3.5 * step(13, 27, math.abs(d))
  return mix(line, valley.fall.lip_y + 0.05, near)
end

--- Height of the ground.
function valley.height(x, z)
  local w = valley.inside_pool(x, z)
  local low
  if w > 0 then
    low = -2.6 * (1 - math.exp(-w / 2.3)) + 0.10 * noise(0.9 * x, 0.9 * z, 5.5)
  else
    local d = -w
    low = 0.28 * (1 - math.exp(-d / 0.4)) + 0.07 * d + 0.5 * fractal(0.22 * x, 0.22 * z, 1.7, 3) * math.min(1, d / 2.5)
  end
  low = low + 10 * step(10, 34, math.abs(x - 1)) * (1 + 0.5 * noise(0.05 * x, 0.05 * z, 7.7))
  local s = valley.cliff_z(x) - z
  if s < -0.5 then return low end
  local hills = 40 * step(30, 165, s) * (0.85 + 0.55 * noise(0.016 * x + 0.4, 0.016 * z, 3.3))
  local top = valley.cliff_top(x) - 0.15 + 0.10 * math.min(s, 40) + hills
    + step(2, 16, s) * (1.6 * fractal(0.06 * x, 0.06 * z, 2.9, 3))
  local channel = (x - valley.fall.x - 1.5 * step(5, 30, s)) / 2.2
  top = top - 0.9 * math.exp(-channel ^ 4) * (1 - step(40, 70, s))
  return mix(low, top, step(-0.2, 1.6, s))
end

return valley
