--- What people left at the water: swimming rings, a jetty with a lantern.

local shape = require('lib.shape')
local between = shape.between

local props = {}

local function put(parent, node, material)
  node:set_material(material)
  parent:add_child(node)
  return node
end

--- A swimming ring with painted stripes and a valve, lying in y = 0.
function props.ring(cloth, valve)
  local ring = gr.node('ring')
  put(ring, gr.torus('tube', 0.60, 0.235), cloth)
  local stub = put(ring, gr.cylinder('valve'), valve)
  stub:scale(0.025, 0.035, 0.025)
  stub:translate(0.47, 0.215, 0)
  return ring
end

--- A swimming ring that is a doughnut: dough, icing whose rim runs in drops, and sprinkles, which are cylinders with
--- round ends.
function props.donut()
  local R, r = 0.60, 0.26
  local donut = gr.node('donut')
  put(donut, gr.torus('dough', R, r), gr.material { diffuse = { 0.62, 0.33, 0.11 },
    specular = { 0.15, 0.15, 0.15 }, shininess = 20 })
  local icing = gr.material { diffuse = { 0.80, 0.22, 0.36 }, specular = { 0.5, 0.5, 0.5 }, shininess = 60 }
  local cap = put(donut, gr.torus('icing', R, r), icing)
  cap:scale(1.008, 0.90, 1.008)
  cap:translate(0, 0.075, 0)
  for i = 1, 26 do
    local azimuth = 360 * i / 26 + between(-4, 4)
    local outside = i % 2 == 0
    local lobe = put(donut, gr.sphere('drop'), icing)
    lobe:scale(0.055, between(0.06, 0.13), 0.075)
    lobe:rotate('z', outside and 8 or -8)
    lobe:translate(outside and R + 0.968 * r or R - 0.968 * r, between(0.04, 0.09), 0)
    lobe:rotate('y', azimuth)
  end
  local colours = { { 0.95, 0.85, 0.15 }, { 0.15, 0.45, 0.85 }, { 0.95, 0.95, 0.90 }, { 0.25, 0.70, 0.25 },
    { 0.95, 0.45, 0.10 } }
  local sprinkles = {}
  for k, colour in ipairs(colours) do
    local sprinkle = gr.node('sprinkle')
    local m = gr.material { diffuse = colour, specular = { 0.3, 0.3, 0.3 }, shininess = 40 }
    put(sprinkle, gr.cylinder('middle'), m):scale(0.014, 0.045, 0.014)
    for _, y in ipairs { -0.045, 0.045 } do
      put(sprinkle, gr.nh_sphere('end', { 0, y, 0 }, 0.014), m)
    end
    sprinkle:rotate('z', 90)
    sprinkles[k] = sprinkle
  end
  for i = 1, 130 do
    local tilt = between(-62, 62)
    local at = gr.node('at')
    at:add_child(sprinkles[1 + i % #sprinkles])
    at:rotate('y', between(0, 360))
    at:translate(0, r + 0.030, 0)
    at:rotate('z', tilt)
    at:translate(R, 0.015, 0)
    at:rotate('y', between(0, 360))
    donut:add_child(at)
  end
  return donut
end

--- A jetty of `count` planks along -z from the origin, on posts, with its deck at y = 0; a lantern on its last post.
function props.jetty(count, tones, post, metal, glow)
  local jetty = gr.node('jetty')
  for i = 0, count - 1 do
    local plank = put(jetty, gr.cube('plank'), tones[1 + i * 7 % #tones])
    plank:translate(-0.5, -1, -0.5)
    plank:scale(1.5 + between(-0.06, 0.06), 0.06, 0.205)
    plank:rotate('y', between(-1.5, 1.5))
    plank:translate(between(-0.03, 0.03), between(-0.008, 0.008), -0.22 * i)
  end
  for _, x in ipairs { -0.55, 0.55 } do
    local beam = put(jetty, gr.cube('beam'), post)
    beam:translate(-0.5, -1, -1)
    beam:scale(0.11, 0.14, 0.22 * count)
    beam:translate(x, -0.06, 0.1)
  end
  for i = 0, count - 1, 5 do
    for _, x in ipairs { -0.72, 0.72 } do
      local tall = (i == 0 or i + 5 >= count) and 0.75 or 0.16
      local pile = put(jetty, gr.cylinder('pile'), post)
      pile:scale(0.085, 1.4 + tall / 2, 0.085)
      pile:rotate('z', between(-2, 2))
      pile:translate(x, tall / 2 - 1.4, -0.22 * i)
      local tip = put(jetty, gr.cone('tip'), post)
      tip:scale(0.10, 0.09, 0.10)
      tip:translate(x, tall + 0.085, -0.22 * i)
    end
  end
  -- Put down a little askew.
  local lantern = gr.joint('lantern', { 0, 0, 0 }, { -180, 28, 180 })
  for k = 0, 3 do
    local bar = put(lantern, gr.cylinder('bar'), metal)
    bar:scale(0.008, 0.12, 0.008)
    bar:translate(k % 2 == 0 and 0.075 or -0.075, 0.14, k < 2 and 0.075 or -0.075)
  end
  local foot = put(lantern, gr.cube('foot'), metal)
  foot:translate(-0.5, 0, -0.5)
  foot:scale(0.2, 0.025, 0.2)
  local roof = put(lantern, gr.cone('roof'), metal)
  roof:scale(0.15, 0.11, 0.15)
  roof:translate(0, 0.37, 0)
  put(lantern, gr.nh_sphere('flame', { 0, 0.13, 0 }, 0.055), glow)
  local handle = put(lantern, gr.torus('handle', 0.05, 0.008), metal)
  handle:rotate('x', 90)
  handle:translate(0, 0.40, 0)
  lantern:translate(-0.38, 0, -0.22 * (count - 2))
  jetty:add_child(lantern)
  return jetty
end

return props
