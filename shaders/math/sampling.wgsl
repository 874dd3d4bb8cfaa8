// Directions and points from uniform numbers.

// Two unit vectors that make a right-handed frame (tangent, bitangent, n) with the unit vector n
// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct Basis {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
};

fn orthonormal_basis(n: vec3<f32>) -> Basis {
    let sign = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    return Basis(
        vec3<f32>(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        vec3<f32>(b, sign + n.y * n.y * a, -n.y),
    );
}

// The direction turned to the side that the unit normal points to, by reflection in the surface.
fn keep_above(direction: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let height = dot(direction, normal);
    return direction - min(2.0 * height, 0.0) * normal;
}

// A direction through the square of edge `edge` that stands at distance 1 across the unit direction r
// (Cook, Porter, Carpenter 1984, section 3). Unit length.
fn sample_glossy(r: vec3<f32>, edge: f32, xi: vec2<f32>) -> vec3<f32> {
    let basis = orthonormal_basis(r);
    return unit_vector(r + edge * (xi.x - 0.5) * basis.tangent + edge * (xi.y - 0.5) * basis.bitangent);
}

// A direction uniform in the cone about the unit axis whose half angle has 1 - cosine = one_minus_cos
// (pbrt-v4, section A.5.4; 1 - cosine keeps its precision for narrow cones).
fn sample_cone(axis: vec3<f32>, one_minus_cos: f32, xi: vec2<f32>) -> vec3<f32> {
    let h = xi.x * one_minus_cos;
    let sine = sqrt(max(h * (2.0 - h), 0.0));
    let phi = 6.2831855 * xi.y;
    let basis = orthonormal_basis(axis);
    return (1.0 - h) * axis + sine * cos(phi) * basis.tangent + sine * sin(phi) * basis.bitangent;
}
