// The infinite plane y = 0, with normal +y on both sides.

fn plane_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> ShapeHit {
    let t = -origin.y * safe_reciprocal(direction.y);
    let hit = direction.y != 0.0 && t > 0.0 && t < t_max;
    return ShapeHit(select(MISS, t, hit), 0u);
}

fn plane_project(point: vec3<f32>, face: u32) -> vec3<f32> {
    return vec3<f32>(point.x, 0.0, point.z);
}

fn plane_normal(point: vec3<f32>, face: u32) -> vec3<f32> {
    return vec3<f32>(0.0, 1.0, 0.0);
}

// One image a unit square, upright as seen from above with -z up.
fn plane_parameterise(point: vec3<f32>, face: u32) -> Parameterisation {
    return Parameterisation(point.xz, vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0));
}
