//! Ctrl-C. The first request is only noted, and the work stops at its next step; the second ends the program at once.

use gpu_trace::film::discard_unfinished;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Takes over SIGINT (Ctrl-C on Windows). Where that fails an interrupt ends the program at once, as it would without.
pub fn install() {
    let handler = || {
        if REQUESTED.swap(true, Ordering::SeqCst) {
            discard_unfinished();
            let _ = writeln!(std::io::stderr(), "gpu-trace: error: interrupted");
            std::process::exit(super::EXIT_INTERRUPTED.into());
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        log::debug!("interrupts are not handled: {error}");
    }
}

pub fn requested() -> bool {
    REQUESTED.load(Ordering::SeqCst)
}
