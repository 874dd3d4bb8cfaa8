//! What the surfaces of revolution about the y axis share of their texture coordinates; twin of
//! `shaders/geometry/revolution.wgsl`.

use super::hit::Parameterisation;
use crate::cpu::math::elementary::atan2_poly;
use crate::cpu::math::roots::TINY;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, TAU};

/// Tangents along u are not shorter than at this distance from the axis, where they would vanish.
pub const LEAST_REVOLUTION: f32 = 1.0e-6;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Revolution {
    /// 1/2 at +x, growing to the right as seen from outside with +y up; the seam is at -x.
    pub u: f32,
    /// Distance from the axis.
    pub rho: f32,
    /// Unit direction away from the axis (+x on it).
    pub radial: Vec3,
    pub dpdu: Vec3,
}

#[inline]
pub fn revolution(point: Vec3) -> Revolution {
    let rho = (point.x * point.x + point.z * point.z).sqrt();
    let inverse = 1.0 / rho.max(TINY);
    let radial = if rho <= TINY { Vec3::X } else { Vec3::new(point.x * inverse, 0.0, point.z * inverse) };
    let u = 0.5 - atan2_poly(point.z, point.x) * (0.5 * FRAC_1_PI);
    let speed = rho.max(LEAST_REVOLUTION) * TAU;
    Revolution { u, rho, radial, dpdu: Vec3::new(radial.z * speed, 0.0, -(radial.x * speed)) }
}

/// The disc that closes a cylinder or cone: the image's inscribed circle, upright as seen from outside with -z up on
/// the upper side (`side` 1), +z on the lower (-1).
#[inline]
pub fn cap_parameterise(point: Vec3, side: f32) -> Parameterisation {
    let uv = Vec2::new(point.x * 0.5 + 0.5, (point.z * side) * 0.5 + 0.5);
    Parameterisation { uv, dpdu: Vec3::new(2.0, 0.0, 0.0), dpdv: Vec3::new(0.0, 0.0, 2.0 * side) }
}
