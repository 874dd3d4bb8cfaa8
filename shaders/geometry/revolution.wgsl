// What the surfaces of revolution about the y axis share of their texture coordinates.

// Tangents along u are not shorter than at this distance from the axis, where they would vanish.
const LEAST_REVOLUTION: f32 = 1.0e-6;

struct Revolution {
    // 1/2 at +x, growing to the right as seen from outside with +y up; the seam is at -x.
    u: f32,
    // Distance from the axis, and the unit direction away from it (+x on the axis).
    rho: f32,
    radial: vec3<f32>,
    dpdu: vec3<f32>,
};

fn revolution(point: vec3<f32>) -> Revolution {
    let rho = sqrt(point.x * point.x + point.z * point.z);
    let on_axis = rho <= TINY;
    let inverse = 1.0 / max(rho, TINY);
    let radial = vec3<f32>(select(point.x * inverse, 1.0, on_axis), 0.0, select(point.z * inverse, 0.0, on_axis));
    // 1/(2 pi) and 2 pi.
    let u = 0.5 - atan2_poly(point.z, point.x) * 0.15915494;
    let speed = max(rho, LEAST_REVOLUTION) * 6.2831855;
    return Revolution(u, rho, radial, vec3<f32>(radial.z * speed, 0.0, -(radial.x * speed)));
}

// The disc that closes a cylinder or cone: the image's inscribed circle, upright as seen from outside with -z up on
// the upper side, +z on the lower.
fn cap_parameterise(point: vec3<f32>, side: f32) -> Parameterisation {
    let uv = vec2<f32>(point.x * 0.5 + 0.5, (point.z * side) * 0.5 + 0.5);
    return Parameterisation(uv, vec3<f32>(2.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 2.0 * side));
}
