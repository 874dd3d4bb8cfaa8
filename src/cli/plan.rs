//! What the arguments of a rendering mean together: which frames, and where they go.

use super::args::{Arguments, RenderArguments};
use clap::CommandFactory;
use clap::error::ErrorKind;
use gpu_trace::animation::{FramePattern, is_whole_png};
use gpu_trace::film::OutputFormat;
use gpu_trace::film::clip::ClipFormat;
use std::path::{Path, PathBuf};

/// Where pictures go.
pub enum Destination {
    /// Where each `gr.render` says.
    Scene,
    /// One picture a run.
    File(PathBuf),
    /// One picture a frame.
    Numbered(FramePattern),
    /// One picture a frame.
    Clip { path: PathBuf, format: ClipFormat },
}

pub struct Plan {
    /// Those to render, in order.
    pub frames: Vec<u32>,
    /// Those that are there already.
    pub skipped: usize,
    /// What `gr.frames()` returns.
    pub total_frames: u32,
    pub destination: Destination,
    /// Whether --frames was given.
    pub is_batch: bool,
}

impl Plan {
    /// # Errors
    /// Usage errors, for arguments that do not go together.
    pub fn new(arguments: &RenderArguments) -> Result<Plan, clap::Error> {
        let count = arguments.frames.map_or(1, |range| range.count());
        let destination = destination(arguments, count).map_err(usage)?;
        let all = arguments.frames.map_or_else(|| vec![arguments.frame.unwrap_or(0)], |range| range.frames().collect());
        let total_frames = arguments.total_frames.unwrap_or(count);
        let mut plan =
            Plan { frames: all, skipped: 0, total_frames, destination, is_batch: arguments.frames.is_some() };
        let numbered = matches!(plan.destination, Destination::Numbered(_));
        let clip = matches!(plan.destination, Destination::Clip { .. });
        for (refused, option) in
            [(arguments.resume && !numbered, "--resume"), (arguments.keep_going && clip, "--keep-going")]
        {
            if refused {
                return Err(usage(format!(
                    "{option} takes numbered frames, as of -o frame-%04d.png; a clip is whole or not there"
                )));
            }
        }
        if let (true, Destination::Numbered(pattern)) = (arguments.resume, &plan.destination) {
            let before = plan.frames.len();
            plan.frames.retain(|frame| !is_whole_png(&pattern.path(*frame)));
            plan.skipped = before - plan.frames.len();
        }
        Ok(plan)
    }

    /// Whether an interrupt lets the frame in hand be finished: what came before it is there to stay.
    pub fn finishes_frames(&self) -> bool {
        self.is_batch && !self.is_clip_file()
    }

    /// Whether the frames go into one file, which is there when all of them are.
    pub fn is_clip_file(&self) -> bool {
        matches!(&self.destination, Destination::Clip { format, .. } if *format != ClipFormat::Y4m)
    }
}

fn destination(arguments: &RenderArguments, count: u32) -> Result<Destination, String> {
    let Some(path) = &arguments.output else { return Ok(Destination::Scene) };
    let shown = path.display();
    let clip = ClipFormat::from_path(path);
    if arguments.frames.is_none() {
        return match (OutputFormat::from_path(path), clip) {
            (Ok(_), _) => Ok(Destination::File(path.clone())),
            (Err(_), Some(_)) => Err(format!(
                "-o '{shown}': {}; a clip takes --frames, such as --frames 1..100",
                OutputFormat::expected()
            )),
            // Not the error's own text, which says the path in another way.
            (Err(_), None) => Err(format!("-o '{shown}': {}", OutputFormat::expected())),
        };
    }
    if let Some(format) = clip {
        if format == ClipFormat::Y4m && arguments.json.as_deref() == Some(Path::new("-")) {
            return Err("-o - and --json - cannot both have standard output".to_owned());
        }
        return Ok(Destination::Clip { path: path.clone(), format });
    }
    if OutputFormat::from_path(path).is_err() {
        let clips: Vec<String> = ClipFormat::FILES.iter().map(|format| format!(".{}", format.extension())).collect();
        return Err(format!(
            "-o '{shown}': {}, of a clip in {}, or be '-'",
            OutputFormat::expected(),
            clips.join(" or ")
        ));
    }
    match path.to_str() {
        Some(text) if text.contains('%') => {
            text.parse().map(Destination::Numbered).map_err(|message| format!("-o '{shown}': {message}"))
        }
        _ if count == 1 => Ok(Destination::File(path.clone())),
        _ => Err(format!("-o '{shown}' names one file for {count} frames; put %04d where the frame's number goes")),
    }
}

fn usage(message: String) -> clap::Error {
    Arguments::command().error(ErrorKind::ValueValidation, message)
}
