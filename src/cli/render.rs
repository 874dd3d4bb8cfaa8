//! `gpu-trace SCENE.lua`: runs the script for each frame, and renders and writes the pictures that it asks for. A plain
//! run is a batch of one frame.

use super::args::{RenderArguments, Size};
use super::console::Console;
use super::delivery::Delivery;
use super::interrupt;
use super::plan::{Destination, Plan};
use super::progress::Bar;
use super::report::{BatchReport, Reuse};
use super::scene_figures::SceneFigures;
use gpu_trace::animation::{Batch, Painter, run_batch, seed_of_frame};
use gpu_trace::device::{DeviceInfo, open_renderer};
use gpu_trace::film::{Film, OutputFormat, check_writable};
use gpu_trace::flatten::{FlattenCache, SceneBuffers};
use gpu_trace::render::{RenderOptions, Rendered, render};
use gpu_trace::renderer::{PrepareCounts, Renderer};
use gpu_trace::scene::Scene;
use gpu_trace::script::{Library, ScriptOptions};
use gpu_trace::{Error, Result};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// # Errors
/// Whatever keeps a picture from being written; [`Error::Scene`] where the script asks for none.
pub fn run(arguments: &RenderArguments, plan: &Plan, console: &Console) -> Result<()> {
    interrupt::install();
    let started = Instant::now();
    // What can be found wrong without the scene is reported before anything is spent on it.
    check_destination(plan)?;
    let device = OnceLock::new();
    let mut delivery = Delivery::new(arguments, plan, console, &device)?;

    let defaults = ScriptOptions::default();
    // A frame may be prepared while those of the other jobs are, and still use what the one before it did.
    let jobs = u64::from(arguments.jobs);
    let library = Arc::new(Library::new(jobs + 1));
    // What a plain run builds it uses once, and memory is better spent on the scene.
    let cache = if plan.is_batch { FlattenCache::new(jobs + 1) } else { FlattenCache::none() };
    let batch = Batch {
        script: &arguments.scene,
        frames: &plan.frames,
        options: ScriptOptions {
            frames: plan.total_frames,
            rate: arguments.fps,
            seed: arguments.seed.unwrap_or(defaults.seed),
            conventions: arguments.conventions.unwrap_or_default(),
            library: Arc::clone(&library),
            ..defaults
        },
        jobs: usize::from(arguments.jobs),
        keep_going: arguments.keep_going,
        cache: &cache,
    };
    let mut studio =
        Studio { arguments, plan, console, device: &device, renderer: None, bar: None, written: HashMap::new() };
    let prepare = |frame, picture, scene: &mut Scene| prepare(arguments, plan, frame, picture, scene);
    let mut outcome = run_batch(&batch, &prepare, &mut studio, &mut delivery);
    studio.bar = None;
    if outcome.is_ok()
        && let Some(clip) = delivery.clip.take()
    {
        outcome = clip.finish();
    }
    let prepared = studio.renderer.as_ref().map_or_else(PrepareCounts::default, |renderer| renderer.prepare_counts());
    let reuse = Reuse::new(library.counts(), cache.counts(), prepared);
    if plan.is_batch {
        log::info!("{reuse}");
    }
    conclude(arguments, plan, delivery, outcome, &reuse, started)
}

fn check_destination(plan: &Plan) -> Result<()> {
    let action = "write the picture";
    match (&plan.destination, plan.frames.first()) {
        (Destination::File(path), _) => check_writable(action, path),
        (Destination::Numbered(pattern), Some(&first)) => check_writable(action, &pattern.path(first)),
        _ => Ok(()),
    }
}

/// What stands on the command line replaces what the scene says.
fn prepare(arguments: &RenderArguments, plan: &Plan, frame: u32, picture: u32, scene: &mut Scene) -> Result<()> {
    if picture > 0 && !matches!(plan.destination, Destination::Scene) {
        return Err(Error::Scene(
            match plan.destination {
                Destination::Clip { .. } => {
                    "a clip takes one picture a frame, but the script renders another; leave -o away, and each goes \
                     where its gr.render says"
                }
                _ => {
                    "-o names one picture, but the script renders another; leave -o away, and each goes where its \
                     gr.render says"
                }
            }
            .to_owned(),
        ));
    }
    if let Some(Size(size)) = arguments.size {
        scene.size = size;
    }
    let sampling = &mut scene.sampling;
    sampling.camera = arguments.samples.unwrap_or(sampling.camera);
    sampling.seed = arguments.seed.unwrap_or(sampling.seed);
    if arguments.seed_per_frame {
        sampling.seed = seed_of_frame(sampling.seed, frame);
    }
    sampling.max_depth = arguments.max_depth.unwrap_or(sampling.max_depth);
    scene.background.transparent |= arguments.transparent;
    match &plan.destination {
        Destination::Scene => {}
        Destination::File(path) | Destination::Clip { path, .. } => scene.output = path.clone(),
        Destination::Numbered(pattern) => scene.output = pattern.path(frame),
    }
    if !matches!(plan.destination, Destination::Clip { .. }) {
        OutputFormat::from_path(&scene.output)?;
        check_writable("write the picture", &scene.output)?;
    }
    Film::check_size(scene.size[0], scene.size[1])
}

