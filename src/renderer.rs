//! What a renderer offers to the sample loop in `render.rs`: the GPU and the CPU one serve the same loop.

use crate::Result;
use crate::film::Film;
use crate::flatten::SceneBuffers;
use crate::layout::{self, Dispatch, Frame};
use std::ops::{AddAssign, Range};
use std::sync::Arc;

/// What rendering reports besides the picture: STATUS_* flags, and rays traced of each RAY_* kind.
/// Twin of `Tally` in `shaders/tally.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub flags: u32,
    pub rays: [u64; layout::RAY_KINDS as usize],
}

impl Tally {
    pub fn total_rays(&self) -> u64 {
        self.rays.iter().sum()
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.flags |= other.flags;
        for (sum, count) in self.rays.iter_mut().zip(other.rays) {
            *sum += count;
        }
    }
}

/// What renderers keep from scene to scene: how often it was made, and how often that was spared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrepareCounts {
    pub pipelines_compiled: u64,
    pub pipelines_reused: u64,
    /// Arrays of scenes.
    pub buffers_uploaded: u64,
    pub buffers_reused: u64,
}

/// Blocks a thread that keep it from waiting long for the others at the end of a dispatch.
pub const BLOCKS_A_THREAD: u32 = 16;

/// A device that renders passes of samples into the film of a band of rows.
pub trait Renderer {
    /// Uploads the scene and specialises the program to it.
    fn prepare(&mut self, scene: Arc<SceneBuffers>) -> Result<()>;

    /// The most pixels that the film buffer can hold; a larger picture is rendered in bands of rows.
    fn max_band_pixels(&self) -> u64;

    /// Clears the film buffer for these rows of the picture.
    fn begin_band(&mut self, rows: Range<u32>) -> Result<()>;

    /// Runs the dispatches, waits for them, and returns their flags and ray counts.
    fn submit(&mut self, frame: &Frame, dispatches: &[Dispatch]) -> Result<Tally>;

    /// Adds the sums of the band to the film.
    fn end_band(&mut self, film: &mut Film) -> Result<()>;

    /// Processors that each take a contiguous portion of a dispatch's workgroups, however long the others have to do.
    fn portions(&self) -> u32 {
        1
    }

    /// Whether subgroups take the pixels of a dispatch as they come, which keeps all processors busy to its end, but has
    /// an invocation make more turns of its loops.
    fn takes_work(&self) -> bool {
        false
    }

    /// From now on, leaves each invocation its one pixel.
    fn stop_taking_work(&mut self) {}

    /// Blocks that a dispatch needs to keep all processors busy.
    fn busy_blocks(&self) -> u32 {
        1
    }

    /// What `prepare` has done so far; a renderer without programs and uploads counts nothing.
    fn prepare_counts(&self) -> PrepareCounts {
        PrepareCounts::default()
    }
}
