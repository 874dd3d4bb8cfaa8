//! The infinite plane y = 0, with normal +y on both sides; twin of `shaders/geometry/plane.wgsl`.

use super::hit::{MISS, Parameterisation, ShapeHit};
use crate::cpu::math::roots::safe_reciprocal;
use glam::{Vec2, Vec3};

/// Hit in (0, t_max) of a ray in object space, whose direction need not be a unit vector.
#[inline]
pub fn plane_intersect(origin: Vec3, direction: Vec3, t_max: f32) -> ShapeHit {
    let t = -origin.y * safe_reciprocal(direction.y);
    let hit = direction.y != 0.0 && t > 0.0 && t < t_max;
    ShapeHit { t: if hit { t } else { MISS }, face: 0 }
}

/// The nearest point of the plane.
#[inline]
pub fn plane_project(point: Vec3, _face: u32) -> Vec3 {
    Vec3::new(point.x, 0.0, point.z)
}

/// +y everywhere.
#[inline]
pub fn plane_normal(_point: Vec3, _face: u32) -> Vec3 {
    Vec3::Y
}

/// One image a unit square, upright as seen from above with -z up.
#[inline]
pub fn plane_parameterise(point: Vec3, _face: u32) -> Parameterisation {
    Parameterisation { uv: Vec2::new(point.x, point.z), dpdu: Vec3::X, dpdv: Vec3::Z }
}
