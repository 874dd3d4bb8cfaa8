//! The batch: scripts, renderer and encoder work at the same time on frames that follow each other.
//!
//! ```text
//! jobs threads: script, flatten ──▶ this thread: render ──▶ one thread: encode, write, report
//! frames n+1 … n+jobs               frame n                  frame n-1
//! ```
//! Frames are handed on in their order, whichever is ready first: thread i of k prepares the frames i, i+k, i+2k, … and
//! waits with each until the renderer takes it, so that no more than `jobs` prepared scenes wait at any time. Errors
//! travel the same way, which is why they too come in the order of the frames.

use crate::flatten::{FlattenCache, SceneBuffers, flatten_with};
use crate::render::Rendered;
use crate::scene::Scene;
use crate::script::{ScriptOptions, run_scene};
use crate::{Error, Result};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

/// Finished pictures that may wait for the encoder.
const WAITING_PICTURES: usize = 1;

/// The stack of a thread that runs scripts: that of a main thread.
const SCRIPT_STACK: usize = 8 << 20;

/// How often the renderer, while it waits for a scene, asks whether to go on.
const POLL: Duration = Duration::from_millis(20);

/// Which frames to make of which script.
pub struct Batch<'a> {
    pub script: &'a Path,
    pub frames: &'a [u32],
    /// For every frame, but for its number. The files that the scripts read are kept in its library.
    pub options: ScriptOptions,
    /// Threads that prepare frames, each with one frame in hand; at least 1.
    pub jobs: usize,
    /// Whether the frames after a failed one are still made.
    pub keep_going: bool,
    pub cache: &'a FlattenCache,
}

/// Changes a scene that the script asks for, or refuses it, before anything is spent on it. Gets the frame, the number
/// of the picture within the frame, from 0, and the scene.
pub type Preparation<'a> = &'a (dyn Fn(u32, u32, &mut Scene) -> Result<()> + Sync);

/// The calling thread's part.
pub trait Painter {
    /// Renders one picture of a frame.
    ///
    /// # Errors
    /// Fails the frame; [`Error::Interrupted`] ends the batch.
    fn paint(&mut self, frame: u32, scene: &Scene, buffers: Arc<SceneBuffers>) -> Result<Rendered>;

    /// Whether the batch is to end here. Asked before each frame, and while no scene is ready; `in_frame` says whether
    /// pictures of a frame have been rendered and others may follow.
    fn is_stopped(&self, in_frame: bool) -> bool;
}

/// What becomes of the pictures, on a thread of its own.
pub trait BatchOutput: Send {
    /// # Errors
    /// Fails the frame.
    fn picture(&mut self, frame: u32, scene: &Scene, rendered: Rendered) -> Result<()>;

    /// All pictures of the frame are there, or it failed.
    fn frame_ended(&mut self, frame: u32, outcome: &Result<()>);
}

/// What a script thread hands to the renderer.
enum Prepared {
    Picture(Box<(Scene, Arc<SceneBuffers>)>),
    End(Result<()>),
}

/// What the renderer hands to the encoder.
enum Painted {
    Picture(Box<(Scene, Rendered)>),
    End(Result<()>),
}

/// Makes the frames of a batch, each a run of its script.
///
/// # Errors
/// [`Error::Interrupted`] where the painter stopped it; the error of the first frame that failed, unless the batch
/// keeps going: then frames fail in [`BatchOutput::frame_ended`] alone. A script that asks for no picture fails its
/// frame.
pub fn run_batch(
    batch: &Batch,
    prepare: Preparation,
    painter: &mut dyn Painter,
    output: &mut dyn BatchOutput,
) -> Result<()> {
    let jobs = batch.jobs.clamp(1, batch.frames.len().max(1));
    thread::scope(|scope| {
        let mut scenes = Vec::with_capacity(jobs);
        for job in 0..jobs {
            let (sender, receiver) = sync_channel(0);
            scenes.push(receiver);
            let frames = batch.frames.iter().skip(job).step_by(jobs);
            thread::Builder::new()
                .name(format!("scene {job}"))
                .stack_size(SCRIPT_STACK)
                .spawn_scoped(scope, move || prepare_frames(batch, frames, prepare, &sender))
                .map_err(thread_error)?;
        }
        let (sender, receiver) = sync_channel(WAITING_PICTURES);
        let encoder = thread::Builder::new()
            .name("encoder".to_owned())
            .spawn_scoped(scope, move || write_frames(batch.frames, batch.keep_going, &receiver, output))
            .map_err(thread_error)?;
        let painted = paint_frames(batch, painter, &scenes, &sender);
        // The scripts end at their next step, and find nobody to hand a scene to.
        batch.options.library.stop();
        drop((scenes, sender));
        let written = encoder.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        // An error of the encoder is the cause where both report one.
        written.and(painted)
    })
}

