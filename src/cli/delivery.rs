//! What becomes of rendered pictures: they are written, reported, and counted.

use super::args::RenderArguments;
use super::console::Console;
use super::plan::{Destination, Plan};
use super::report::{DeviceReport, FailureReport, Rays, Report, ReportWriter};
use gpu_trace::animation::BatchOutput;
use gpu_trace::device::DeviceInfo;
use gpu_trace::film::OutputFormat;
use gpu_trace::film::clip::ClipWriter;
use gpu_trace::render::Rendered;
use gpu_trace::scene::Scene;
use gpu_trace::{Error, Result};
use std::sync::OnceLock;

/// The pictures of one rendering or batch.
pub struct Delivery<'a> {
    pub arguments: &'a RenderArguments,
    pub console: &'a Console,
    pub is_batch: bool,
    /// Set when the first picture is rendered.
    pub device: &'a OnceLock<DeviceInfo>,
    pub clip: Option<ClipWriter>,
    pub report: Option<ReportWriter>,
    pub pictures: u32,
    pub frames: u32,
    pub failures: Vec<FailureReport>,
    /// Sums over the pictures, seconds.
    pub render_seconds: f64,
    pub warmup_seconds: f64,
}

impl<'a> Delivery<'a> {
    /// # Errors
    /// What can be found wrong with the places before anything is spent on the pictures.
    pub fn new(
        arguments: &'a RenderArguments,
        plan: &Plan,
        console: &'a Console,
        device: &'a OnceLock<DeviceInfo>,
    ) -> Result<Self> {
        let clip = match &plan.destination {
            // All frames are in a clip: none is ever skipped.
            Destination::Clip { path, format } => {
                Some(ClipWriter::new(path, *format, plan.frames.len() as u32, arguments.fps)?)
            }
            _ => None,
        };
        Ok(Delivery {
            arguments,
            console,
            is_batch: plan.is_batch,
            device,
            clip,
            report: arguments.json.as_deref().map(ReportWriter::open).transpose()?,
            pictures: 0,
            frames: 0,
            failures: Vec::new(),
            render_seconds: 0.0,
            warmup_seconds: 0.0,
        })
    }
}

impl BatchOutput for Delivery<'_> {
    fn picture(&mut self, frame: u32, scene: &Scene, rendered: Rendered) -> Result<()> {
        let transparent = scene.background.transparent;
        match &mut self.clip {
            Some(clip) => clip.add(&rendered.film, scene.transfer, transparent)?,
            None => {
                let format = OutputFormat::from_path(&scene.output)?;
                format.write(&rendered.film, &scene.output, scene.transfer, transparent)?;
            }
        }
        self.pictures += 1;
        self.render_seconds += rendered.seconds;
        self.warmup_seconds += rendered.warmup_seconds;
        let info = self.device.get().ok_or_else(|| Error::Device("a picture came from no device".to_owned()))?;
        let report = report(self.arguments, frame, info, scene, &rendered);
        self.console.say(&summary(&report, self.is_batch));
        match &mut self.report {
            Some(writer) => writer.write(&report),
            None => Ok(()),
        }
    }

    fn frame_ended(&mut self, frame: u32, outcome: &Result<()>) {
        match outcome {
            Ok(()) => self.frames += 1,
            Err(error) => {
                if self.arguments.keep_going {
                    self.console.error(&format!("frame {frame}: {error}"));
                }
                self.failures.push(FailureReport { frame, error: error.to_string() });
            }
        }
    }
}

fn report<'a>(
    arguments: &RenderArguments,
    frame: u32,
    info: &'a DeviceInfo,
    scene: &Scene,
    rendered: &Rendered,
) -> Report<'a> {
    let rays = Rays::from(&rendered.tally);
    let speed = if rendered.seconds > 0.0 { rays.total as f64 / rendered.seconds / 1e6 } else { 0.0 };
    Report {
        schema: Report::SCHEMA,
        scene: arguments.scene.display().to_string(),
        frame,
        output: scene.output.display().to_string(),
        device: DeviceReport::from(info),
        width: scene.size[0],
        height: scene.size[1],
        samples: scene.sampling.camera,
        max_depth: scene.sampling.max_depth,
        seed: scene.sampling.seed,
        transparent: scene.background.transparent,
        rays,
        seconds: rendered.seconds,
        warmup_seconds: rendered.warmup_seconds,
        mrays_per_second: speed,
        passes: rendered.passes,
        longest_submit_seconds: rendered.longest_submit_seconds,
    }
}

fn summary(report: &Report, is_batch: bool) -> String {
    let frame = if is_batch { format!("frame {}: ", report.frame) } else { String::new() };
    format!(
        "{frame}wrote {}: {}x{}, {} {}, {:.2} s and {:.2} s to prepare, {:.2} Mray/s",
        report.output,
        report.width,
        report.height,
        report.samples,
        if report.samples == 1 { "sample" } else { "samples" },
        report.seconds,
        report.warmup_seconds,
        report.mrays_per_second
    )
}
