//! The unit sphere about the origin; twin of `shaders/geometry/sphere.wgsl`.

use super::hit::{MISS, Parameterisation, ShapeHit};
use super::revolution::Revolution;
use crate::cpu::math::elementary::atan2_poly;
use crate::cpu::math::roots::quadratic_roots;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// Nearest hit in (0, t_max) of a ray in object space, whose direction need not be a unit vector.
#[inline]
pub fn sphere_intersect(origin: Vec3, direction: Vec3, t_max: f32) -> ShapeHit {
    let o = origin;
    let d = direction;
    let a = d.x * d.x + d.y * d.y + d.z * d.z;
    let b = -(o.x * d.x + o.y * d.y + o.z * d.z);
    let c = (o.x * o.x + o.y * o.y + o.z * o.z) - 1.0;
    // |moment|² = |closest approach|² a, so the discriminant keeps its digits however far the origin is.
    let mx = o.y * d.z - o.z * d.y;
    let my = o.z * d.x - o.x * d.z;
    let mz = o.x * d.y - o.y * d.x;
    let discriminant = a - (mx * mx + my * my + mz * mz);
    let (near, far) = quadratic_roots(a, b, c, discriminant);
    let t = if near > 0.0 { near } else { far };
    // From inside there is always a way out, whatever rounding makes of the discriminant.
    let hit = (discriminant >= 0.0 || c < 0.0) && t > 0.0 && t < t_max;
    ShapeHit { t: if hit { t } else { MISS }, face: 0 }
}

/// The nearest point of the sphere.
#[inline]
pub fn sphere_project(point: Vec3, face: u32) -> Vec3 {
    sphere_normal(point, face)
}

/// Unit outward normal at a point of the surface.
#[inline]
pub fn sphere_normal(point: Vec3, _face: u32) -> Vec3 {
    point / (point.x * point.x + point.y * point.y + point.z * point.z).sqrt()
}

/// Longitude to the right and latitude downwards; the seam is at -x.
#[inline]
pub fn sphere_parameterise(point: Vec3, _face: u32, around: Revolution) -> Parameterisation {
    // The latitude is asin(y), in the form that keeps its digits near the poles.
    let v = 0.5 - atan2_poly(point.y, around.rho) * FRAC_1_PI;
    let rise = point.y * PI;
    let dpdv = Vec3::new(around.radial.x * rise, around.rho * -PI, around.radial.z * rise);
    Parameterisation { uv: Vec2::new(around.u, v), dpdu: around.dpdu, dpdv }
}
