//! The unit cube [0, 1]³; twin of `shaders/geometry/cube.wgsl`. Faces: 2 · axis, and 1 more for the face at 1.

use super::hit::{MISS, Parameterisation, ShapeHit};
use crate::cpu::math::roots::safe_reciprocal;
use glam::{Vec2, Vec3};

/// Nearest hit in (0, t_max) of a ray in object space, whose direction need not be a unit vector.
#[inline]
pub fn cube_intersect(origin: Vec3, direction: Vec3, t_max: f32) -> ShapeHit {
    let inverse = Vec3::new(safe_reciprocal(direction.x), safe_reciprocal(direction.y), safe_reciprocal(direction.z));
    let low = -origin * inverse;
    let high = (Vec3::ONE - origin) * inverse;
    let enters = low.min(high);
    let leaves = low.max(high);
    let near = enters.x.max(enters.y).max(enters.z);
    let far = leaves.x.min(leaves.y).min(leaves.z);
    let outside = near > 0.0;
    let t = if outside { near } else { far };
    let hit = near <= far && t > 0.0 && t < t_max;
    let met = if outside { enters } else { leaves };
    let (axis, along) = if met.x == t {
        (0, inverse.x)
    } else if met.y == t {
        (1, inverse.y)
    } else {
        (2, inverse.z)
    };
    // Upwards along its axis a ray enters through the face at 0 and leaves through the face at 1.
    let side = u32::from((along > 0.0) != outside);
    ShapeHit { t: if hit { t } else { MISS }, face: 2 * axis + side }
}

/// The nearest point of the face.
#[inline]
pub fn cube_project(point: Vec3, face: u32) -> Vec3 {
    let on_face = (face & 1) as f32;
    let mut p = point.clamp(Vec3::ZERO, Vec3::ONE);
    match face >> 1 {
        0 => p.x = on_face,
        1 => p.y = on_face,
        _ => p.z = on_face,
    }
    p
}

/// Unit outward normal of the face.
#[inline]
pub fn cube_normal(_point: Vec3, face: u32) -> Vec3 {
    let outward = (face & 1) as f32 * 2.0 - 1.0;
    match face >> 1 {
        0 => Vec3::new(outward, 0.0, 0.0),
        1 => Vec3::new(0.0, outward, 0.0),
        _ => Vec3::new(0.0, 0.0, outward),
    }
}

/// Each face shows the whole image, upright and not mirrored as seen from outside: with +y up on the four sides, -z up
/// on the top, and +z up on the bottom.
#[inline]
pub fn cube_parameterise(point: Vec3, face: u32) -> Parameterisation {
    let outward = (face & 1) as f32 * 2.0 - 1.0;
    let from_middle = point - Vec3::splat(0.5);
    let (right, down) = match face >> 1 {
        0 => (Vec3::new(0.0, 0.0, -outward), Vec3::NEG_Y),
        1 => (Vec3::X, Vec3::new(0.0, 0.0, outward)),
        _ => (Vec3::new(outward, 0.0, 0.0), Vec3::NEG_Y),
    };
    let u = (from_middle.x * right.x + from_middle.z * right.z) + 0.5;
    let v = (from_middle.y * down.y + from_middle.z * down.z) + 0.5;
    Parameterisation { uv: Vec2::new(u, v), dpdu: right, dpdv: down }
}
