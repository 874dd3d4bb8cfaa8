--- Sums of noise and the curves to shape them with.

local shape = {}
local noise = gr.noise

function shape.clamp(x, low, high)
  return x < low and low or x > high and high or x
end

function shape.mix(a, b, t)
  return a + (b - a) * t
end

--- 0 below `low`, 1 above `high`, smooth between.
function shape.step(low, high, x)
  local t = shape.clamp((x - low) / (high - low), 0, 1)
  return t * t * (3 - 2 * t)
end

--- Octaves of noise, each twice as fine and half as strong; about [-1, 1].
function shape.fractal(x, y, z, octaves)
  local sum, weight = 0, 1
  for _ = 1, octaves do
    sum = sum + weight * noise(x, y, z)
    x, y, z, weight = 2.03 * x + 17.1, 2.03 * y + 5.3, 2.03 * z + 9.7, 0.5 * weight
  end
  return sum
end

--- Octaves of 1 - |noise|: sharp crests; about [0, 1].
function shape.ridged(x, y, z, octaves)
  local sum, weight, total = 0, 1, 0
  for _ = 1, octaves do
    local crest = 1 - math.abs(noise(x, y, z))
    sum, total = sum + weight * crest * crest, total + weight
    x, y, z, weight = 2.1 * x + 11.3, 2.1 * y + 3.7, 2.1 * z + 7.9, 0.5 * weight
  end
  return sum / total
end

--- A random number in [low, high).
function shape.between(low, high)
  return low + (high - low) * math.random()
end

--- `node` once more, under a new parent that is scaled, turned about y, leant about x and z, and moved.
function shape.place(parent, node, x, y, z, scale, turn, lean_x, lean_z, stretch)
  local at = gr.node('at')
  at:add_child(node)
  at:scale(scale, scale * (stretch or 1), scale)
  if turn then at:rotate('y', turn) end
  if lean_x and lean_x ~= 0 then at:rotate('x', lean_x) end
  if lean_z and lean_z ~= 0 then at:rotate('z', lean_z) end
  at:translate(x, y, z)
  parent:add_child(at)
  return at
end

return shape