fn thread_error(source: std::io::Error) -> Error {
    Error::Scene(format!("cannot start a thread: {source}"))
}

/// Runs the script for each frame, until nobody takes its scenes any more.
fn prepare_frames<'a>(
    batch: &Batch,
    frames: impl Iterator<Item = &'a u32>,
    prepare: Preparation,
    out: &SyncSender<Prepared>,
) {
    for &frame in frames {
        let options = ScriptOptions { frame, ..batch.options.clone() };
        let mut pictures = 0;
        let outcome = run_scene(batch.script, &options, &mut |mut scene| {
            prepare(frame, pictures, &mut scene)?;
            pictures += 1;
            let buffers = Arc::new(flatten_with(&scene, batch.cache)?);
            out.send(Prepared::Picture(Box::new((scene, buffers)))).map_err(|_| Error::Interrupted)
        });
        let outcome = outcome.and_then(|summary| match summary.pictures {
            0 => Err(Error::Scene(format!(
                "{}: the script ended without a call of gr.render; no picture was written",
                batch.script.display()
            ))),
            _ => Ok(()),
        });
        if out.send(Prepared::End(outcome)).is_err() {
            return;
        }
    }
}

/// Renders frame after frame. An error is the painter's, or says that the encoder has gone.
fn paint_frames(
    batch: &Batch,
    painter: &mut dyn Painter,
    scenes: &[Receiver<Prepared>],
    out: &SyncSender<Painted>,
) -> Result<()> {
    for (&frame, scenes) in batch.frames.iter().zip(scenes.iter().cycle()) {
        if painter.is_stopped(false) {
            return Err(Error::Interrupted);
        }
        let outcome = paint_frame(frame, batch.keep_going, painter, scenes, out);
        if matches!(outcome, Err(Error::Interrupted)) {
            return outcome;
        }
        let failed = outcome.is_err();
        let gone = out.send(Painted::End(outcome)).is_err();
        // The encoder tells why.
        if gone || (failed && !batch.keep_going) {
            return Ok(());
        }
    }
    Ok(())
}

/// Renders the pictures of a frame as its script asks for them. After a picture that failed the others are passed over.
fn paint_frame(
    frame: u32,
    keep_going: bool,
    painter: &mut dyn Painter,
    scenes: &Receiver<Prepared>,
    out: &SyncSender<Painted>,
) -> Result<()> {
    let mut begun = false;
    let mut failure = None;
    loop {
        match scenes.recv_timeout(POLL) {
            Ok(Prepared::Picture(picture)) if failure.is_none() => {
                begun = true;
                let (scene, buffers) = *picture;
                match painter.paint(frame, &scene, buffers) {
                    Ok(rendered) => {
                        if out.send(Painted::Picture(Box::new((scene, rendered)))).is_err() {
                            // The encoder tells why.
                            return Err(Error::Interrupted);
                        }
                    }
                    Err(error) if !keep_going || matches!(error, Error::Interrupted) => return Err(error),
                    Err(error) => failure = Some(error),
                }
            }
            Ok(Prepared::Picture(_)) => {}
            Ok(Prepared::End(outcome)) => return failure.map_or(outcome, Err),
            Err(RecvTimeoutError::Timeout) if painter.is_stopped(begun) => return Err(Error::Interrupted),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Error::Scene(format!("frame {frame}: the thread of its script has ended early")));
            }
        }
    }
}

/// Hands the pictures to the output, and tells how each frame ended.
fn write_frames(
    frames: &[u32],
    keep_going: bool,
    painted: &Receiver<Painted>,
    output: &mut dyn BatchOutput,
) -> Result<()> {
    for &frame in frames {
        let mut outcome = Ok(());
        loop {
            match painted.recv() {
                Ok(Painted::Picture(picture)) => {
                    let (scene, rendered) = *picture;
                    if outcome.is_ok() {
                        outcome = output.picture(frame, &scene, rendered);
                    }
                }
                Ok(Painted::End(end)) => {
                    outcome = outcome.and(end);
                    break;
                }
                // Stopped in the middle of a frame, or before one.
                Err(_) => return outcome,
            }
            if outcome.is_err() && !keep_going {
                break;
            }
        }
        output.frame_ended(frame, &outcome);
        if !keep_going {
            outcome?;
        }
    }
    Ok(())
}
