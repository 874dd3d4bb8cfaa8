-- Bump maps: the same shapes in the same colours, smooth (left) and bumped (right), each bump from a picture's brightness.
-- Look for: a block of clay that becomes a wall, whose mortar lies deeper than the bricks; a post that becomes a trunk
-- with furrows; the golf ball's dimples, lit from the same side as the ball; the hammered ring, whose mirror image the
-- bumps break up. Outlines stay those of the smooth shape.
-- 640x360, 9 camera samples a pixel: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

put(scene, gr.plane('ground'), gr.material({ 0.58, 0.62, 0.58 }, { 0, 0, 0 }, 1))

-- A wall behind it all.
local back = put(scene, gr.plane('back'), gr.material({ 0.46, 0.52, 0.58 }, { 0, 0, 0 }, 1))
back:rotate('x', 90)
back:translate(0, 0, -3)

local weak, strong = { 0.08, 0.08, 0.08 }, { 0.5, 0.5, 0.5 }
local white, brass = { 0.84, 0.84, 0.82 }, { 0.52, 0.36, 0.10 }

-- The materials of one half, the same colours twice: KD, KS, p, REFL; and FILE, KD, KS, p, REFL, AREA, IOR, POS, where
-- POS 2 takes the colour from KD and only the heights from the file.
local clay, wood, shine = { 0.66, 0.31, 0.22 }, { 0.47, 0.36, 0.27 }, { 0.8, 0.7, 0.4 }
local smooth = {
  brick = gr.material(clay, weak, 10),
  bark = gr.material(wood, weak, 10),
  ball = gr.material(white, strong, 60),
  ring = gr.refl_material(brass, shine, 50, 0.2),
}
local bumped = {
  brick = gr.bump_material('assets/brick-relief.png', clay, weak, 10, 0, 0, -1, 2),
  bark = gr.bump_material('assets/bark-relief.png', wood, weak, 10, 0, 0, -1, 2),
  ball = gr.bump_material('assets/dimples.png', white, strong, 60, 0, 0, -1, 2),
  ring = gr.bump_material('assets/dimples.png', brass, shine, 50, 0.2, 0, -1, 2),
}

local function half(kind, x)
  local root = gr.node('half')
  local wall = put(root, gr.cube('wall'), kind.brick)
  wall:translate(-0.5, 0, -0.5)
  wall:scale(1.7, 1.7, 0.5)
  wall:translate(-0.6, 0, -1.0)
  local trunk = put(root, gr.cylinder('trunk'), kind.bark)
  trunk:scale(0.42, 1.15, 0.42)
  trunk:rotate('y', 60)
  trunk:translate(0.95, 1.15, -0.75)
  local ball = put(root, gr.sphere('ball'), kind.ball)
  ball:scale(0.62, 0.62, 0.62)
  ball:rotate('x', 18)
  ball:translate(-0.72, 0.62, 0.75)
  local ring = put(root, gr.torus('ring', 0.46, 0.2), kind.ring)
  ring:rotate('x', 66)
  ring:rotate('y', -16)
  ring:translate(0.66, 0.58, 0.85)
  root:translate(x, 0, 0)
  scene:add_child(root)
end
half(smooth, -1.85)
half(bumped, 1.85)

local key = gr.light({ -9, 6, 7 }, { 0.92, 0.88, 0.80 }, { 1, 0, 0 })

gr.render(scene, 'bump.png', 640, 360,
  { 0, 2.3, 8.0 }, { 0, 0.98, 0 }, { 0, 1, 0 }, 30,
  { 0.28, 0.29, 0.33 }, { key },
  3) -- AA