/// Renders with one device for all pictures.
struct Studio<'a> {
    arguments: &'a RenderArguments,
    plan: &'a Plan,
    console: &'a Console,
    device: &'a OnceLock<DeviceInfo>,
    /// Opened for the first picture, and kept.
    renderer: Option<Box<dyn Renderer>>,
    bar: Option<Bar>,
    /// The frame that wrote each file.
    written: HashMap<PathBuf, u32>,
}

impl Studio<'_> {
    /// Where scenes name the files, frames must not overwrite each other's.
    fn check_overwriting(&mut self, frame: u32, scene: &Scene) -> Result<()> {
        if !matches!(self.plan.destination, Destination::Scene) || self.plan.frames.len() < 2 {
            return Ok(());
        }
        let path = std::path::absolute(&scene.output).unwrap_or_else(|_| scene.output.clone());
        match self.written.insert(path, frame) {
            Some(other) if other != frame => Err(Error::Scene(format!(
                "it would overwrite '{}' of frame {other}; put gr.frame() into the name, or give -o NAME-%04d.png",
                scene.output.display()
            ))),
            _ => Ok(()),
        }
    }
}

impl Painter for Studio<'_> {
    fn paint(&mut self, frame: u32, scene: &Scene, buffers: Arc<SceneBuffers>) -> Result<Rendered> {
        self.check_overwriting(frame, scene)?;
        log::info!("{}", SceneFigures::from(&buffers.statistics));
        let renderer = match &mut self.renderer {
            Some(renderer) => renderer,
            none => {
                let (renderer, info) = open_renderer(&self.arguments.device, self.arguments.checked)?;
                self.console.say(&format!("rendering on {info}: {}", info.why));
                self.device.get_or_init(|| info);
                none.insert(renderer)
            }
        };
        let frames = self.plan.frames.len();
        let bar = self.bar.get_or_insert_with(|| Bar::new(self.console, frames, !self.plan.finishes_frames()));
        bar.begin(self.plan.frames.binary_search(&frame).unwrap_or(0), frame);
        let options = RenderOptions::whole(&buffers);
        render(buffers, renderer.as_mut(), &options, bar)
    }

    fn is_stopped(&self, in_frame: bool) -> bool {
        interrupt::requested() && !(in_frame && self.plan.finishes_frames())
    }
}

/// Success only where pictures were asked for and every one was written.
fn conclude(
    arguments: &RenderArguments,
    plan: &Plan,
    mut delivery: Delivery,
    outcome: Result<()>,
    reuse: &Reuse,
    started: Instant,
) -> Result<()> {
    let (console, seconds) = (delivery.console, started.elapsed().as_secs_f64());
    if outcome.is_err() && plan.is_clip_file() {
        // They went with the clip.
        delivery.frames = 0;
    }
    let reported = report_batch(plan, &mut delivery, seconds, reuse);
    match outcome {
        Ok(()) => {}
        Err(Error::Interrupted) => {
            say_interrupted(plan, &delivery);
            return Err(Error::Interrupted);
        }
        Err(error) => {
            let error = explain_subcommand(error, arguments);
            return Err(match (plan.is_batch, delivery.failures.last()) {
                (true, Some(failure)) => Error::Scene(format!("frame {}: {error}", failure.frame)),
                _ => error,
            });
        }
    }
    reported?;
    let skipped = if plan.skipped > 0 { format!(", and {} were there", plan.skipped) } else { String::new() };
    if plan.is_batch {
        console.say(&format!(
            "{} frames in {seconds:.2} s, {:.2} s of it rendering{skipped}",
            delivery.frames, delivery.render_seconds
        ));
    }
    if !delivery.failures.is_empty() {
        let frames: Vec<String> = delivery.failures.iter().map(|failure| failure.frame.to_string()).collect();
        return Err(Error::Scene(format!("frames that failed: {}", frames.join(", "))));
    }
    Ok(())
}

/// Completes the report: of a batch by the object about the whole.
fn report_batch(plan: &Plan, delivery: &mut Delivery, seconds: f64, reuse: &Reuse) -> Result<()> {
    let Some(mut writer) = delivery.report.take() else { return Ok(()) };
    if plan.is_batch {
        let sums = (delivery.render_seconds, delivery.warmup_seconds);
        writer.write(&BatchReport::new(plan, &delivery.failures, delivery.frames, seconds, sums, reuse))?;
    }
    writer.finish()
}

fn say_interrupted(plan: &Plan, delivery: &Delivery) {
    let message = match (&plan.destination, delivery.pictures) {
        (_, 0) => Error::Interrupted.to_string(),
        _ if plan.is_clip_file() => Error::Interrupted.to_string(),
        (Destination::Numbered(_), _) => {
            format!("interrupted; frames written: {}; run again with --resume for the others", delivery.frames)
        }
        (_, pictures) => format!("interrupted; pictures written: {pictures}"),
    };
    delivery.console.error(&message);
}

/// A subcommand that follows an option is taken for a scene, whose file then is missing.
fn explain_subcommand(error: Error, arguments: &RenderArguments) -> Error {
    match (&error, arguments.scene.to_str()) {
        (Error::File { .. }, Some(name @ ("doctor" | "compare" | "help"))) => {
            Error::Scene(format!("{error}; the subcommand '{name}' must come first"))
        }
        _ => error,
    }
}
