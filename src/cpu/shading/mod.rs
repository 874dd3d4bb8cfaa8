//! Light and surfaces.

pub mod light;
pub mod material;
