//! What the user sees while a picture is rendered, and how they stop it.

use super::console::Console;
use super::interrupt;
use gpu_trace::render::{Progress, RenderControl};
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::time::Duration;

/// Steps of the bar; samples are too few to move it smoothly.
const STEPS: u64 = 1000;

/// A bar with samples done, speed and time left; stops rendering on an interrupt.
pub struct Bar(ProgressBar);

impl Bar {
    pub fn new(console: &Console) -> Self {
        let bar = console.bar();
        bar.set_length(STEPS);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}") {
            bar.set_style(style);
        }
        bar.set_message("preparing");
        Bar(bar)
    }
}

impl RenderControl for Bar {
    fn progress(&mut self, progress: &Progress) -> ControlFlow<()> {
        if interrupt::requested() {
            return ControlFlow::Break(());
        }
        if !self.0.is_hidden() {
            let share = share_done(progress);
            self.0.set_position((share * STEPS as f64) as u64);
            self.0.set_message(status_line(progress, share));
        }
        ControlFlow::Continue(())
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

fn share_done(progress: &Progress) -> f64 {
    (progress.samples_done / f64::from(progress.samples_total.max(1))).clamp(0.0, 1.0)
}

fn status_line(progress: &Progress, share: f64) -> String {
    let seconds = progress.elapsed.as_secs_f64();
    let speed = if seconds > 0.0 { progress.rays as f64 / seconds / 1e6 } else { 0.0 };
    let left = if share > 0.0 { human_time(seconds * (1.0 - share) / share) } else { "?".to_owned() };
    format!("{:.1}/{} samples  {speed:.2} Mray/s  {left} left", progress.samples_done, progress.samples_total)
}

fn human_time(seconds: f64) -> String {
    // A first estimate can be absurdly large; Duration takes it only in range.
    let duration = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    indicatif::HumanDuration(duration).to_string()
}
