// The structures that cross from the host: `src/layout.rs` holds their Pod twins, field for field,
// and `tests/layout.rs` checks every size and offset. Nothing else is declared here.

// Everything that is the same for one picture: camera, sampling counts, sizes. World space, right-handed.
struct Frame {
    eye: vec3<f32>,
    // Edge of the square lens in the plane of the eye, world units; 0 is a pinhole.
    lens_edge: f32,
    // Unit camera axes.
    right: vec3<f32>,
    // Half the height of the image plane at distance 1.
    tan_half_fov: f32,
    up: vec3<f32>,
    // Distance from the eye to the plane that is in focus, world units.
    focus_distance: f32,
    forward: vec3<f32>,
    // Width over height of the picture.
    aspect: f32,
    ambient: vec3<f32>,
    seed: u32,
    // Linear radiance straight down and straight up.
    background_bottom: vec3<f32>,
    // FRAME_* bits.
    flags: u32,
    background_top: vec3<f32>,
    // A ray of this depth spawns no further rays; camera rays have depth 0.
    max_depth: u32,
    // The media around the eye, see `Medium` in shading/material.wgsl.
    medium: vec2<u32>,
    // Width and height of the whole picture, pixels.
    image_size: vec2<u32>,
    // The first `plane_count` instances are infinite planes, outside the hierarchy.
    plane_count: u32,
    // The surfaces after them; nodes[0] is the root of the hierarchy over these, if there are any.
    bounded_count: u32,
    light_count: u32,
    // Camera samples share this number of passes; each pass takes a slice of the splits at depth 0.
    pass_count: u32,
    // Shadow rays for each light at depth 0, over all passes together.
    shadow_count: u32,
    // Light samples at depth 0 in one pass.
    light_samples: u32,
    // Light samples at each deeper hit.
    deep_light_samples: u32,
    // Glossy reflection rays at depth 0 in one pass.
    glossy_samples: u32,
    // The mists around the eye, see shading/medium.wgsl.
    mist: vec2<u32>,
    // First word of the surrounding picture in `texels`, or NONE for the gradient.
    background_image: u32,
    // Angle between neighbouring camera samples in the middle of the picture, radians.
    pixel_spread: f32,
    // The mists after the surfaces, and the root of the hierarchy over them.
    mist_count: u32,
    mist_root: u32,
    pad0: u32,
    pad1: u32,
};

// What one dispatch renders: one pass of some camera samples over some 8 x 8 pixel blocks of one band.
struct Dispatch {
    // The first camera sample and their number, and the pass.
    sample_index: u32,
    sample_count: u32,
    pass_index: u32,
    // The band of rows that the film buffer holds: first row and number of rows, pixels.
    band_row: u32,
    band_rows: u32,
    // The blocks, by their places in the order of `block_at` in blocks.wgsl; the stride from tile to tile is coprime to
    // the number of tiles.
    first_block: u32,
    block_count: u32,
    tile_stride: u32,
    // Processors that take contiguous portions of the workgroups, see `place_of` in blocks.wgsl; at least 1.
    portions: u32,
    // Whether subgroups take pixels as they come, where the device has them: 1 or 0, see memory/shared/work.wgsl.
    takes_work: u32,
    // Turns of the loop that every invocation ends with; fewer made means that the driver cut loops short.
    canary_turns: u32,
};

// One node of the compressed wide hierarchy, eight children in 80 bytes (Ylitie, Karras, Laine 2017, section 3) and 16
// more, so that nodes begin at multiples of 32 bytes, which memory/pairs loads at once. Inner children come first, then
// instances of meshes, then all other leaves: src/flatten/bvh.rs puts them so.
struct Node {
    // Minimum corner of the quantisation grid (bits of f32); three exponent bytes (x lowest), then the number
    // of inner children in the low half of a byte and that of children that are instances of meshes in the high half.
    grid: vec4<u32>,
    // First inner child, first primitive; then a byte a child: number of primitives in unary (three bits) and the
    // place of the first among the node's (five bits) for a leaf; 0 for an inner child and for none.
    children: vec4<u32>,
    // Bounds of the children along an axis, a byte each in units of the grid: minima of 0 to 3, minima of 4 to 7, maxima
    // of 0 to 3, maxima of 4 to 7.
    x: vec4<u32>,
    y: vec4<u32>,
    z: vec4<u32>,
    unused: vec4<u32>,
};

// A shape placed in the world. Affine maps are three rows of (linear part, translation).
struct Instance {
    object_from_world: mat3x4<f32>,
    // SHAPE_*.
    shape: u32,
    material: u32,
    // Root of the mesh's own hierarchy in `nodes`.
    root: u32,
    flags: u32,
    world_from_object: mat3x4<f32>,
    // Torus: (R, r, 0, 0). Mesh: offset and extent of its texture coordinates.
    parameters: vec4<f32>,
};

