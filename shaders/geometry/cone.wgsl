// The closed cone x^2 + z^2 <= y^2 for y in [-1, 0]: apex at the origin, cap at y = -1.
//
// With the indefinite product <u, v> = ux vx + uz vz - uy vy the double cone is <p, p> <= 0. Along a ray this is a
// quadratic whose leading coefficient <d, d> is positive where the ray is flatter than the side (it is inside one
// nappe, between the roots), negative where it is steeper (inside both nappes, outside the roots), and vanishes where
// it is parallel to the side. The lower nappe is convex, so that a ray is inside the cone for one interval.

const CONE_SIDE: u32 = 0u;
const CONE_CAP: u32 = 1u;

fn cone_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> ShapeHit {
    let d = direction;
    // <o, o> loses its digits out along the side: start from the closest approach to the apex instead.
    let shift = -(origin.x * d.x + origin.y * d.y + origin.z * d.z) / (d.x * d.x + d.y * d.y + d.z * d.z);
    let o = origin + d * shift;

    // Parallel to the side, the second root is far away, but finite.
    let a0 = (d.x * d.x + d.z * d.z) - d.y * d.y;
    let least = 1.0e-9 * (d.y * d.y);
    let a = select(least, a0, abs(a0) > least);
    let b = o.y * d.y - (o.x * d.x + o.z * d.z);
    let c = (o.x * o.x + o.z * o.z) - o.y * o.y;
    let mx = o.y * d.z - o.z * d.y;
    let my = o.z * d.x - o.x * d.z;
    let mz = o.x * d.y - o.y * d.x;
    let discriminant = (mx * mx + mz * mz) - my * my;
    let roots = quadratic_roots(a, b, c, discriminant);
    let steep = a < 0.0;
    let down = d.y < 0.0;
    let side_near = select(roots.x, select(-FAR, roots.y, down), steep);
    let side_far = select(roots.y, select(roots.x, FAR, down), steep);
    let meets = steep || discriminant >= 0.0 || (c < 0.0 && o.y < 0.0);

    let inverse_y = safe_reciprocal(d.y);
    let apex = -o.y * inverse_y;
    let cap = (-1.0 - o.y) * inverse_y;
    let slab_near = min(apex, cap);
    let slab_far = max(apex, cap);

    let near = max(side_near, slab_near) + shift;
    let far = min(side_far, slab_far) + shift;
    let outside = near > 0.0;
    let t = select(far, near, outside);
    let hit = meets && near <= far && t > 0.0 && t < t_max;
    // The slab's upper plane touches the cone in the apex alone, which counts as side.
    let on_cap = select(slab_far < side_far && down, slab_near > side_near && !down, outside);
    return ShapeHit(select(MISS, t, hit), select(CONE_SIDE, CONE_CAP, on_cap));
}

fn cone_project(point: vec3<f32>, face: u32) -> vec3<f32> {
    let rho = sqrt(point.x * point.x + point.z * point.z);
    let on_side = face == CONE_SIDE;
    // The foot on the generator (rho, y) = s (1, -1).
    let s = clamp(0.5 * (rho - point.y), 0.0, 1.0);
    let scale = select(1.0 / max(rho, 1.0), s / max(rho, TINY), on_side);
    // On the axis any generator will do.
    let x = select(point.x * scale, s, on_side && rho <= TINY);
    return vec3<f32>(x, select(-1.0, -s, on_side), point.z * scale);
}

fn cone_normal(point: vec3<f32>, face: u32) -> vec3<f32> {
    let rho = sqrt(point.x * point.x + point.z * point.z);
    // sqrt(1/2); the apex takes the direction of the axis.
    let scale = 0.70710678 / max(rho, TINY);
    let side = vec3<f32>(point.x * scale, select(1.0, 0.70710678, rho > TINY), point.z * scale);
    return select(vec3<f32>(0.0, -1.0, 0.0), side, face == CONE_SIDE);
}

// Around the axis to the right and from the apex downwards; the cap by x and z.
fn cone_parameterise(point: vec3<f32>, face: u32, around: Revolution) -> Parameterisation {
    if face != CONE_SIDE {
        return cap_parameterise(point, -1.0);
    }
    let dpdv = vec3<f32>(around.radial.x, -1.0, around.radial.z);
    return Parameterisation(vec2<f32>(around.u, -point.y), around.dpdu, dpdv);
}
