// The unit sphere about the origin.

fn sphere_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> ShapeHit {
    let o = origin;
    let d = direction;
    let a = d.x * d.x + d.y * d.y + d.z * d.z;
    let b = -(o.x * d.x + o.y * d.y + o.z * d.z);
    let c = (o.x * o.x + o.y * o.y + o.z * o.z) - 1.0;
    // |moment|^2 = |closest approach|^2 a, so the discriminant keeps its digits however far the origin is.
    let mx = o.y * d.z - o.z * d.y;
    let my = o.z * d.x - o.x * d.z;
    let mz = o.x * d.y - o.y * d.x;
    let discriminant = a - (mx * mx + my * my + mz * mz);
    let roots = quadratic_roots(a, b, c, discriminant);
    let t = select(roots.y, roots.x, roots.x > 0.0);
    // From inside there is always a way out, whatever rounding makes of the discriminant.
    let hit = (discriminant >= 0.0 || c < 0.0) && t > 0.0 && t < t_max;
    return ShapeHit(select(MISS, t, hit), 0u);
}

fn sphere_project(point: vec3<f32>, face: u32) -> vec3<f32> {
    return sphere_normal(point, face);
}

fn sphere_normal(point: vec3<f32>, face: u32) -> vec3<f32> {
    return point / sqrt(point.x * point.x + point.y * point.y + point.z * point.z);
}

// Longitude to the right and latitude downwards; the seam is at -x.
fn sphere_parameterise(point: vec3<f32>, face: u32, around: Revolution) -> Parameterisation {
    // The latitude is asin(y), in the form that keeps its digits near the poles. 1/pi and pi.
    let v = 0.5 - atan2_poly(point.y, around.rho) * 0.31830987;
    let rise = point.y * 3.1415927;
    let dpdv = vec3<f32>(around.radial.x * rise, around.rho * -3.1415927, around.radial.z * rise);
    return Parameterisation(vec2<f32>(around.u, v), around.dpdu, dpdv);
}
