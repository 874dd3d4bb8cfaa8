//! Everything that goes to standard error: messages, the log, and the progress bar, which give way to each other.

use env_logger::Target;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget};
use log::{Level, LevelFilter};
use std::io::{self, IsTerminal, Write};

pub struct Console {
    bars: MultiProgress,
    quiet: bool,
}

impl Console {
    /// Starts the log: warnings and errors, only errors where `quiet`, and more with each step of `verbose`.
    pub fn new(quiet: bool, verbose: u8) -> Self {
        let bars = MultiProgress::with_draw_target(ProgressDrawTarget::stderr());
        // The graphics libraries' warnings are about their own affairs (missing layers, unused features).
        let (own, others) = match verbose {
            _ if quiet => (LevelFilter::Error, LevelFilter::Off),
            0 => (LevelFilter::Warn, LevelFilter::Error),
            1 => (LevelFilter::Info, LevelFilter::Error),
            2 => (LevelFilter::Debug, LevelFilter::Warn),
            _ => (LevelFilter::Trace, LevelFilter::Info),
        };
        env_logger::Builder::new()
            .filter_level(others)
            .filter_module("gpu_trace", own)
            .parse_default_env()
            .format(|out, record| match record.level() {
                Level::Error => writeln!(out, "gpu-trace: error: {}", record.args()),
                Level::Warn => writeln!(out, "gpu-trace: warning: {}", record.args()),
                Level::Info => writeln!(out, "gpu-trace: {}", record.args()),
                Level::Debug | Level::Trace => writeln!(out, "gpu-trace: {}: {}", record.target(), record.args()),
            })
            .target(Target::Pipe(Box::new(LogWriter(bars.clone()))))
            .init();
        Console { bars, quiet }
    }

    /// One line for the user, unless they asked for quiet.
    pub fn say(&self, message: &str) {
        if !self.quiet {
            self.write(&format!("gpu-trace: {message}"));
        }
    }

    pub fn error(&self, message: &str) {
        self.write(&format!("gpu-trace: error: {message}"));
    }

    /// A bar, which shows itself only on a terminal.
    pub fn bar(&self) -> ProgressBar {
        if self.quiet || !io::stderr().is_terminal() {
            ProgressBar::hidden()
        } else {
            self.bars.add(ProgressBar::no_length())
        }
    }

    fn write(&self, line: &str) {
        // Where standard error is closed there is nobody left to tell.
        self.bars.suspend(|| drop(writeln!(io::stderr(), "{line}")));
    }
}

/// Hides the bar while a line of the log is written.
struct LogWriter(MultiProgress);

impl Write for LogWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.suspend(|| io::stderr().write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}
