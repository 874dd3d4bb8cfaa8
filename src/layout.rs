//! The structures that cross to WGSL, field for field as in `shaders/types.wgsl`, and nothing else.
//!
//! `tests/layout.rs` compares every size and offset with what naga computes. Units and meanings are documented at
//! the WGSL declarations, which are the ones a reader of the kernel meets; here only what Rust adds is said.

use bytemuck::{Pod, Zeroable};
use glam::{UVec2, UVec4, Vec3, Vec4};

/// Constants of one picture; twin of `Frame`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Frame {
    pub eye: Vec3,
    pub lens_edge: f32,
    pub right: Vec3,
    pub tan_half_fov: f32,
    pub up: Vec3,
    pub focus_distance: f32,
    pub forward: Vec3,
    pub aspect: f32,
    pub ambient: Vec3,
    pub seed: u32,
    pub background_bottom: Vec3,
    pub flags: u32,
    pub background_top: Vec3,
    pub max_depth: u32,
    pub medium: UVec2,
    pub image_size: UVec2,
    pub plane_count: u32,
    pub bounded_count: u32,
    pub light_count: u32,
    pub pass_count: u32,
    pub shadow_count: u32,
    pub light_samples: u32,
    pub deep_light_samples: u32,
    pub glossy_samples: u32,
    pub mist: UVec2,
    pub background_image: u32,
    pub pixel_spread: f32,
    pub mist_count: u32,
    pub mist_root: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// Constants of one dispatch; twin of `Dispatch`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Dispatch {
    pub sample_index: u32,
    pub sample_count: u32,
    pub pass_index: u32,
    pub band_row: u32,
    pub band_rows: u32,
    pub first_block: u32,
    pub block_count: u32,
    pub tile_stride: u32,
    pub portions: u32,
    pub takes_work: u32,
    pub canary_turns: u32,
}

/// A node of the compressed wide hierarchy; twin of `Node`. `flatten::bvh` makes it of obvhs's, whose bounds it has.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Node {
    pub grid: UVec4,
    pub children: UVec4,
    pub x: UVec4,
    pub y: UVec4,
    pub z: UVec4,
    pub unused: UVec4,
}

/// Three rows of an affine map: (linear part, translation); `mat3x4<f32>` in WGSL.
pub type AffineRows = [Vec4; 3];

/// A placed shape; twin of `Instance`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Instance {
    pub object_from_world: AffineRows,
    pub shape: u32,
    pub material: u32,
    pub root: u32,
    pub flags: u32,
    pub world_from_object: AffineRows,
    pub parameters: Vec4,
}

/// A triangle in object space; twin of `Triangle`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    pub p0: Vec3,
    pub n0: u32,
    pub p1: Vec3,
    pub n1: u32,
    pub p2: Vec3,
    pub n2: u32,
    pub uv0: u32,
    pub uv1: u32,
    pub uv2: u32,
    pub flags: u32,
}

/// Twin of `Material`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Material {
    pub diffuse: Vec3,
    pub shininess: f32,
    pub specular: Vec3,
    pub reflection: f32,
    pub emission: Vec3,
    pub glossy: f32,
    pub ior: f32,
    pub density: f32,
    pub noise_z: f32,
    pub flags: u32,
    pub texture: u32,
    pub bump: u32,
    pub medium: u32,
    pub mist_step: f32,
}

/// Twin of `Light`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Light {
    pub position: Vec3,
    pub kind: u32,
    pub colour: Vec3,
    pub radius: f32,
    pub falloff: Vec3,
    pub pad0: u32,
    pub u: Vec3,
    pub pad1: u32,
    pub v: Vec3,
    pub pad2: u32,
}

/// Sums of one pixel's samples; twin of `FilmPixel`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct FilmPixel {
    pub low: [u32; 4],
    pub high: [u32; 4],
}

/// What the kernel reports; twin of `Status` (plain integers on the host's side).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Status {
    pub flags: u32,
    pub taken: u32,
    pub pad1: u32,
    pub pad2: u32,
    pub rays: [u32; 256],
}

pub const NONE: u32 = 0xffff_ffff;

pub const FRAME_SAMPLE_CENTRE: u32 = 1;
pub const FRAME_SAMPLE_CORNER: u32 = 2;
pub const FRAME_TRANSPARENT: u32 = 4;
pub const FRAME_BLINN: u32 = 8;

pub const SHAPE_SPHERE: u32 = 0;
pub const SHAPE_CUBE: u32 = 1;
pub const SHAPE_CYLINDER: u32 = 2;
pub const SHAPE_CONE: u32 = 3;
pub const SHAPE_TORUS: u32 = 4;
pub const SHAPE_PLANE: u32 = 5;
pub const SHAPE_MESH: u32 = 6;

pub const TRIANGLE_SMOOTH: u32 = 1;

pub const MATERIAL_TEXTURE_REPLACES: u32 = 1;
pub const MATERIAL_NOISE_BUMP: u32 = 2;
pub const MATERIAL_MIST: u32 = 4;

pub const INSTANCE_SEEN: u32 = 1;
pub const INSTANCE_SHADES: u32 = 2;
pub const INSTANCE_MIST: u32 = 4;

pub const LIGHT_POINT: u32 = 0;
pub const LIGHT_PARALLELOGRAM: u32 = 1;
pub const LIGHT_SPHERE: u32 = 2;

pub const STATUS_LOOP_BOUND: u32 = 1;
pub const STATUS_STACK_FULL: u32 = 2;
pub const STATUS_NOT_FINITE: u32 = 4;
pub const STATUS_SATURATED: u32 = 8;
pub const STATUS_MIST_CROSSINGS: u32 = 16;

pub const RAY_CAMERA: u32 = 0;
pub const RAY_SHADOW: u32 = 1;
pub const RAY_REFLECTED: u32 = 2;
pub const RAY_REFRACTED: u32 = 3;
pub const RAY_KINDS: u32 = 4;
pub const RAY_SLOTS: u32 = 64;
