//! Images in the texel buffer: bilinear, repeated, filtered by the width of the ray; twin of
//! `shaders/shading/texture.wgsl`, where the format is described.

use crate::cpu::bindings::Bindings;
use crate::cpu::math::elementary::{atan2_poly, log2_poly};
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

pub const TEXELS_RGBA8: u32 = 0;
pub const TEXELS_RGB9E5: u32 = 1;
pub const TEXEL_HEADER: u32 = 4;

/// Width and height, texels.
pub fn texture_size(scene: &Bindings, image: u32) -> Vec2 {
    Vec2::new(scene.texels[image as usize] as f32, scene.texels[image as usize + 1] as f32)
}

/// The image's colour about uv, averaged over a square of the edge `footprint` (in uv units): between the two levels
/// whose texels are next to that wide (Williams, "Pyramidal Parametrics", SIGGRAPH 1983).
pub fn texture_lookup(scene: &Bindings, image: u32, uv: Vec2, footprint: f32) -> Vec3 {
    let last = scene.texels[image as usize + 2] - 1;
    let size = texture_size(scene, image);
    let width = (footprint * size.x.max(size.y)).clamp(1.0, 16_777_216.0);
    let level = log2_poly(width).min(last as f32);
    let finer = level.floor();
    let blend = level - finer;
    let levels = if blend > 0.0 { 2 } else { 1 };
    let mut colour = Vec3::ZERO;
    for i in 0..levels {
        let found = texture_level(scene, image, (finer as u32 + i).min(last), uv);
        colour = if i == 0 { found } else { mix_texels(colour, found, blend) };
    }
    colour
}

/// The radiance from a direction in an equirectangular picture: its middle is towards -z, its top row straight up.
pub fn environment_lookup(scene: &Bindings, image: u32, direction: Vec3) -> Vec3 {
    let size = texture_size(scene, image);
    let d = direction;
    let u = atan2_poly(d.x, -d.z) * (0.5 * FRAC_1_PI) + 0.5;
    let v = 0.5 - atan2_poly(d.y, (d.x * d.x + d.z * d.z).sqrt()) * FRAC_1_PI;
    // Above the middle of the top row, and below that of the bottom row, there is nothing to blend with.
    let half_row = 0.5 / size.y;
    texture_level(scene, image, 0, Vec2::new(u, v.max(half_row).min(1.0 - half_row)))
}

/// Bilinear in one level, repeated.
fn texture_level(scene: &Bindings, image: u32, level: u32, uv: Vec2) -> Vec3 {
    let texels = scene.texels;
    let width = (texels[image as usize] >> level).max(1);
    let height = (texels[image as usize + 1] >> level).max(1);
    let start = image + texels[(image + TEXEL_HEADER + level) as usize];
    let rgb9e5 = texels[image as usize + 3] == TEXELS_RGB9E5;
    let x = (uv.x - uv.x.floor()) * width as f32 - 0.5;
    let y = (uv.y - uv.y.floor()) * height as f32 - 0.5;
    let x0 = x.floor();
    let y0 = y.floor();
    let right = texel_after(x0, width);
    let below = texel_after(y0, height);
    let left = if right == 0 { width } else { right } - 1;
    let above = if below == 0 { height } else { below } - 1;
    let texel = |index: u32| texel_colour(texels[index as usize], rgb9e5);
    // An image of one row has no second to blend with.
    let rows = if height > 1 { 2 } else { 1 };
    let mut colour = Vec3::ZERO;
    for i in 0..rows {
        let row = start + if i == 0 { above } else { below } * width;
        let found = mix_texels(texel(row + left), texel(row + right), x - x0);
        colour = if i == 0 { found } else { mix_texels(colour, found, y - y0) };
    }
    colour
}

/// The texel to the right of coordinate x in [-1, count], repeated. Always below count.
fn texel_after(x: f32, count: u32) -> u32 {
    let after = (x + 1.0).clamp(0.0, count as f32) as u32;
    if after >= count { 0 } else { after }
}

fn mix_texels(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}

fn texel_colour(word: u32, rgb9e5: bool) -> Vec3 {
    let bits = if rgb9e5 { 9 } else { 8 };
    let mask = (1 << bits) - 1;
    // What stands for 1: 255, or 2^(15 + 9 - exponent) by its bits.
    let one = if rgb9e5 { f32::from_bits((151 - (word >> 27)) << 23) } else { 255.0 };
    Vec3::new((word & mask) as f32, ((word >> bits) & mask) as f32, ((word >> (2 * bits)) & mask) as f32) / one
}
