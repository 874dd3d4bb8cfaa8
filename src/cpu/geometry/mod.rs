//! Intersection of rays with shapes, and of rays with the scene.

pub mod bvh;
pub mod cone;
pub mod cube;
pub mod cylinder;
pub mod hit;
pub mod instance;
pub mod parameterisation;
pub mod plane;
pub mod revolution;
pub mod sphere;
pub mod torus;
pub mod triangle;
