-- A desk lamp takes a hop, in five poses: one function of five joint angles.
-- Each part is made once and stands in all five lamps (instances); the bulb hangs from the shade, which is itself a
-- shape. Look for the pools of light: each lamp carries a light where its joints have brought the bulb.
-- 640x360, 9 camera samples a pixel, 6 lights: under ten seconds on two CPU cores.

local paint = gr.material({ 0.80, 0.30, 0.16 }, { 0.5, 0.5, 0.5 }, 60)
local steel = gr.refl_material({ 0.30, 0.31, 0.33 }, { 0.7, 0.7, 0.7 }, 90, 0.35)
local glow = gr.material({ 5, 4.5, 3.4 }, { 0, 0, 0 }, 1)

local function part(shape, material)
  shape:set_material(material)
  return shape
end

local lower, upper = 1.15, 1.0 -- lengths of the two arms

-- The shared parts. Each stands at the origin of its joint.
local foot = part(gr.cylinder('foot'), paint)
foot:scale(0.46, 0.06, 0.46)
foot:translate(0, 0.06, 0)

local rod = part(gr.cylinder('rod'), steel)
rod:scale(0.045, 0.5, 0.045)
rod:translate(0, 0.5, 0)

local knuckle = part(gr.sphere('knuckle'), paint)
knuckle:scale(0.1, 0.1, 0.1)

-- The shade opens along -y. Its children live in its own, unscaled shape: the scale is on a node above.
local shade = part(gr.cone('shade'), paint)
local bulb = part(gr.sphere('bulb'), glow)
bulb:scale(0.5, 0.4, 0.5)
bulb:translate(0, -1, 0)
shade:add_child(bulb)
local rim = part(gr.torus('rim', 1, 0.06), steel)
rim:translate(0, -1, 0)
shade:add_child(rim)

local function bend(name, degrees)
  return gr.joint(name, { -150, degrees, 150 }, { 0, 0, 0 })
end

-- A lamp that leans by `shoulder`, `elbow` and `neck` degrees, each from the arm before it, towards +x.
-- Returns the lamp and the place just under its bulb.
local function lamp(x, lift, shoulder, elbow, neck)
  local root = gr.node('lamp')
  root:add_child(foot)

  local shoulder_joint = bend('shoulder', shoulder)
  shoulder_joint:translate(0, 0.14, 0)
  root:add_child(shoulder_joint)
  local lower_arm = gr.node('lower arm')
  lower_arm:add_child(rod)
  lower_arm:scale(1, lower, 1)
  shoulder_joint:add_child(lower_arm)
  shoulder_joint:add_child(knuckle)

  local elbow_joint = bend('elbow', elbow)
  elbow_joint:translate(0, lower, 0)
  shoulder_joint:add_child(elbow_joint)
  local upper_arm = gr.node('upper arm')
  upper_arm:add_child(rod)
  upper_arm:scale(1, upper, 1)
  elbow_joint:add_child(upper_arm)
  elbow_joint:add_child(knuckle)

  local neck_joint = bend('neck', neck)
  neck_joint:translate(0, upper, 0)
  elbow_joint:add_child(neck_joint)
  local head = gr.node('head')
  head:add_child(shade)
  head:scale(0.36, 0.5, 0.36)
  head:rotate('x', 180)
  head:translate(0, -0.12, 0)
  neck_joint:add_child(head)

  root:rotate('y', 90) -- joints turn about x, from y to z; now they lean along +x
  root:translate(x, lift, 0)

  local function along(angle, length)
    local a = math.rad(angle)
    return length * math.sin(a), length * math.cos(a)
  end
  local x1, y1 = along(shoulder, lower)
  local x2, y2 = along(shoulder + elbow, upper)
  local x3, y3 = along(shoulder + elbow + neck, 0.62)
  return root, { x + x1 + x2 + x3, lift + 0.14 + y1 + y2 + y3, 0 }
end

local scene = gr.node('scene')
scene:add_child(part(gr.plane('table'), gr.refl_material({ 0.58, 0.50, 0.42 }, { 0, 0, 0 }, 1, 0.10)))

local wall = part(gr.plane('wall'), gr.material({ 0.42, 0.46, 0.52 }, { 0, 0, 0 }, 1))
wall:rotate('x', 90)
wall:translate(0, 0, -3.2)
scene:add_child(wall)

local lights = { gr.light({ -6, 9, 10 }, { 0.38, 0.40, 0.46 }, { 1, 0, 0 }) }
local poses = { -- x, height of the hop, shoulder, elbow, neck
  { -4.4, 0.00, -20, 75, 85 },
  { -2.7, 0.00, -58, 118, 72 },
  { -0.7, 0.85, -6, 38, 78 },
  { 1.3, 0.35, -22, 82, 66 },
  { 3.1, 0.00, -50, 108, 82 },
}
for _, pose in ipairs(poses) do
  local node, under_bulb = lamp(table.unpack(pose))
  scene:add_child(node)
  table.insert(lights, gr.light(under_bulb, { 1.1, 0.92, 0.62 }, { 0.6, 0, 0.5 }))
end

gr.render(scene, 'hierarchy.png', 640, 360,
  { -0.3, 2.5, 9.8 }, { -0.3, 1.2, 0 }, { 0, 1, 0 }, 30,
  { 0.20, 0.20, 0.23 }, lights,
  3) -- AA
