//! What maps do to a surface: its colour from a texture, its normal from a bump map. Twin of `shaders/shading/detail.wgsl`.
use crate::cpu::geometry::hit::{Hit, Surface};
pub fn surface_detail(_: &crate::cpu::bindings::Bindings, _: Hit, surface: Surface, _: glam::Vec3, _: f32) -> Surface {
    surface
}
