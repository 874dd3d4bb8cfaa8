-- Depth of field: a long row of pawns, focused on the third.
-- Look for: sharp edges at the gold pawn alone; discs of blur that grow towards the eye and away from it, square as
-- the lens is; highlights and mirror images that blur with what they show and not with the mirror.
-- 480x270, 36 camera samples a pixel: under ten seconds on two CPU cores.

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

-- A board of two colours: a dark plane, light tiles just above it.
put(scene, gr.plane('dark squares'), gr.refl_material({ 0.24, 0.14, 0.09 }, { 0, 0, 0 }, 1, 0.10))
local tile = gr.cube('light square')
tile:set_material(gr.refl_material({ 0.82, 0.72, 0.54 }, { 0, 0, 0 }, 1, 0.10))
tile:scale(1, 0.004, 1)
for row = -40, 5 do
  for column = -16, 12 do
    if (row + column) % 2 == 0 then
      local place = gr.node('place')
      place:add_child(tile)
      place:translate(column, 0, row)
      scene:add_child(place)
    end
  end
end

local function pawn(material)
  local root = gr.node('pawn')
  local foot = put(root, gr.cylinder('foot'), material)
  foot:scale(0.36, 0.06, 0.36)
  foot:translate(0, 0.06, 0)
  local bulge = put(root, gr.sphere('bulge'), material)
  bulge:scale(0.31, 0.18, 0.31)
  bulge:translate(0, 0.16, 0)
  local body = put(root, gr.cone('body'), material)
  body:scale(0.27, 1.1, 0.27)
  body:translate(0, 1.22, 0)
  local collar = put(root, gr.torus('collar', 0.15, 0.05), material)
  collar:translate(0, 0.78, 0)
  local head = put(root, gr.sphere('head'), material)
  head:scale(0.21, 0.21, 0.21)
  head:translate(0, 0.97, 0)
  return root
end

local ivory = pawn(gr.refl_material({ 0.78, 0.72, 0.60 }, { 0.7, 0.7, 0.7 }, 90, 0.10))
local ebony = pawn(gr.refl_material({ 0.10, 0.08, 0.08 }, { 0.8, 0.8, 0.8 }, 90, 0.16))
local gold = pawn(gr.refl_material({ 0.66, 0.42, 0.08 }, { 0.9, 0.75, 0.4 }, 60, 0.35))

local focus = 3
for i = 1, 9 do
  local place = gr.node('place')
  place:add_child(i == focus and gold or i % 2 == 0 and ebony or ivory)
  place:scale(1.15, 1.15, 1.15)
  place:translate(-1.5 + 0.5 * (i - 1), 0, 2.5 - (i - 1) * 1.5)
  scene:add_child(place)
end
-- A second row in the other direction, all out of focus but where it crosses the plane of the gold pawn.
for i = 1, 4 do
  local place = gr.node('place')
  place:add_child(i % 2 == 0 and ivory or ebony)
  place:scale(1.15, 1.15, 1.15)
  place:translate(-3.5, 0, -0.5 - 2.0 * (i - 1))
  scene:add_child(place)
end

local key = gr.light({ -4, 8, 5 }, { 0.88, 0.84, 0.76 }, { 1, 0, 0 })
local fill = gr.light({ 6, 5, 4 }, { 0.22, 0.25, 0.32 }, { 1, 0, 0 })

gr.render(scene, 'depth-of-field.png', 480, 270,
  { 1.6, 2.3, 6.2 }, { -0.5, 0.65, -0.5 }, { 0, 1, 0 }, 34, -- the focal plane goes through the gold pawn
  { 0.26, 0.26, 0.29 }, { key, fill },
  2, 1, 2, 9, 0.35) -- AA, GLOSSY, SHADOW, DOF, LENS
