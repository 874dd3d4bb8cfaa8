//! `gpu-trace SCENE.lua`: runs the script, and renders and writes each picture as it asks for it.

use super::args::{RenderArguments, Size};
use super::console::Console;
use super::interrupt;
use super::progress::Bar;
use super::report::{DeviceReport, Rays, Report, ReportWriter};
use super::scene_figures::SceneFigures;
use gpu_trace::device::{DeviceInfo, open_renderer};
use gpu_trace::film::{Film, OutputFormat, check_writable};
use gpu_trace::flatten::flatten;
use gpu_trace::render::{RenderOptions, Rendered, render};
use gpu_trace::renderer::Renderer;
use gpu_trace::scene::Scene;
use gpu_trace::script::{ScriptOptions, run_scene};
use gpu_trace::{Error, Result};
use std::sync::Arc;
use std::time::Instant;

/// # Errors
/// Whatever keeps a picture from being written; [`Error::Scene`] where the script asks for none.
pub fn run(arguments: &RenderArguments, console: &Console) -> Result<()> {
    interrupt::install();
    // What can be found wrong without the scene is reported before anything is spent on it.
    if let Some(path) = &arguments.output {
        check_writable("write the picture", path)?;
    }
    let report = arguments.json.as_deref().map(ReportWriter::open).transpose()?;

    let mut session = Session { arguments, console, device: None, report, written: 0, script_start: Instant::now() };
    let defaults = ScriptOptions::default();
    let options = ScriptOptions {
        frame: arguments.frame,
        seed: arguments.seed.unwrap_or(defaults.seed),
        conventions: arguments.conventions.unwrap_or_default(),
        ..defaults
    };
    let outcome = run_scene(&arguments.scene, &options, &mut |scene| session.picture(scene));
    session.conclude(outcome.map(drop).map_err(|error| explain_subcommand(error, arguments)))
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

/// The pictures of one script.
struct Session<'a> {
    arguments: &'a RenderArguments,
    console: &'a Console,
    /// Opened for the first picture, and kept.
    device: Option<(Box<dyn Renderer>, DeviceInfo)>,
    report: Option<ReportWriter>,
    written: u32,
    /// When the script began, or went on after a picture.
    script_start: Instant,
}

impl Session<'_> {
    /// Renders one picture and writes it.
    fn picture(&mut self, mut scene: Scene) -> Result<()> {
        let script_seconds = self.script_start.elapsed().as_secs_f64();
        self.apply_arguments(&mut scene)?;
        let format = OutputFormat::from_path(&scene.output)?;
        check_writable("write the picture", &scene.output)?;
        Film::check_size(scene.size[0], scene.size[1])?;

        let _deferral = interrupt::defer();
        if interrupt::requested() {
            return Err(Error::Interrupted);
        }
        let mut buffers = flatten(&scene)?;
        buffers.statistics.script_seconds = script_seconds;
        log::info!("{}", SceneFigures::from(&buffers.statistics));
        let buffers = Arc::new(buffers);
        let (renderer, info) = match &mut self.device {
            Some((renderer, info)) => (renderer, &*info),
            device @ None => {
                let (renderer, info) = open_renderer(&self.arguments.device, self.arguments.checked)?;
                self.console.say(&format!("rendering on {info}: {}", info.why));
                let (renderer, info) = device.insert((renderer, info));
                (renderer, &*info)
            }
        };
        let options = RenderOptions::whole(&buffers);
        let mut bar = Bar::new(self.console);
        let rendered = render(buffers, renderer.as_mut(), &options, &mut bar)?;
        drop(bar);

        format.write(&rendered.film, &scene.output, scene.transfer, scene.background.transparent)?;
        self.written += 1;
        let report = report(self.arguments, info, &scene, &rendered);
        self.console.say(&summary(&report));
        if let Some(writer) = &mut self.report {
            writer.write(&report)?;
        }
        self.script_start = Instant::now();
        Ok(())
    }

    /// What stands on the command line replaces what the scene says.
    fn apply_arguments(&self, scene: &mut Scene) -> Result<()> {
        let arguments = self.arguments;
        if let Some(path) = &arguments.output {
            if self.written > 0 {
                return Err(Error::Scene(
                    "-o names one picture, but the script renders another; leave -o away, and each goes where its \
                     gr.render says"
                        .to_owned(),
                ));
            }
            scene.output = path.clone();
        }
        if let Some(Size(size)) = arguments.size {
            scene.size = size;
        }
        let sampling = &mut scene.sampling;
        sampling.camera = arguments.samples.unwrap_or(sampling.camera);
        sampling.seed = arguments.seed.unwrap_or(sampling.seed);
        sampling.max_depth = arguments.max_depth.unwrap_or(sampling.max_depth);
        scene.background.transparent |= arguments.transparent;
        Ok(())
    }

    /// Success only where pictures were asked for and every one was written.
    fn conclude(self, outcome: Result<()>) -> Result<()> {
        if interrupt::requested() {
            if self.written > 0 {
                self.console.say(&format!("pictures written before the interrupt: {}", self.written));
            }
            return Err(Error::Interrupted);
        }
        outcome?;
        if self.written == 0 {
            return Err(Error::Scene(format!(
                "{}: the script ended without a call of gr.render; no picture was written",
                self.arguments.scene.display()
            )));
        }
        Ok(())
    }
}

fn report<'a>(arguments: &RenderArguments, info: &'a DeviceInfo, scene: &Scene, rendered: &Rendered) -> Report<'a> {
    let rays = Rays::from(&rendered.tally);
    let speed = if rendered.seconds > 0.0 { rays.total as f64 / rendered.seconds / 1e6 } else { 0.0 };
    Report {
        schema: Report::SCHEMA,
        scene: arguments.scene.display().to_string(),
        frame: arguments.frame,
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
        figures: SceneFigures::from(&rendered.statistics),
    }
}

fn summary(report: &Report) -> String {
    format!(
        "wrote {}: {}x{}, {} {}, {:.2} s and {:.2} s to prepare, {:.2} Mray/s",
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
