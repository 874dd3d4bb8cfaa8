//! Frames of an animation: which ones, under which names, and the batch that makes them.
//!
//! Each frame is a run of the script of its own, told its number, so that frame n of a batch is the picture that frame n
//! is alone. What a batch saves is what the runs have in common: the device and its compiled kernels, files, built
//! meshes and packed images; and the time that scripts and encoders take beside the renderer ([`batch`]).

pub mod batch;
mod pattern;
mod range;

pub use batch::{Batch, BatchOutput, Painter, run_batch};
pub use pattern::{FramePattern, is_whole_png};
pub use range::FrameRange;

use crate::cpu::math::rng::hash_combine;

/// The seed of one frame where each has noise of its own.
pub fn seed_of_frame(seed: u32, frame: u32) -> u32 {
    hash_combine(seed, frame)
}
