//! The GPU's side of the sample loop.

use super::device::{Device, DeviceKind};
use super::dispatch::Session;
use super::pipeline::Pipeline;
use crate::film::Film;
use crate::flatten::{FeatureSet, SceneBuffers};
use crate::layout::{Dispatch, FilmPixel, Frame};
use crate::renderer::{BLOCKS_A_THREAD, PrepareCounts, Renderer, Tally};
use crate::shader::{MemoryAccess, Program, RENDER_ENTRY_POINT};
use crate::{Error, Result};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// Blocks, of 64 invocations each, that fill a large GPU.
const HARDWARE_BLOCKS: u32 = 4096;

/// How to run the kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GpuOptions {
    /// Keep naga's bounds checks of array indices and loops in the kernel: slower on GPUs, and a fault in a shader
    /// or a scene's buffers then reads a wrong element rather than someone else's memory.
    pub checked: bool,
}

/// Renders on a GPU or a software Vulkan device.
pub struct GpuRenderer {
    device: Device,
    options: GpuOptions,
    program: Program,
    entry_point: String,
    /// By what they are specialised to; they differ in nothing else.
    pipelines: HashMap<FeatureSet, Pipeline>,
    session: Option<Session>,
    /// See [`Renderer::takes_work`].
    takes_work: bool,
    warmup_seconds: f64,
    counts: PrepareCounts,
}

impl GpuRenderer {
    /// A renderer with the kernel of `shaders/kernels/render.wgsl`.
    ///
    /// # Errors
    /// [`Error::Shader`] where the shaders are not valid.
    pub fn new(device: Device, options: GpuOptions) -> Result<Self> {
        let program = Program::renderer(device.memory_access(), &[])?;
        Ok(GpuRenderer::with_program(device, options, program, RENDER_ENTRY_POINT))
    }

    /// A renderer with another kernel, which has to use the bindings of `shaders/bindings.wgsl` and workgroups of 64
    /// in one dimension, to do nothing where `workgroup_id.x >= dispatch.block_count` or else to ask `take_work` until
    /// nothing is left, and to call `claim_lane` before it traces rays.
    pub fn with_program(device: Device, options: GpuOptions, program: Program, entry_point: &str) -> Self {
        let entry_point = entry_point.to_owned();
        let takes_work = device.memory_access() == MemoryAccess::SharedPairs;
        GpuRenderer {
            device,
            options,
            program,
            entry_point,
            pipelines: HashMap::new(),
            session: None,
            takes_work,
            warmup_seconds: 0.0,
            counts: PrepareCounts::default(),
        }
    }

    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Seconds that the last `prepare` spent on compiling the kernel and its first dispatch.
    pub fn warmup_seconds(&self) -> f64 {
        self.warmup_seconds
    }

    /// The kernel for these features; whether it was compiled just now.
    fn pipeline(&mut self, features: FeatureSet) -> Result<(Pipeline, bool)> {
        if let Some(pipeline) = self.pipelines.get(&features) {
            self.counts.pipelines_reused += 1;
            return Ok((pipeline.clone(), false));
        }
        let (source, overrides) = (self.program.source(), features.overrides());
        let pipeline = Pipeline::new(&self.device, source, &self.entry_point, &overrides, self.options.checked)?;
        self.pipelines.insert(features, pipeline.clone());
        self.counts.pipelines_compiled += 1;
        Ok((pipeline, true))
    }

    fn session(&mut self) -> Result<&mut Session> {
        self.session.as_mut().ok_or_else(|| Error::Kernel("the renderer was used before a scene was prepared".into()))
    }
}

/// As many threads has lavapipe.
fn cores() -> u32 {
    std::thread::available_parallelism().map_or(1, |cores| cores.get() as u32)
}

impl Renderer for GpuRenderer {
    /// # Errors
    /// [`Error::Limit`] for a scene that the device cannot hold, [`Error::Shader`], and [`Error::Device`] where the
    /// device runs out of memory or is lost, as from every other call.
    fn prepare(&mut self, scene: Arc<SceneBuffers>) -> Result<()> {
        let start = Instant::now();
        let (pipeline, is_new) = self.pipeline(scene.features)?;
        let compiled = start.elapsed();
        let before = self.session.take();
        let frame = scene.frame;
        let mut session = Session::new(&self.device, pipeline, scene, before, &mut self.counts)?;
        let start = Instant::now();
        if is_new && !session.warm_up(&frame)? && self.takes_work {
            self.takes_work = false;
            log::info!("the driver cuts long loops short: an invocation renders one pixel");
        }
        self.warmup_seconds = (compiled + start.elapsed()).as_secs_f64();
        self.session = Some(session);
        Ok(())
    }

    fn prepare_counts(&self) -> PrepareCounts {
        self.counts
    }

    fn max_band_pixels(&self) -> u64 {
        let limits = self.device.limits();
        let bytes = limits.storage_binding.min(limits.buffer);
        bytes / size_of::<FilmPixel>() as u64
    }

    fn portions(&self) -> u32 {
        if self.device.description().kind == DeviceKind::Software { cores() } else { 1 }
    }

    fn takes_work(&self) -> bool {
        self.takes_work
    }

    fn stop_taking_work(&mut self) {
        self.takes_work = false;
    }

    fn busy_blocks(&self) -> u32 {
        if self.device.description().kind == DeviceKind::Software { BLOCKS_A_THREAD * cores() } else { HARDWARE_BLOCKS }
    }

    fn begin_band(&mut self, rows: Range<u32>) -> Result<()> {
        self.session()?.begin_band(rows)
    }

    fn submit(&mut self, frame: &Frame, dispatches: &[Dispatch]) -> Result<Tally> {
        self.session()?.submit(frame, dispatches)
    }

    fn end_band(&mut self, film: &mut Film) -> Result<()> {
        self.session()?.end_band(film)
    }
}
