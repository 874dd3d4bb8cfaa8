--- Triangle meshes that grow vertex by vertex.

local Mesh = {}
Mesh.__index = Mesh

function Mesh.new()
  return setmetatable({ positions = {}, normals = {}, uvs = {}, faces = {}, count = 0 }, Mesh)
end

--- Adds a vertex with its normal (need not be a unit vector) and texture coordinates; returns its index.
function Mesh:vertex(x, y, z, nx, ny, nz, u, v)
  local k = self.count
  local p, n, t = self.positions, self.normals, self.uvs
  p[3 * k + 1], p[3 * k + 2], p[3 * k + 3] = x, y, z
  n[3 * k + 1], n[3 * k + 2], n[3 * k + 3] = nx, ny, nz
  t[2 * k + 1], t[2 * k + 2] = u or 0, v or 0
  self.count = k + 1
  return k
end

function Mesh:triangle(a, b, c)
  local f = self.faces
  local k = #f
  f[k + 1], f[k + 2], f[k + 3] = a, b, c
end

--- Corners in order around the quadrilateral.
function Mesh:quad(a, b, c, d)
  self:triangle(a, b, c)
  self:triangle(a, c, d)
end

--- Normals from the faces around each vertex, weighed by area, in place of those given.
function Mesh:smooth()
  local p, n, f = self.positions, self.normals, self.faces
  for i = 1, 3 * self.count do n[i] = 0 end
  for i = 1, #f, 3 do
    local a, b, c = 3 * f[i], 3 * f[i + 1], 3 * f[i + 2]
    local ax, ay, az = p[a + 1], p[a + 2], p[a + 3]
    local ux, uy, uz = p[b + 1] - ax, p[b + 2] - ay, p[b + 3] - az
    local vx, vy, vz = p[c + 1] - ax, p[c + 2] - ay, p[c + 3] - az
    local nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    n[a + 1], n[a + 2], n[a + 3] = n[a + 1] + nx, n[a + 2] + ny, n[a + 3] + nz
    n[b + 1], n[b + 2], n[b + 3] = n[b + 1] + nx, n[b + 2] + ny, n[b + 3] + nz
    n[c + 1], n[c + 2], n[c + 3] = n[c + 1] + nx, n[c + 2] + ny, n[c + 3] + nz
  end
  return self
end

--- Leaves out normals and texture coordinates: broken faces, as of stone, with pictures laid on flat once a unit.
--- `split` and what reads `normals` still see those that `smooth` made.
function Mesh:facets()
  self.broken = true
  return self
end

local function node_of(mesh, name, faces)
  return gr.mesh {
    name = name, positions = mesh.positions, faces = faces,
    normals = not mesh.broken and mesh.normals or nil, uvs = not mesh.broken and mesh.uvs or nil,
  }
end

--- A node with this mesh, of one material. More nodes of the same mesh share it: it has to be finished by then.
function Mesh:node(name, material)
  local node
  if self.first then
    node = gr.mesh { name = name, same_as = self.first }
  else
    node = node_of(self, name, self.faces)
    self.first = node
  end
  node:set_material(material)
  return node
end

--- Nodes that share the vertices, each with the faces for which `choose(nx, ny, nz, x, y, z)` (unit normal and middle
--- of the face) returned its key in `materials`.
function Mesh:split(name, materials, choose, parent)
  local p, f = self.positions, self.faces
  local parts = {}
  for key in pairs(materials) do parts[key] = {} end
  for i = 1, #f, 3 do
    local a, b, c = 3 * f[i], 3 * f[i + 1], 3 * f[i + 2]
    local ax, ay, az = p[a + 1], p[a + 2], p[a + 3]
    local ux, uy, uz = p[b + 1] - ax, p[b + 2] - ay, p[b + 3] - az
    local vx, vy, vz = p[c + 1] - ax, p[c + 2] - ay, p[c + 3] - az
    local nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    local size = math.sqrt(nx * nx + ny * ny + nz * nz) + 1e-12
    local part = parts[choose(nx / size, ny / size, nz / size,
      ax + (ux + vx) / 3, ay + (uy + vy) / 3, az + (uz + vz) / 3)]
    local k = #part
    part[k + 1], part[k + 2], part[k + 3] = f[i], f[i + 1], f[i + 2]
  end
  for key, material in pairs(materials) do
    if #parts[key] > 0 then
      local node = node_of(self, name .. '-' .. key, parts[key])
      node:set_material(material)
      parent:add_child(node)
    end
  end
end

return Mesh
