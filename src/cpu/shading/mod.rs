//! Light and surfaces.

pub mod background;
pub mod bump;
pub mod detail;
pub mod light;
pub mod material;
pub mod medium;
pub mod texture;
