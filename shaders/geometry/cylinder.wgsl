// The closed cylinder x^2 + z^2 <= 1 for y in [-1, 1]. It is convex: a ray is inside both the infinite cylinder and
// the slab between the caps for one interval.

const CYLINDER_SIDE: u32 = 0u;
const CYLINDER_TOP: u32 = 1u;
const CYLINDER_BOTTOM: u32 = 2u;

fn cylinder_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> ShapeHit {
    let o = origin;
    let d = direction;
    let a = d.x * d.x + d.z * d.z;
    let b = -(o.x * d.x + o.z * d.z);
    // In this order, which shader compilers keep: they bring constants next to products.
    let c = o.x * o.x + (o.z * o.z - 1.0);
    let moment = o.z * d.x - o.x * d.z;
    let discriminant = a - moment * moment;
    // Parallel to the axis to 1e-12: inside the infinite cylinder all the way, or never.
    let least = 1.0e-24 * (d.y * d.y);
    let parallel = a <= least;
    let roots = quadratic_roots(max(a, least), b, c, discriminant);
    let side_near = select(roots.x, -FAR, parallel);
    let side_far = select(roots.y, FAR, parallel);
    let meets = c <= 0.0 || (discriminant >= 0.0 && !parallel);

    let inverse_y = safe_reciprocal(d.y);
    let bottom = (-1.0 - o.y) * inverse_y;
    let top = (1.0 - o.y) * inverse_y;
    let cap_near = min(bottom, top);
    let cap_far = max(bottom, top);

    let near = max(side_near, cap_near);
    let far = min(side_far, cap_far);
    let outside = near > 0.0;
    let t = select(far, near, outside);
    let hit = meets && near <= far && t > 0.0 && t < t_max;
    let on_side = select(side_far <= cap_far, side_near >= cap_near, outside);
    let cap = select(CYLINDER_BOTTOM, CYLINDER_TOP, (inverse_y > 0.0) != outside);
    return ShapeHit(select(MISS, t, hit), select(cap, CYLINDER_SIDE, on_side));
}

fn cylinder_project(point: vec3<f32>, face: u32) -> vec3<f32> {
    let rho = sqrt(point.x * point.x + point.z * point.z);
    let on_side = face == CYLINDER_SIDE;
    // On a cap the distance from the axis stays, unless it passes the rim.
    let scale = 1.0 / select(max(rho, 1.0), rho, on_side);
    let cap_y = select(-1.0, 1.0, face == CYLINDER_TOP);
    return vec3<f32>(point.x * scale, select(cap_y, clamp(point.y, -1.0, 1.0), on_side), point.z * scale);
}

fn cylinder_normal(point: vec3<f32>, face: u32) -> vec3<f32> {
    let scale = 1.0 / sqrt(point.x * point.x + point.z * point.z);
    let side = vec3<f32>(point.x * scale, 0.0, point.z * scale);
    let cap = vec3<f32>(0.0, select(-1.0, 1.0, face == CYLINDER_TOP), 0.0);
    return select(cap, side, face == CYLINDER_SIDE);
}

// Around the axis to the right and along it downwards; the caps by x and z.
fn cylinder_parameterise(point: vec3<f32>, face: u32, around: Revolution) -> Parameterisation {
    if face != CYLINDER_SIDE {
        return cap_parameterise(point, select(-1.0, 1.0, face == CYLINDER_TOP));
    }
    let v = 0.5 - point.y * 0.5;
    return Parameterisation(vec2<f32>(around.u, v), around.dpdu, vec3<f32>(0.0, -2.0, 0.0));
}
