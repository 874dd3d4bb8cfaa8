//! What intersection returns; twin of `shaders/geometry/hit.wgsl`, where the fields are described.

use glam::{Vec2, Vec3};

pub const MISS: f32 = -1.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    pub t: f32,
    pub face: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub t: f32,
    pub instance: u32,
    pub primitive: u32,
    pub b1: f32,
    pub b2: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    pub point: Vec3,
    pub geometric_normal: Vec3,
    pub shading_normal: Vec3,
    pub entering: bool,
    pub material: u32,
    pub diffuse: Vec3,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameterisation {
    pub uv: Vec2,
    pub dpdu: Vec3,
    pub dpdv: Vec3,
}
