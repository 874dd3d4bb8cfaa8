// What intersection returns.

const MISS: f32 = -1.0;

// Nearest hit of one shape: t in (0, t_max) along the ray, or MISS; the face says which part was met (side, cap).
struct ShapeHit {
    t: f32,
    face: u32,
};

// Nearest hit of the scene; t is MISS where there is none. `primitive` is the triangle's index in `triangles` for a
// mesh, the face for other shapes; b1 and b2 weigh the triangle's second and third corner.
struct Hit {
    t: f32,
    instance: u32,
    primitive: u32,
    b1: f32,
    b2: f32,
};

// The surface at a hit, in world space.
struct Surface {
    point: vec3<f32>,
    // Unit normals on the side that the ray came from; the shading normal is interpolated on smooth meshes.
    geometric_normal: vec3<f32>,
    shading_normal: vec3<f32>,
    // The ray met the outer side.
    entering: bool,
    material: u32,
    // The material's diffuse colour, or the texture's.
    diffuse: vec3<f32>,
};

// Texture coordinates of a point and the change of the point with each, in the space of the point.
struct Parameterisation {
    uv: vec2<f32>,
    dpdu: vec3<f32>,
    dpdv: vec3<f32>,
};
