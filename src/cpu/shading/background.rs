//! What rays that leave the scene see; twin of `shaders/shading/background.wgsl`.

use crate::cpu::bindings::Bindings;
use crate::cpu::shading::texture::environment_lookup;
use crate::layout::NONE;
use glam::Vec3;

/// Radiance from a unit direction: a gradient over its height, or a picture all around.
pub fn background(scene: &Bindings, direction: Vec3) -> Vec3 {
    if scene.frame.background_image != NONE {
        return environment_lookup(scene, scene.frame.background_image, direction);
    }
    mix_colour(scene.frame.background_bottom, scene.frame.background_top, 0.5 + 0.5 * direction.y)
}

pub fn mix_colour(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}
