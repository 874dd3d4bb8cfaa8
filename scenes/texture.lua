-- Pictures on every shape, in a small garden under a sky that is a picture too.
-- Look for: the globe (sphere), the tree trunk and the tent's wall (cylinders), its roof (cone), the swimming ring
-- (torus), the brick pillars (cubes), the lawn (plane, repeated), and the clipped box hedge in the form of a bunny
-- (mesh without texture coordinates of its own). The stripes meet at the seams, and the lawn doesn't sparkle
-- far off, where many blades fall into one pixel.
-- 640x360, 9 camera samples a pixel: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

local function textured(name, shininess)
  return gr.texture_material('assets/' .. name .. '.png', { 0.05, 0.05, 0.05 }, shininess or 10)
end
local stripes, brick, bark = textured('stripes', 30), textured('brick'), textured('bark')

-- One repeat of the lawn is 2.5 wide.
put(scene, gr.plane('lawn'), textured('grass')):scale(2.5, 1, 2.5)

-- A round tent. The cone's apex is at the origin and its base at y = -1.
local tent = gr.node('tent')
local wall = put(tent, gr.cylinder('wall'), stripes)
wall:scale(1.15, 0.55, 1.15)
wall:translate(0, 0.55, 0)
local roof = put(tent, gr.cone('roof'), stripes)
roof:scale(1.45, 0.95, 1.45)
roof:translate(0, 1.95, 0)
put(tent, gr.nh_sphere('knob', { 0, 1.98, 0 }, 0.09), gr.material({ 0.80, 0.60, 0.20 }, { 0.5, 0.5, 0.5 }, 50))
tent:rotate('y', 10)
tent:translate(-2.75, 0, -1.6)
scene:add_child(tent)

-- A tree: its crown is a heap of balls that share one picture.
local tree = gr.node('tree')
local trunk = put(tree, gr.cylinder('trunk'), bark)
trunk:scale(0.27, 1.0, 0.27)
trunk:translate(0, 1.0, 0)
local crown = gr.sphere('crown')
crown:set_material(textured('leaves'))
for i, ball in ipairs {
  { 0, 2.6, 0, 0.85 }, { 0.62, 2.3, 0.25, 0.6 }, { -0.62, 2.35, 0.2, 0.6 }, { 0.1, 2.25, 0.6, 0.55 }, { 0, 2.3, -0.6, 0.6 },
} do
  local x, y, z, radius = table.unpack(ball)
  local place = gr.node('place')
  place:add_child(crown)
  place:scale(radius, radius, radius)
  place:rotate('y', 67 * i)
  place:translate(x, y, z)
  tree:add_child(place)
end
tree:translate(3.05, 0, -1.7)
scene:add_child(tree)

-- Two brick pillars with a stone on top; the globe stands on one, the bunny on the other.
local stone = gr.material({ 0.70, 0.68, 0.63 }, { 0.1, 0.1, 0.1 }, 10)
local function pillar(x, z, turn)
  local root = gr.node('pillar')
  local body = put(root, gr.cube('body'), brick)
  body:translate(-0.5, 0, -0.5)
  body:scale(0.8, 0.8, 0.8)
  local top = put(root, gr.cube('top'), stone)
  top:translate(-0.5, 0, -0.5)
  top:scale(0.96, 0.1, 0.96)
  top:translate(0, 0.8, 0)
  root:rotate('y', turn)
  root:translate(x, 0, z)
  scene:add_child(root)
end
pillar(-0.75, 0.2, 24)
pillar(1.25, 0.1, -28)

local globe = put(scene, gr.sphere('globe'), gr.texture_material('assets/earth.png', { 0.3, 0.3, 0.3 }, 40))
globe:scale(0.62, 0.62, 0.62)
globe:rotate('y', 130)
globe:rotate('z', -23)
globe:translate(-0.75, 1.56, 0.2)

local bunny = put(scene, gr.mesh('bunny', 'assets/bunny.obj'), textured('grass'))
bunny:scale(1.1, 1.1, 1.1)
bunny:rotate('y', -10)
bunny:translate(1.2, 0.9, 0.1)

local ring = put(scene, gr.torus('ring', 0.5, 0.19), stripes)
ring:rotate('x', 66)
ring:rotate('y', 20)
ring:translate(0.32, 0.6, 1.5)

local post = put(scene, gr.cube('box'), textured('floor'))
post:scale(1.0, 0.42, 0.55)
post:rotate('y', 28)
post:translate(-2.6, 0, 1.25)

gr.background { image = 'assets/sky.png' }
local sun = gr.light({ -25, 32, 30 }, { 0.95, 0.92, 0.84 }, { 1, 0, 0 })

gr.render(scene, 'texture.png', 640, 360,
  { 0.1, 2.0, 7.4 }, { 0.1, 1.15, 0 }, { 0, 1, 0 }, 31,
  { 0.42, 0.44, 0.48 }, { sun },
  3) -- AA
