//! The closed cylinder x² + z² ≤ 1 for y in [-1, 1]; twin of `shaders/geometry/cylinder.wgsl`. It is convex: a ray is
//! inside both the infinite cylinder and the slab between the caps for one interval.

use super::hit::{MISS, Parameterisation, ShapeHit};
use super::revolution::{Revolution, cap_parameterise};
use crate::cpu::math::roots::{FAR, quadratic_roots, safe_reciprocal};
use glam::{Vec2, Vec3};

pub const CYLINDER_SIDE: u32 = 0;
pub const CYLINDER_TOP: u32 = 1;
pub const CYLINDER_BOTTOM: u32 = 2;

/// Nearest hit in (0, t_max) of a ray in object space, whose direction need not be a unit vector.
#[inline]
pub fn cylinder_intersect(origin: Vec3, direction: Vec3, t_max: f32) -> ShapeHit {
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
    let (root_near, root_far) = quadratic_roots(a.max(least), b, c, discriminant);
    let side_near = if parallel { -FAR } else { root_near };
    let side_far = if parallel { FAR } else { root_far };
    let meets = c <= 0.0 || (discriminant >= 0.0 && !parallel);

    let inverse_y = safe_reciprocal(d.y);
    let bottom = (-1.0 - o.y) * inverse_y;
    let top = (1.0 - o.y) * inverse_y;
    let cap_near = bottom.min(top);
    let cap_far = bottom.max(top);

    let near = side_near.max(cap_near);
    let far = side_far.min(cap_far);
    let outside = near > 0.0;
    let t = if outside { near } else { far };
    let hit = meets && near <= far && t > 0.0 && t < t_max;
    let on_side = if outside { side_near >= cap_near } else { side_far <= cap_far };
    let cap = if (inverse_y > 0.0) != outside { CYLINDER_TOP } else { CYLINDER_BOTTOM };
    ShapeHit { t: if hit { t } else { MISS }, face: if on_side { CYLINDER_SIDE } else { cap } }
}

/// The nearest point of the face.
#[inline]
pub fn cylinder_project(point: Vec3, face: u32) -> Vec3 {
    let rho = (point.x * point.x + point.z * point.z).sqrt();
    let on_side = face == CYLINDER_SIDE;
    // On a cap the distance from the axis stays, unless it passes the rim.
    let scale = 1.0 / if on_side { rho } else { rho.max(1.0) };
    let cap_y = if face == CYLINDER_TOP { 1.0 } else { -1.0 };
    Vec3::new(point.x * scale, if on_side { point.y.clamp(-1.0, 1.0) } else { cap_y }, point.z * scale)
}

/// Unit outward normal at a point of the face.
#[inline]
pub fn cylinder_normal(point: Vec3, face: u32) -> Vec3 {
    match face {
        CYLINDER_SIDE => {
            let scale = 1.0 / (point.x * point.x + point.z * point.z).sqrt();
            Vec3::new(point.x * scale, 0.0, point.z * scale)
        }
        CYLINDER_TOP => Vec3::Y,
        _ => Vec3::NEG_Y,
    }
}

/// Around the axis to the right and along it downwards; the caps by x and z.
#[inline]
pub fn cylinder_parameterise(point: Vec3, face: u32, around: Revolution) -> Parameterisation {
    if face != CYLINDER_SIDE {
        return cap_parameterise(point, if face == CYLINDER_TOP { 1.0 } else { -1.0 });
    }
    let v = 0.5 - point.y * 0.5;
    Parameterisation { uv: Vec2::new(around.u, v), dpdu: around.dpdu, dpdv: Vec3::new(0.0, -2.0, 0.0) }
}
