//! Functions that both renderers share, written in the same order of operations.

pub mod elementary;
pub mod noise;
pub mod offset;
pub mod rng;
pub mod roots;
pub mod sampling;
