//! The sample loop that both renderers serve: which pass of which sample runs where, and for how long.

use crate::blocks::{BLOCK_EDGE, BlockOrder, TILE_BLOCKS};
use crate::cpu::bindings::Bindings;
use crate::cpu::media::{media_at, mists_at};
use crate::cpu::shading::medium::MIST_CROSSINGS;
use crate::film::Film;
use crate::flatten::{SceneBuffers, Statistics, WorkPlan, plan_work};
use crate::layout::{Dispatch, Frame, STATUS_LOOP_BOUND, STATUS_MIST_CROSSINGS, STATUS_STACK_FULL};
use crate::renderer::{Renderer, Tally};
use crate::{Error, Result};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A submit should take about this long: GPU watchdogs stop longer ones, shorter ones waste time between them.
const SUBMIT_TARGET: Duration = Duration::from_millis(75);
/// Blocks of the first submit, before anything is known of the scene's speed.
const FIRST_RUN: u64 = 32;
/// A run grows at most by this factor from submit to submit.
const GROWTH: f64 = 4.0;
/// Dispatches in one submit.
const MAX_DISPATCHES: usize = 256;
/// Blocks in one dispatch: below WebGPU's limit of workgroups in a row, 65,535.
const MAX_BLOCKS: u64 = 1 << 15;
/// The most camera samples of a pixel in one dispatch: the more, the less is spent on reaching the film and the counters.
const MAX_SAMPLES: u32 = 8;
/// Blocks that tell how hard the picture is: a run of fewer may take much longer than the run before it.
const FAIR_BLOCKS: u32 = 16 * TILE_BLOCKS;
/// Turns of the loop that shows whether the driver cuts loops short.
const CANARY_TURNS: u32 = 4;

/// What to render of a scene.
#[derive(Clone, Debug)]
pub struct RenderOptions {
    /// Camera samples of every pixel, by their numbers. Films of disjoint ranges merge into the film of their union.
    pub samples: Range<u32>,
    /// Fixes the blocks of a dispatch instead of sizing it by time; the picture is the same for any number.
    pub blocks_per_dispatch: Option<u32>,
    /// Fixes the camera samples that a dispatch takes of each of its pixels, likewise.
    pub samples_per_dispatch: Option<u32>,
    /// The most pixels to render at a time, where the device could hold more.
    pub max_band_pixels: Option<u64>,
    /// The work of a pass, in place of the planned one; it is divided all the same where a bound is met.
    pub plan: Option<WorkPlan>,
}

impl RenderOptions {
    /// All samples that the scene asks for.
    pub fn whole(scene: &SceneBuffers) -> Self {
        RenderOptions {
            samples: 0..scene.sampling.camera,
            blocks_per_dispatch: None,
            samples_per_dispatch: None,
            max_band_pixels: None,
            plan: None,
        }
    }
}

/// How far rendering has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Camera samples a pixel, averaged over the picture.
    pub samples_done: f64,
    pub samples_total: u32,
    /// Rays of all kinds.
    pub rays: u64,
    /// Since the first submit; compiling is left out.
    pub elapsed: Duration,
}

/// Hears of progress after every submit, and may stop the rendering.
pub trait RenderControl {
    fn progress(&mut self, progress: &Progress) -> ControlFlow<()>;
}

/// Lets rendering run to its end, unheard.
pub struct Unattended;

