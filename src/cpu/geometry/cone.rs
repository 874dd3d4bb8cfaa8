//! The closed cone x² + z² ≤ y² for y in [-1, 0]; twin of `shaders/geometry/cone.wgsl`, where the method is explained.

use super::hit::{MISS, Parameterisation, ShapeHit};
use super::revolution::{Revolution, cap_parameterise};
use crate::cpu::math::roots::{FAR, TINY, quadratic_roots, safe_reciprocal};
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_SQRT_2;

pub const CONE_SIDE: u32 = 0;
pub const CONE_CAP: u32 = 1;

/// Nearest hit in (0, t_max) of a ray in object space, whose direction need not be a unit vector.
#[inline]
pub fn cone_intersect(origin: Vec3, direction: Vec3, t_max: f32) -> ShapeHit {
    let d = direction;
    // ⟨o, o⟩ loses its digits out along the side: start from the closest approach to the apex instead.
    let shift = -(origin.x * d.x + origin.y * d.y + origin.z * d.z) / (d.x * d.x + d.y * d.y + d.z * d.z);
    let o = origin + d * shift;

    // Parallel to the side, the second root is far away, but finite.
    let a0 = (d.x * d.x + d.z * d.z) - d.y * d.y;
    let least = 1.0e-9 * (d.y * d.y);
    let a = if a0.abs() > least { a0 } else { least };
    let b = o.y * d.y - (o.x * d.x + o.z * d.z);
    let c = (o.x * o.x + o.z * o.z) - o.y * o.y;
    let mx = o.y * d.z - o.z * d.y;
    let my = o.z * d.x - o.x * d.z;
    let mz = o.x * d.y - o.y * d.x;
    let discriminant = (mx * mx + mz * mz) - my * my;
    let (root_near, root_far) = quadratic_roots(a, b, c, discriminant);
    let steep = a < 0.0;
    let down = d.y < 0.0;
    let (side_near, side_far) = match (steep, down) {
        (false, _) => (root_near, root_far),
        (true, true) => (root_far, FAR),
        (true, false) => (-FAR, root_near),
    };
    let meets = steep || discriminant >= 0.0 || (c < 0.0 && o.y < 0.0);

    let inverse_y = safe_reciprocal(d.y);
    let apex = -o.y * inverse_y;
    let cap = (-1.0 - o.y) * inverse_y;
    let slab_near = apex.min(cap);
    let slab_far = apex.max(cap);

    let near = side_near.max(slab_near) + shift;
    let far = side_far.min(slab_far) + shift;
    let outside = near > 0.0;
    let t = if outside { near } else { far };
    let hit = meets && near <= far && t > 0.0 && t < t_max;
    // The slab's upper plane touches the cone in the apex alone, which counts as side.
    let on_cap = if outside { slab_near > side_near && !down } else { slab_far < side_far && down };
    ShapeHit { t: if hit { t } else { MISS }, face: if on_cap { CONE_CAP } else { CONE_SIDE } }
}

/// The nearest point of the face.
#[inline]
pub fn cone_project(point: Vec3, face: u32) -> Vec3 {
    let rho = (point.x * point.x + point.z * point.z).sqrt();
    let on_side = face == CONE_SIDE;
    // The foot on the generator (rho, y) = s (1, -1).
    let s = (0.5 * (rho - point.y)).clamp(0.0, 1.0);
    let scale = if on_side { s / rho.max(TINY) } else { 1.0 / rho.max(1.0) };
    // On the axis any generator will do.
    let x = if on_side && rho <= TINY { s } else { point.x * scale };
    Vec3::new(x, if on_side { -s } else { -1.0 }, point.z * scale)
}

/// Unit outward normal at a point of the face; the apex takes the direction of the axis.
#[inline]
pub fn cone_normal(point: Vec3, face: u32) -> Vec3 {
    if face != CONE_SIDE {
        return Vec3::NEG_Y;
    }
    let rho = (point.x * point.x + point.z * point.z).sqrt();
    let scale = FRAC_1_SQRT_2 / rho.max(TINY);
    Vec3::new(point.x * scale, if rho > TINY { FRAC_1_SQRT_2 } else { 1.0 }, point.z * scale)
}

/// Around the axis to the right and from the apex downwards; the cap by x and z.
#[inline]
pub fn cone_parameterise(point: Vec3, face: u32, around: Revolution) -> Parameterisation {
    if face != CONE_SIDE {
        return cap_parameterise(point, -1.0);
    }
    let dpdv = Vec3::new(around.radial.x, -1.0, around.radial.z);
    Parameterisation { uv: Vec2::new(around.u, -point.y), dpdu: around.dpdu, dpdv }
}
