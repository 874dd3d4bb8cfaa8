//! Origins of rays that leave a surface (Wächter and Binder, Ray Tracing Gems ch. 6); twin of
//! `shaders/math/offset.wgsl`.

use glam::Vec3;

/// p moved off the surface along the unit vector n, which points to the side where the new ray goes: by 256 units in
/// the last place of each coordinate (times n), and near the planes of the origin by 2⁻¹⁶. World space.
#[inline]
pub fn offset_ray_origin(p: Vec3, n: Vec3) -> Vec3 {
    Vec3::new(offset_coordinate(p.x, n.x), offset_coordinate(p.y, n.y), offset_coordinate(p.z, n.z))
}

#[inline]
fn offset_coordinate(p: f32, n: f32) -> f32 {
    let units = (256.0 * n) as i32;
    let away = if p < 0.0 { -units } else { units };
    if p.abs() < 1.0 / 32.0 {
        p + n * (1.0 / 65536.0)
    } else {
        f32::from_bits((p.to_bits() as i32).wrapping_add(away) as u32)
    }
}