impl RenderControl for Unattended {
    fn progress(&mut self, _: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// A rendered film and what it took.
#[derive(Clone, Debug)]
pub struct Rendered {
    pub film: Film,
    pub tally: Tally,
    /// Tracing, without `warmup_seconds`.
    pub seconds: f64,
    /// Upload, compiling and the first dispatch.
    pub warmup_seconds: f64,
    /// Passes of each sample, the largest over the bands.
    pub passes: u32,
    pub longest_submit_seconds: f64,
    /// Of the scene.
    pub statistics: Statistics,
}

/// Renders the samples of a scene.
///
/// # Errors
/// [`Error::Interrupted`] when `control` says so; [`Error::Kernel`] when the scene's work passes a bound of the kernel or
/// the driver however it is divided; what the device reports.
pub fn render(
    scene: Arc<SceneBuffers>,
    renderer: &mut dyn Renderer,
    options: &RenderOptions,
    control: &mut dyn RenderControl,
) -> Result<Rendered> {
    let warmup = Instant::now();
    renderer.prepare(scene.clone())?;
    let warmup_seconds = warmup.elapsed().as_secs_f64();

    let mut frame = scene.frame;
    if scene.features.refraction {
        frame.medium = media_at(&Bindings::new(&scene, &frame), frame.eye);
    }
    if scene.features.mist {
        frame.mist = mists_at(&Bindings::new(&scene, &frame), frame.eye);
    }
    let [width, height] = frame.image_size.to_array();
    let band_pixels = options.max_band_pixels.unwrap_or(u64::MAX).min(renderer.max_band_pixels());
    let band_rows = band_rows(width, height, band_pixels)?;
    let started = Instant::now();
    let mut job = Job {
        renderer,
        options,
        control,
        started,
        frame,
        scene: &scene,
        plan: options.plan.unwrap_or_else(|| plan(&scene, 1)),
        run: FIRST_RUN as f64,
        most_samples: options.samples_per_dispatch.unwrap_or(MAX_SAMPLES).max(1),
        tally: Tally::default(),
        pixels_before: 0,
        pixels_total: u64::from(width) * u64::from(height),
        longest_submit: Duration::ZERO,
    };
    let mut film = Film::new(width, height);
    for first_row in (0..height).step_by(band_rows as usize) {
        let rows = first_row..height.min(first_row + band_rows);
        job.render_band(rows.clone())?;
        job.renderer.end_band(&mut film)?;
        job.pixels_before += u64::from(rows.end - rows.start) * u64::from(width);
    }
    film.samples = options.samples.end - options.samples.start;
    Ok(Rendered {
        film,
        tally: job.tally,
        seconds: started.elapsed().as_secs_f64(),
        warmup_seconds,
        passes: job.plan.pass_count,
        longest_submit_seconds: job.longest_submit.as_secs_f64(),
        statistics: scene.statistics,
    })
}

fn plan(scene: &SceneBuffers, min_passes: u32) -> WorkPlan {
    plan_work(scene.frame.light_count, scene.sampling.shadow, scene.sampling.glossy, min_passes)
}

/// Rows of a band: whole blocks, as many as the film buffer holds.
fn band_rows(width: u32, height: u32, band_pixels: u64) -> Result<u32> {
    let fitting = band_pixels / u64::from(width);
    if fitting >= u64::from(height) {
        return Ok(height);
    }
    let rows = (fitting / u64::from(BLOCK_EDGE) * u64::from(BLOCK_EDGE)) as u32;
    if rows == 0 {
        return Err(Error::Scene(format!("a picture {width} pixels wide does not fit the device's film buffer")));
    }
    Ok(rows)
}

/// What stays the same, and what adds up, from band to band.
struct Job<'a> {
    renderer: &'a mut dyn Renderer,
    options: &'a RenderOptions,
    control: &'a mut dyn RenderControl,
    started: Instant,
    scene: &'a SceneBuffers,
    frame: Frame,
    plan: WorkPlan,
    /// What the next submit takes: blocks times the camera samples of each.
    run: f64,
    /// The most camera samples in one dispatch.
    most_samples: u32,
    tally: Tally,
    pixels_before: u64,
    pixels_total: u64,
    longest_submit: Duration,
}

impl Job<'_> {
    /// Renders a band; where a bound is met, with fewer pixels an invocation, then with fewer samples a dispatch, then
    /// with more passes of fewer rays each.
    fn render_band(&mut self, rows: Range<u32>) -> Result<()> {
        let rays_before = self.tally.rays;
        loop {
            self.tally.rays = rays_before;
            self.frame = self.plan.applied_to(self.frame);
            self.renderer.begin_band(rows.clone())?;
            let flags = self.render_passes(&rows)?;
            if flags & STATUS_STACK_FULL != 0 {
                return Err(Error::Kernel("a traversal stack overflowed: the scene's hierarchy is too deep".into()));
            }
            if flags & STATUS_MIST_CROSSINGS != 0 {
                return Err(Error::Kernel(format!(
                    "a ray crosses more than {MIST_CROSSINGS} boundaries of mist; use fewer shapes of mist, for example \
                     one in place of many that overlap or touch"
                )));
            }
            if flags & STATUS_LOOP_BOUND == 0 {
                return Ok(());
            }
            if self.renderer.takes_work() {
                self.renderer.stop_taking_work();
                log::info!("a loop bound was met: rendering again with one pixel an invocation");
                continue;
            }
            if self.most_samples > 1 {
                self.most_samples = 1;
                log::info!("a loop bound was met: rendering again with one sample a dispatch");
                continue;
            }
            if !self.plan.can_halve() {
                return Err(Error::Kernel(
                    "one ray tree of this scene takes more loop turns than the driver runs, even with one ray a \
                     choice; lower --max-depth, update the driver (Mesa 23 or later), or use --device cpu"
                        .into(),
                ));
            }
            self.plan = plan(self.scene, self.plan.pass_count.saturating_mul(2));
            log::info!("a loop bound was met: rendering again with {} passes a sample", self.plan.pass_count);
        }
    }

