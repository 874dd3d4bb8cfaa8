// A ray of the tree.

const T_INFINITY: f32 = 3.0e38;

struct Ray {
    origin: vec3<f32>,
    // Where it is as to mist: the point of the surface that it leaves, without the offset, which might skip a boundary.
    start: vec3<f32>,
    // Unit.
    direction: vec3<f32>,
    // Share of this ray's radiance in the camera ray's.
    weight: f32,
    // The refractive media and the mists that it is in.
    media: vec2<u32>,
    mists: vec2<u32>,
    // Width of what it stands for at its origin, world units, and how that grows a world unit: a ray cone
    // (Akenine-Möller et al., Ray Tracing Gems ch. 20).
    cone_width: f32,
    cone_spread: f32,
    // Number among the samples that share `key`, and the key of its random decisions.
    index: u32,
    key: u32,
    depth: u32,
};
