//! The reference renderer: one file for each `.wgsl` file, with the same functions under the same names.

pub mod bindings;
pub mod camera;
pub mod dimensions;
pub mod film;
pub mod geometry;
pub mod math;
pub mod media;
pub mod path;
pub mod ray;
pub mod shading;

mod renderer;

pub use renderer::CpuRenderer;