    /// Runs every pass of every sample over the blocks of a band. Returns early with the flags when a bound is met.
    fn render_passes(&mut self, rows: &Range<u32>) -> Result<u32> {
        let band_rows = rows.end - rows.start;
        let order = BlockOrder::new(self.frame.image_size.x, band_rows);
        let (blocks, tile_stride) = (u64::from(order.places()), order.stride());
        let samples = self.options.samples.clone();
        let total = (samples.end - samples.start) as f64 * f64::from(self.frame.pass_count) * blocks as f64;
        let band_share = f64::from(band_rows) * f64::from(self.frame.image_size.x) / self.pixels_total as f64;
        let done_before = self.pixels_before as f64 / self.pixels_total as f64 * samples.len() as f64;
        let portions = self.renderer.portions().max(1);
        let takes_work = u32::from(self.renderer.takes_work());
        let mut dispatches = Vec::new();
        let mut sweep = Sweep { samples: samples.start..samples.start, pass: 0, block: 0 };
        let mut done = 0;
        while sweep.samples.start < samples.end {
            dispatches.clear();
            let run = (self.run as u64).max(1);
            let mut taken = 0;
            while sweep.samples.start < samples.end && taken < run && dispatches.len() < MAX_DISPATCHES {
                if sweep.samples.is_empty() {
                    sweep.samples.end = (sweep.samples.start + self.samples_at_once()).min(samples.end);
                }
                let sample_count = sweep.samples.len() as u64;
                let mut count = (blocks - sweep.block).min((run - taken).div_ceil(sample_count)).min(MAX_BLOCKS);
                if let Some(fixed) = self.options.blocks_per_dispatch {
                    count = count.min(u64::from(fixed.max(1)));
                }
                dispatches.push(Dispatch {
                    sample_index: sweep.samples.start,
                    sample_count: sample_count as u32,
                    pass_index: sweep.pass,
                    band_row: rows.start,
                    band_rows,
                    first_block: sweep.block as u32,
                    block_count: count as u32,
                    tile_stride,
                    portions,
                    takes_work,
                    canary_turns: CANARY_TURNS,
                });
                taken += count * sample_count;
                sweep.advance(count, blocks, self.frame.pass_count);
            }
            let submitted = Instant::now();
            let tally = self.renderer.submit(&self.frame, &dispatches)?;
            let took = submitted.elapsed();
            self.longest_submit = self.longest_submit.max(took);
            self.tally += tally;
            if tally.flags & (STATUS_LOOP_BOUND | STATUS_STACK_FULL | STATUS_MIST_CROSSINGS) != 0 {
                self.tally.flags = 0;
                return Ok(tally.flags);
            }
            let ratio = SUBMIT_TARGET.as_secs_f64() / took.as_secs_f64().max(1e-6);
            self.run = (taken as f64 * ratio.min(GROWTH)).max(1.0);
            done += taken;
            let progress = Progress {
                samples_done: done_before + done as f64 / total * samples.len() as f64 * band_share,
                samples_total: samples.len() as u32,
                rays: self.tally.total_rays(),
                elapsed: self.started.elapsed(),
            };
            if self.control.progress(&progress).is_break() {
                return Err(Error::Interrupted);
            }
        }
        Ok(0)
    }

    /// Camera samples of a pixel that the next dispatches take: several where a submit has blocks enough even so, to keep
    /// all processors busy and to be foreseen.
    fn samples_at_once(&self) -> u32 {
        if self.options.samples_per_dispatch.is_some() {
            return self.most_samples;
        }
        let fitting = self.run / f64::from(self.renderer.busy_blocks().max(FAIR_BLOCKS));
        (fitting as u32).clamp(1, self.most_samples)
    }
}

/// Where the work on a band stands: some samples at a time, each pass of them over all blocks.
struct Sweep {
    /// In hand; empty before it is known how many they are.
    samples: Range<u32>,
    pass: u32,
    /// The first that this pass has not taken yet, by its place.
    block: u64,
}

impl Sweep {
    /// Goes on behind `count` blocks of the pass: to the next pass behind the last block, and to the next samples behind
    /// the last pass.
    fn advance(&mut self, count: u64, blocks: u64, passes: u32) {
        self.block += count;
        if self.block >= blocks {
            self.block = 0;
            self.pass += 1;
        }
        if self.pass >= passes {
            self.pass = 0;
            self.samples.start = self.samples.end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_whole_blocks() {
        assert_eq!(band_rows(100, 50, 5000).ok(), Some(50));
        assert_eq!(band_rows(100, 50, 4999).ok(), Some(48));
        assert_eq!(band_rows(100, 50, 900).ok(), Some(8));
        assert!(band_rows(100, 50, 799).is_err());
    }
}
