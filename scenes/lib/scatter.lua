--- Random places on the ground.

local scatter = {}

--- Up to `o.count` points {x, z} in the box o.x0..o.x1, o.z0..o.z1, kept with the probability `o.chance(x, z)` and no
--- nearer to one another than `o.spacing` (0 or nil: as near as may be). Draws o.count * (o.tries or 1) candidates.
function scatter.points(o)
  local spacing, points, cells = o.spacing or 0, {}, {}
  local function crowded(x, z)
    local cx, cz = x // spacing, z // spacing
    for i = cx - 1, cx + 1 do
      for j = cz - 1, cz + 1 do
        for _, p in ipairs(cells[i * 100003 + j] or {}) do
          if (p[1] - x) ^ 2 + (p[2] - z) ^ 2 < spacing * spacing then return true end
        end
      end
    end
    return false
  end
  for _ = 1, o.count * (o.tries or 1) do
    if #points >= o.count then break end
    local x = o.x0 + (o.x1 - o.x0) * math.random()
    local z = o.z0 + (o.z1 - o.z0) * math.random()
    if math.random() < o.chance(x, z) and not (spacing > 0 and crowded(x, z)) then
      local point = { x, z }
      points[#points + 1] = point
      if spacing > 0 then
        local key = (x // spacing) * 100003 + z // spacing
        cells[key] = cells[key] or {}
        table.insert(cells[key], point)
      end
    end
  end
  return points
end

return scatter