// Three corners in object space with normals (octahedral, two 16-bit snorms) and texture coordinates (two 16-bit
// unorms inside the rectangle of the instance).
struct Triangle {
    p0: vec3<f32>,
    n0: u32,
    p1: vec3<f32>,
    n1: u32,
    p2: vec3<f32>,
    n2: u32,
    uv0: u32,
    uv1: u32,
    uv2: u32,
    // TRIANGLE_* bits.
    flags: u32,
};

// Whitted's material with Cook's glossy square and a refractive index; colours are linear reflectances.
struct Material {
    diffuse: vec3<f32>,
    // Phong exponent.
    shininess: f32,
    specular: vec3<f32>,
    // Scale of the reflected light; 0 is not reflective.
    reflection: f32,
    emission: vec3<f32>,
    // Edge of the square that spreads reflected directions; 0 is a mirror.
    glossy: f32,
    // Refractive index; 0 is opaque.
    ior: f32,
    // Mist: scattering events a world unit; 0 is a surface.
    density: f32,
    // Third coordinate of the Perlin bump.
    noise_z: f32,
    // MATERIAL_* bits.
    flags: u32,
    // First word of an image in `texels`, or NONE.
    texture: u32,
    bump: u32,
    // Number of this refractive medium or mist, from 1: the index of this material plus 1; 0 is neither.
    medium: u32,
    // Mist: how far a ray goes on to be past the boundary, world units.
    mist_step: f32,
};

// A point, a parallelogram (centre and edges) or a sphere; attenuation 1 / (c0 + c1 d + c2 d^2), d in world units.
struct Light {
    position: vec3<f32>,
    // LIGHT_*.
    kind: u32,
    colour: vec3<f32>,
    radius: f32,
    falloff: vec3<f32>,
    pad0: u32,
    u: vec3<f32>,
    pad1: u32,
    v: vec3<f32>,
    pad2: u32,
};

// The sum of a pixel's samples: 64-bit two's complement fixed point in units of 2^-20, low and high words of
// (red, green, blue, coverage). Integer sums do not depend on their order, so films merge exactly.
struct FilmPixel {
    low: vec4<u32>,
    high: vec4<u32>,
};

// What the kernel reports: STATUS_* bits, and rays traced, in RAY_KINDS * RAY_SLOTS counters.
struct Status {
    flags: atomic<u32>,
    // How often pixels of the dispatch were taken, see memory/shared/work.wgsl.
    taken: atomic<u32>,
    pad1: u32,
    pad2: u32,
    rays: array<atomic<u32>, 256>,
};

const NONE: u32 = 0xffffffffu;

const FRAME_SAMPLE_CENTRE: u32 = 1u;   // one sample a pixel, in its middle
const FRAME_SAMPLE_CORNER: u32 = 2u;   // samples are spread about the pixel's upper left corner
const FRAME_TRANSPARENT: u32 = 4u;     // camera rays that miss leave the pixel uncovered
const FRAME_BLINN: u32 = 8u;           // specular (n.h)^p in place of (r.v)^p

const SHAPE_SPHERE: u32 = 0u;
const SHAPE_CUBE: u32 = 1u;
const SHAPE_CYLINDER: u32 = 2u;
const SHAPE_CONE: u32 = 3u;
const SHAPE_TORUS: u32 = 4u;
const SHAPE_PLANE: u32 = 5u;
const SHAPE_MESH: u32 = 6u;

const TRIANGLE_SMOOTH: u32 = 1u;       // n0..n2 are given; otherwise the geometric normal is used

const MATERIAL_TEXTURE_REPLACES: u32 = 1u;  // the diffuse colour comes from `texture`
const MATERIAL_NOISE_BUMP: u32 = 2u;        // the bump is Perlin noise at height noise_z, in place of an image
const MATERIAL_MIST: u32 = 4u;              // a volume of `density`, not a surface

// Which rays meet an instance.
const INSTANCE_SEEN: u32 = 1u;              // those of the tree
const INSTANCE_SHADES: u32 = 2u;            // shadow rays
const INSTANCE_MIST: u32 = 4u;              // the search for boundaries of mist, and no others

const LIGHT_POINT: u32 = 0u;
const LIGHT_PARALLELOGRAM: u32 = 1u;
const LIGHT_SPHERE: u32 = 2u;

const STATUS_LOOP_BOUND: u32 = 1u;     // a loop left on its bound: the result is not complete
const STATUS_STACK_FULL: u32 = 2u;     // a stack had no room for an entry
const STATUS_MIST_CROSSINGS: u32 = 16u;  // a ray crossed more boundaries of mist than MIST_CROSSINGS
const STATUS_NOT_FINITE: u32 = 4u;     // a sample was NaN or infinite and was counted as black
const STATUS_SATURATED: u32 = 8u;      // a sample lay outside the film's range of +-2047

const RAY_CAMERA: u32 = 0u;
const RAY_SHADOW: u32 = 1u;
const RAY_REFLECTED: u32 = 2u;
const RAY_REFRACTED: u32 = 3u;
const RAY_KINDS: u32 = 4u;
const RAY_SLOTS: u32 = 64u;
