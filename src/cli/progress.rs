//! What the user sees while pictures are rendered, and how they stop it.

use super::console::Console;
use super::interrupt;
use gpu_trace::render::{Progress, RenderControl};
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Steps of the bar; samples are too few to move it smoothly.
const STEPS: u64 = 1000;

/// A bar over all frames, with samples done, speed and time left.
pub struct Bar {
    bar: ProgressBar,
    /// Whether an interrupt ends the picture in hand.
    stops: bool,
    frames: usize,
    /// The place of the frame in hand among the frames, from 0, and its number.
    place: usize,
    frame: u32,
    started: Instant,
}

impl Bar {
    pub fn new(console: &Console, frames: usize, stops: bool) -> Self {
        let bar = console.bar();
        bar.set_length(STEPS);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}") {
            bar.set_style(style);
        }
        Bar { bar, stops, frames: frames.max(1), place: 0, frame: 0, started: Instant::now() }
    }

    /// A picture of the frame at this place is next.
    pub fn begin(&mut self, place: usize, frame: u32) {
        (self.place, self.frame) = (place, frame);
        if self.frames == 1 {
            self.bar.set_message("preparing");
        }
    }

    fn status_line(&self, progress: &Progress, share: f64) -> String {
        let seconds = progress.elapsed.as_secs_f64();
        let speed = if seconds > 0.0 { progress.rays as f64 / seconds / 1e6 } else { 0.0 };
        let samples = format!("{:.1}/{} samples  {speed:.2} Mray/s", progress.samples_done, progress.samples_total);
        if self.frames == 1 {
            return format!("{samples}  {} left", time_left(seconds, share));
        }
        let left = time_left(self.started.elapsed().as_secs_f64(), share);
        format!("frame {} ({}/{})  {samples}  {left} left", self.frame, self.place + 1, self.frames)
    }
}

impl RenderControl for Bar {
    fn progress(&mut self, progress: &Progress) -> ControlFlow<()> {
        if self.stops && interrupt::requested() {
            return ControlFlow::Break(());
        }
        if !self.bar.is_hidden() {
            let share = (self.place as f64 + share_done(progress)) / self.frames as f64;
            self.bar.set_position((share * STEPS as f64) as u64);
            self.bar.set_message(self.status_line(progress, share));
        }
        ControlFlow::Continue(())
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn share_done(progress: &Progress) -> f64 {
    (progress.samples_done / f64::from(progress.samples_total.max(1))).clamp(0.0, 1.0)
}

/// Time for the rest, where `share` of the whole has taken so long.
fn time_left(seconds: f64, share: f64) -> String {
    if share <= 0.0 {
        return "?".to_owned();
    }
    // A first estimate can be absurdly large; Duration takes it only in range.
    let left = Duration::try_from_secs_f64(seconds * (1.0 - share) / share).unwrap_or(Duration::MAX);
    indicatif::HumanDuration(left).to_string()
}
