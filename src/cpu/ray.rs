//! A ray of the tree; twin of `shaders/ray.wgsl`.

use glam::{UVec2, Vec3};

pub const T_INFINITY: f32 = 3.0e38;

/// A ray of the tree. It has no weight: the recursion multiplies on the way back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: Vec3,
    /// Where it is as to mist: the point of the surface that it leaves, without the offset, which might skip a boundary.
    pub start: Vec3,
    /// Unit.
    pub direction: Vec3,
    /// The refractive media and the mists that it is in.
    pub media: UVec2,
    pub mists: UVec2,
    /// Width of what it stands for at its origin, world units, and how that grows a world unit: a ray cone
    /// (Akenine-Möller et al., Ray Tracing Gems ch. 20).
    pub cone_width: f32,
    pub cone_spread: f32,
    /// Number among the samples that share `key`, and the key of its random decisions.
    pub index: u32,
    pub key: u32,
    pub depth: u32,
}
