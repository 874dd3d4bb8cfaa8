//! Mist: closed volumes that scatter light once. Twin of `shaders/shading/medium.wgsl`, where the method is described.

use crate::cpu::bindings::Bindings;
use crate::cpu::geometry::hit::Surface;
use crate::cpu::math::elementary::log2_poly;
use crate::cpu::ray::T_INFINITY;
use crate::cpu::shading::material::{media_contains, media_enter, media_leave};
use glam::{UVec2, Vec3};

/// Boundaries that one ray may cross.
pub const MIST_CROSSINGS: u32 = 256;

/// The list beyond a boundary.
pub fn mist_cross(mists: UVec2, number: u32, entering: bool) -> UVec2 {
    if !entering {
        return media_leave(mists, number);
    }
    if media_contains(mists, number) {
        return mists;
    }
    media_enter(mists, number)
}

/// Where a ray goes on that met a boundary at t and `point`, which is more exact than t. A boundary that is met again
/// just after it was crossed is one whose intersection is less exact than the step: there the ray is moved on from where
/// it was, lest `point` takes it back.
pub fn beyond_boundary(point: Vec3, origin: Vec3, direction: Vec3, t: f32, step: f32) -> Vec3 {
    let along = (point - origin).dot(direction);
    if along > step { point + step * direction } else { origin + (t + 4.0 * step) * direction }
}

/// Scattering events a world unit of one mist; number 0 is none.
pub fn mist_density(scene: &Bindings, number: u32) -> f32 {
    if number == 0 {
        return 0.0;
    }
    scene.materials[number as usize - 1].density
}

/// The same of all the mists together.
pub fn mists_density(scene: &Bindings, mists: UVec2) -> f32 {
    mist_density(scene, mists.x & 0xffff)
        + mist_density(scene, mists.x >> 16)
        + mist_density(scene, mists.y & 0xffff)
        + mist_density(scene, mists.y >> 16)
}

/// World units to the next scattering event, by inversion of exp(-density s), for xi in [0, 1).
pub fn free_flight(density: f32, xi: f32) -> f32 {
    if density <= 0.0 {
        return T_INFINITY;
    }
    -std::f32::consts::LN_2 * log2_poly(1.0 - xi) / density
}

/// Which of the mists scatters, in proportion to their densities. Numbers of 0 come last and have no share.
pub fn choose_mist(scene: &Bindings, mists: UVec2, xi: f32) -> u32 {
    let second = mists.x >> 16;
    let third = mists.y & 0xffff;
    let fourth = mists.y >> 16;
    let to_first = mist_density(scene, mists.x & 0xffff);
    let to_second = to_first + mist_density(scene, second);
    let to_third = to_second + mist_density(scene, third);
    let aim = xi * (to_third + mist_density(scene, fourth));
    let chosen = if second != 0 && aim >= to_first { second } else { mists.x & 0xffff };
    let later = if third != 0 && aim >= to_second { third } else { chosen };
    if fourth != 0 && aim >= to_third { fourth } else { later }
}

/// A scattering event as `light_sample` takes it: a surface without a normal. `number` is that of a mist, not 0.
pub fn mist_event(scene: &Bindings, point: Vec3, number: u32) -> Surface {
    Surface {
        point,
        geometric_normal: Vec3::ZERO,
        shading_normal: Vec3::ZERO,
        entering: false,
        material: number - 1,
        diffuse: scene.materials[number as usize - 1].diffuse,
    }
}

pub fn is_mist_event(surface: &Surface) -> bool {
    surface.geometric_normal == Vec3::ZERO
}
