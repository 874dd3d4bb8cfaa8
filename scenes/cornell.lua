-- A room after the Cornell box, with everything at once: a square lamp in the ceiling, pictures, bumps, a mirror, glass,
-- gloss, mist and a lens.
-- Look for: the lamp, which is visible, and the soft shadows that it throws; the globe in glass and the wall of brick;
-- the hammered pillar; the rough mirror of the tall box; the cloud of mist; the sky in the window.
-- 400x400, 25 camera samples a pixel, each with 4 shadow and 3 glossy rays: some twenty seconds on two CPU cores.

-- A mesh from a table alone would mean the transform order of old scenes.
gr.conventions { transforms = 'pre' }

local scene = gr.node('scene')

local function put(parent, shape, material)
  shape:set_material(material)
  parent:add_child(shape)
  return shape
end

-- The room is 4 wide, 4 high and 4 deep; its front at z = 2 is open.
local function slab(material, x, y, z, w, h, d)
  local box = put(scene, gr.cube('slab'), material)
  box:scale(w, h, d)
  box:translate(x, y, z)
  return box
end
local plaster = gr.material { diffuse = { 0.74, 0.72, 0.68 } }
slab(gr.material { diffuse = { 0.66, 0.12, 0.10 } }, -2.1, 0, -2, 0.1, 4, 4.2)
slab(gr.material { diffuse = { 0.14, 0.44, 0.14 } }, 2, 0, -2, 0.1, 4, 4.2)
slab(plaster, -2.1, 4, -2.1, 4.2, 0.1, 4.3)

-- The floor: boards, waxed.
local floor = put(scene, gr.plane('floor'), gr.material {
  texture = 'assets/floor.png', specular = { 0.2, 0.2, 0.2 }, shininess = 60, reflection = 0.16, glossy = 0.10,
})
floor:scale(2, 1, 2)
floor:rotate('y', 90)

-- The back wall is of brick, a frame of four faces around the window. A mesh from a table has one image a unit square;
-- this one is drawn at half size and scaled. Faces look at the viewer.
local left, right, bottom, top = 1.3, 1.85, 0.95, 1.65
local wall = put(scene, gr.mesh('wall',
  { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 },
    { left, bottom, 0 }, { right, bottom, 0 }, { right, top, 0 }, { left, top, 0 } },
  { { 0, 1, 5, 4 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 } }),
  gr.material { texture = 'assets/brick.png', bump = 'assets/brick-relief.png' })
wall:scale(2, 2, 2)
wall:translate(-2, 0, -2)
local wood = gr.material { diffuse = { 0.86, 0.82, 0.74 }, specular = { 0.2, 0.2, 0.2 } }
for _, bar in ipairs {
  { 0.52, 1.82, 1.26, 0.09 }, { 0.52, 3.29, 1.26, 0.09 }, { 0.52, 1.9, 0.09, 1.4 }, { 1.69, 1.9, 0.09, 1.4 },
  { 1.12, 1.9, 0.05, 1.4 }, { 0.6, 2.56, 1.1, 0.05 },
} do
  slab(wood, bar[1], bar[2], -2.06, bar[3], bar[4], 0.12)
end

-- The tall box: brushed metal, turned as in the original.
local tall = put(scene, gr.cube('tall'), gr.material {
  diffuse = { 0.10, 0.10, 0.11 }, specular = { 0.4, 0.4, 0.4 }, shininess = 40, reflection = 0.75, glossy = 0.12,
})
tall:translate(-0.5, 0, -0.5)
tall:scale(1.1, 2.1, 1.1)
tall:rotate('y', 20)
tall:translate(-0.85, 0, -0.75)

-- A low box of bark with a glass ball on it.
local low = put(scene, gr.cube('low'), gr.material { texture = 'assets/bark.png', bump = 'assets/bark.png' })
low:translate(-0.5, 0, -0.5)
low:scale(1.05, 0.75, 1.05)
low:rotate('y', -18)
low:translate(0.85, 0, 0.05)
local glass = gr.material {
  diffuse = { 0, 0, 0 }, specular = { 0.7, 0.7, 0.7 }, shininess = 250, reflection = 1, ior = 1.5,
}
put(scene, gr.nh_sphere('ball', { 0.85, 1.27, 0.05 }, 0.52), glass)

-- A globe, a gourd and a golden ring in front.
local globe = put(scene, gr.sphere('globe'), gr.material {
  texture = 'assets/earth.png', specular = { 0.3, 0.3, 0.3 }, shininess = 40,
})
globe:scale(0.42, 0.42, 0.42)
globe:rotate('y', 120)
globe:rotate('z', -23)
globe:translate(-1.15, 0.42, 0.75)
local gourd = put(scene, gr.sphere('gourd'), gr.material {
  diffuse = { 0.95, 0.48, 0.06 }, specular = { 0.3, 0.3, 0.3 }, shininess = 40, noise = 1.5,
})
gourd:scale(0.24, 0.24, 0.24)
gourd:translate(0.1, 0.24, 1.15)
local ring = put(scene, gr.torus('ring', 0.3, 0.11), gr.material {
  diffuse = { 0.56, 0.38, 0.08 }, specular = { 0.9, 0.75, 0.4 }, shininess = 50, reflection = 0.35,
  bump = 'assets/dimples.png',
})
ring:rotate('x', 70)
ring:rotate('y', -24)
ring:translate(1.35, 0.38, 1.15)

-- Mist hangs under the ceiling in a flat cloud.
local cloud = put(scene, gr.sphere('cloud'), gr.material { diffuse = { 0.44, 0.47, 0.55 }, density = 0.9 })
cloud:scale(0.85, 0.34, 0.6)
cloud:translate(-0.75, 2.75, -0.9)

-- The lamp: 1.2 x 1.2, seen by the camera and in mirrors.
local lamp = gr.area_light {
  position = { 0, 3.95, 0 }, u = { 1.2, 0, 0 }, v = { 0, 0, 1.2 }, colour = { 0.95, 0.88, 0.74 },
  falloff = { 0.7, 0, 0.03 }, visible = true,
}
local bulb = gr.sphere_light {
  position = { 0.3, 2.6, 6.5 }, radius = 0.4, colour = { 0.20, 0.22, 0.26 },
}

gr.render {
  scene = scene, output = 'cornell.png', size = { 400, 400 },
  camera = { eye = { 0, 2, 8.6 }, look_at = { 0, 1.95, 0.6 }, fov = 32, lens = 0.1 },
  ambient = { 0.26, 0.26, 0.28 }, lights = { lamp, bulb },
  samples = 25, shadow = 4, glossy = 3,
  background = { image = 'assets/sky.png' },
}
