//! Ctrl-C. While a picture is being rendered the request is only noted, and the sample loop stops at its next step;
//! at other times, and at the second request, the program ends at once.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);
static DEFERRED: AtomicBool = AtomicBool::new(false);

/// Takes over SIGINT (Ctrl-C on Windows). Where that fails an interrupt ends the program at once, as it would without.
pub fn install() {
    let handler = || {
        let again = REQUESTED.swap(true, Ordering::SeqCst);
        if again || !DEFERRED.load(Ordering::SeqCst) {
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

/// While this lives, the first interrupt is only noted.
pub struct Deferral(());

pub fn defer() -> Deferral {
    DEFERRED.store(true, Ordering::SeqCst);
    Deferral(())
}

impl Drop for Deferral {
    fn drop(&mut self) {
        DEFERRED.store(false, Ordering::SeqCst);
    }
}
