--- Trees, ferns and grass, grown from random numbers. Everything stands on y = 0 at the origin.

local Mesh = require('lib.mesh')
local shape = require('lib.shape')
local between, mix = shape.between, shape.mix
local sin, cos, sqrt, pi = math.sin, math.cos, math.sqrt, math.pi

local tree = {}

--- A unit vector across (dx, dy, dz), and the one across both.
local function across(dx, dy, dz)
  local ux, uy, uz
  if math.abs(dy) < 0.9 then ux, uy, uz = -dz, 0, dx else ux, uy, uz = 0, dz, -dy end
  local size = sqrt(ux * ux + uy * uy + uz * uz)
  ux, uy, uz = ux / size, uy / size, uz / size
  return ux, uy, uz, dy * uz - dz * uy, dz * ux - dx * uz, dx * uy - dy * ux
end

--- A tube through `points` ({x, y, z, radius} each), with `sides` sides; `swell` roughens its outline.
function tree.tube(mesh, points, sides, swell)
  local first = mesh.count
  local along = 0
  for k, p in ipairs(points) do
    local a, b = points[math.max(1, k - 1)], points[math.min(#points, k + 1)]
    local dx, dy, dz = b[1] - a[1], b[2] - a[2], b[3] - a[3]
    local size = sqrt(dx * dx + dy * dy + dz * dz)
    local ux, uy, uz, vx, vy, vz = across(dx / size, dy / size, dz / size)
    if k > 1 then along = along + size / 2 end
    for i = 0, sides do
      local angle = 2 * pi * i / sides
      local c, s = cos(angle), sin(angle)
      local nx, ny, nz = c * ux + s * vx, c * uy + s * vy, c * uz + s * vz
      local r = p[4]
      if swell then r = r * (1 + swell * gr.noise(1.3 * c + p[1], 1.3 * s + 7.1, 0.9 * p[2])) end
      mesh:vertex(p[1] + r * nx, p[2] + r * ny, p[3] + r * nz, nx, ny, nz, i / sides, -along / 1.6)
    end
  end
  for k = 0, #points - 2 do
    for i = 0, sides - 1 do
      local a = first + k * (sides + 1) + i
      mesh:quad(a, a + 1, a + sides + 2, a + sides + 1)
    end
  end
end

--- A leaf: two triangles folded along the midrib, from (x, y, z) along the unit vector d, `size` long. The normals lean
--- from the leaf's own to (nx, ny, nz), the crown's, which shades a crown as a whole.
function tree.leaf(mesh, x, y, z, dx, dy, dz, size, width, nx, ny, nz)
  local ux, uy, uz, vx, vy, vz = across(dx, dy, dz)
  local roll = between(-1.2, 1.2)
  local c, s = cos(roll), sin(roll)
  local ax, ay, az = c * ux + s * vx, c * uy + s * vy, c * uz + s * vz
  local bx, by, bz = c * vx - s * ux, c * vy - s * uy, c * vz - s * uz
  if by * ny + bx * nx + bz * nz < 0 then bx, by, bz = -bx, -by, -bz end
  local mx, my, mz = mix(bx, nx, 0.55), mix(by, ny, 0.55), mix(bz, nz, 0.55)
  local half, lift = width * size, 0.12 * size
  local a = mesh:vertex(x, y, z, mx, my, mz)
  local b = mesh:vertex(x + dx * size, y + dy * size, z + dz * size, mx, my, mz)
  local px, py, pz = x + 0.45 * dx * size + lift * bx, y + 0.45 * dy * size + lift * by,
    z + 0.45 * dz * size + lift * bz
  local e = mesh:vertex(px + half * ax, py + half * ay, pz + half * az, mx - 0.4 * ax, my - 0.4 * ay, mz - 0.4 * az)
  local f = mesh:vertex(px - half * ax, py - half * ay, pz - half * az, mx + 0.4 * ax, my + 0.4 * ay, mz + 0.4 * az)
  mesh:triangle(a, e, b)
  mesh:triangle(a, b, f)
end

--- A broadleaf tree: {height, crown, leaves a twig, leaf size}. Returns the wood and the leaves as meshes.
function tree.broadleaf(o)
  local wood, leaves = Mesh.new(), Mesh.new()
  local height = o.height
  local middle = height * 0.66

  local function twig(x, y, z, dx, dy, dz, length)
    for _ = 1, o.per_twig do
      local t = between(-0.2, 1.1)
      local px, py, pz = x + t * length * dx + 0.24 * length * between(-1, 1),
        y + t * length * dy + 0.24 * length * between(-1, 1), z + t * length * dz + 0.24 * length * between(-1, 1)
      local lx, ly, lz = dx + between(-1, 1), dy + between(-1.1, 0.5), dz + between(-1, 1)
      local size = sqrt(lx * lx + ly * ly + lz * lz) + 1e-6
      local nx, ny, nz = px, (py - middle) + 0.3 * height, pz
      local far = sqrt(nx * nx + ny * ny + nz * nz) + 1e-6
      tree.leaf(leaves, px, py, pz, lx / size, ly / size, lz / size, o.leaf * between(0.7, 1.25), 0.34,
        nx / far, ny / far, nz / far)
    end
  end

  local function branch(x, y, z, dx, dy, dz, length, radius, level)
    local points = { { x, y, z, radius } }
    local steps = level == 0 and 7 or 4
    local sx, sy, sz = x, y, z
    for k = 1, steps do
      local bend = level == 0 and 0.10 or 0.22
      dx, dy, dz = dx + between(-bend, bend), dy + between(-bend, bend) + (level == 0 and 0.05 or 0.09),
        dz + between(-bend, bend)
      local size = sqrt(dx * dx + dy * dy + dz * dz)
      dx, dy, dz = dx / size, dy / size, dz / size
      sx, sy, sz = sx + dx * length / steps, sy + dy * length / steps, sz + dz * length / steps
      local t = k / steps
      points[#points + 1] = { sx, sy, sz, radius * (1 - (level == 0 and 0.72 or 0.75) * t) }
      if level >= 2 and k >= 2 then twig(sx, sy, sz, dx, dy, dz, 0.55 * length) end
      if level < 2 and t > (level == 0 and 0.30 or 0.25) then
        for _ = 1, level == 0 and 3 or 2 do
          local ux, uy, uz, vx, vy, vz = across(dx, dy, dz)
          local turn, spread = between(0, 2 * pi), between(0.6, 1.15)
          local c, s = cos(turn) * spread, sin(turn) * spread
          local bx, by, bz = dx + c * ux + s * vx, dy + c * uy + s * vy, dz + c * uz + s * vz
          local far = sqrt(bx * bx + by * by + bz * bz)
          local reach = level == 0 and o.crown * between(0.7, 1.1) * (1.15 - 0.6 * t) or length * between(0.42, 0.7)
          branch(sx, sy, sz, bx / far, by / far, bz / far, reach, radius * (1 - 0.7 * t) * 0.5, level + 1)
        end
      end
    end
    tree.tube(wood, points, level == 0 and 12 or level == 1 and 6 or 3, level == 0 and 0.25 or nil)
  end
  -- The root flare is the first bit of the trunk.
  branch(0, -0.3, 0, between(-0.08, 0.08), 1, between(-0.08, 0.08), height * 0.82, o.radius, 0)
  return wood, leaves
end

--- A spruce: whorls of boughs that droop, each a row of twigs with needles in flat strips.
function tree.conifer(o)
  local wood, needles = Mesh.new(), Mesh.new()
  local height = o.height
  local points = {}
  local bend_x, bend_z = between(-0.25, 0.25), between(-0.25, 0.25)
  for k = 0, 8 do
    local t = k / 8
    points[#points + 1] = { bend_x * t * t, -0.3 + t * (height + 0.3), bend_z * t * t, o.radius * (1 - 0.93 * t) }
  end
  tree.tube(wood, points, 8, 0.15)
  local y = o.bare * height
  while y < height * 0.985 do
    local t = (y - o.bare * height) / (height * (1 - o.bare))
    local reach = o.reach * (1 - t) ^ 0.85 * between(0.8, 1.12) + 0.10
    local boughs = math.floor(mix(o.boughs, 4, t) + 0.5)
    local start = between(0, 2 * pi)
    for i = 1, boughs do
      local azimuth = start + 2 * pi * i / boughs + between(-0.3, 0.3)
      local length = reach * between(0.72, 1.12)
      local c, s = cos(azimuth), sin(azimuth)
      local rise = mix(-0.12, 0.55, t) + between(-0.1, 0.1)
      local steps = math.max(3, math.floor(length / o.spacing))
      local droop = mix(0.42, 0.1, t)
      for k = 1, steps do
        local q = k / steps
        local r = q * length
        local by = y + rise * r - droop * q * q * length * 0.8 + 0.10 * q * q * q * length
        local bx, bz = bend_x * t * t + c * r, bend_z * t * t + s * r
        local twig = (0.16 + 0.42 * length * (1 - 0.62 * q)) * between(0.75, 1.2)
        for side = -1, 1, 2 do
          local open = between(0.75, 1.05) * side
          local ca, sa = cos(azimuth + open), sin(azimuth + open)
          local fall = -0.22 - 0.25 * q + between(-0.12, 0.12)
          local size = sqrt(1 + fall * fall)
          tree.leaf(needles, bx, by, bz, ca / size, fall / size, sa / size, twig, 0.13, c * 0.75, 0.75, s * 0.75)
          if twig > 0.25 then
            tree.leaf(needles, bx + 0.4 * twig * ca, by + 0.4 * twig * fall, bz + 0.4 * twig * sa,
              cos(azimuth + 0.3 * open), fall - 0.15, sin(azimuth + 0.3 * open), 0.6 * twig, 0.15,
              c * 0.75, 0.75, s * 0.75)
          end
        end
      end
      tree.leaf(needles, bend_x * t * t + c * length, y + (rise - droop * 0.8 + 0.1) * length,
        bend_z * t * t + s * length,
        c * 0.95, -0.2, s * 0.95, 0.3 * length + 0.1, 0.16, c * 0.75, 0.75, s * 0.75)
    end
    y = y + mix(o.whorl, 0.5 * o.whorl, t) * between(0.8, 1.2)
  end
  -- The leader at the top.
  for _ = 1, 6 do
    local a = between(0, 2 * pi)
    tree.leaf(needles, bend_x, height * 0.97, bend_z, 0.25 * cos(a), 0.95, 0.25 * sin(a), 0.05 * height, 0.1,
      cos(a), 0.4, sin(a))
  end
  return wood, needles
end

--- A tuft of grass: blades that bend outwards, at most `height` tall, within `spread` of the middle.
function tree.tuft(blades, height, spread, width)
  local mesh = Mesh.new()
  for _ = 1, blades do
    local azimuth, from = between(0, 2 * pi), spread * sqrt(math.random())
    local root = between(0, 2 * pi)
    local x, z = from * cos(root), from * sin(root)
    local tall, lean = height * between(0.45, 1), between(0.08, 0.75)
    local c, s = cos(azimuth), sin(azimuth)
    local w = width * between(0.7, 1.2)
    local left, right
    for k = 0, 4 do
      local t = k / 4
      local out, up = lean * tall * t * t, tall * (t - 0.35 * lean * t * t)
      local px, py, pz = x + c * out, up - 0.03, z + s * out
      local half = w * (1 - t) ^ 0.7 * 0.5
      -- Lit as the lawn is: mostly from above, a little to the blade's own side.
      local nx, ny, nz = 0.45 * s + 0.3 * c, 0.85, -0.45 * c + 0.3 * s
      if k == 4 then
        mesh:triangle(left, right, mesh:vertex(px, py, pz, nx, ny, nz))
      else
        local a = mesh:vertex(px - half * s, py, pz + half * c, nx, ny, nz)
        local b = mesh:vertex(px + half * s, py, pz - half * c, nx, ny, nz)
        if left then mesh:quad(left, right, b, a) end
        left, right = a, b
      end
    end
  end
  return mesh
end

--- Ivy that hangs in front of a wall which faces +z: strings of leaves, at most `drop` long, about the x axis.
function tree.ivy(strings, drop, spread)
  local mesh = Mesh.new()
  for _ = 1, strings do
    local x, z = between(-spread, spread), between(-0.1, 0.25)
    local length = drop * between(0.25, 1) * (1 - 0.5 * math.abs(x) / spread)
    local y = between(0, 0.25)
    local sway = between(0, 50)
    while y > -length do
      local dx, dz = between(-0.8, 0.8), between(0.1, 0.8)
      local size = sqrt(dx * dx + dz * dz + 0.5)
      tree.leaf(mesh, x + 0.25 * gr.noise(sway, y, 0.5) + between(-0.05, 0.05), y, z + 0.15 * gr.noise(sway, y, 7.5),
        dx / size, -0.707 / size, dz / size, between(0.07, 0.13), 0.42, 0.2 * dx, 0.55, 0.8)
      y = y - between(0.02, 0.05)
    end
  end
  return mesh
end

--- A fern: fronds that arch outwards, each with two rows of leaflets.
function tree.fern(fronds, length)
  local mesh = Mesh.new()
  for i = 1, fronds do
    local azimuth = 2 * pi * i / fronds + between(-0.3, 0.3)
    local c, s = cos(azimuth), sin(azimuth)
    local size, arch = length * between(0.7, 1.1), between(0.7, 1.2)
    local n = 24
    for k = 1, n do
      local t = k / n
      local out, up = size * (0.25 * t + 0.62 * t * t), size * (0.95 * t - arch * 0.75 * t * t)
      local leaflet = 0.27 * size * sin(pi * (0.12 + 0.86 * t)) ^ 0.8 * (1 - 0.35 * t)
      for side = -1, 1, 2 do
        local open = azimuth + side * 1.15
        local fall = -0.22 - 0.3 * t
        local far = sqrt(1 + fall * fall)
        local dx, dy, dz = cos(open) / far, fall / far, sin(open) / far
        local x, y, z = c * out, up, s * out
        local half = 0.021 * size
        local a = mesh:vertex(x - half * c, y - half * 0.4, z - half * s, 0.3 * c, 0.9, 0.3 * s)
        local b = mesh:vertex(x + half * c, y + half * 0.4, z + half * s, 0.3 * c, 0.9, 0.3 * s)
        mesh:triangle(a, b, mesh:vertex(x + leaflet * dx, y + leaflet * dy, z + leaflet * dz, 0.5 * cos(open), 0.8,
          0.5 * sin(open)))
      end
    end
  end
  return mesh
end

return tree
