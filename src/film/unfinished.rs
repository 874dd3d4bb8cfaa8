//! Files in the making and programs that write them: what a process that ends at once must not leave behind.
//!
//! Temporary files remove themselves as they are dropped, but nothing is dropped where an interrupt ends the process.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

type CleanUp = Box<dyn FnMut() + Send>;

#[derive(Default)]
struct Unfinished {
    next: u64,
    clean_ups: BTreeMap<u64, CleanUp>,
}

static UNFINISHED: Mutex<Unfinished> = Mutex::new(Unfinished { next: 0, clean_ups: BTreeMap::new() });

fn lock() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// While this lives, [`discard_unfinished`] runs its clean-up.
pub(super) struct Registration(u64);

/// Makes something, and says how to undo it. Both happen before or after a call of [`discard_unfinished`], not during
/// one.
///
/// # Errors
/// Those of `make`.
pub(super) fn register<T, E>(make: impl FnOnce() -> Result<(T, CleanUp), E>) -> Result<(T, Registration), E> {
    let mut unfinished = lock();
    let (made, clean_up) = make()?;
    let number = unfinished.next;
    unfinished.next += 1;
    unfinished.clean_ups.insert(number, clean_up);
    Ok((made, Registration(number)))
}

impl Registration {
    /// Finishes the thing, after which there is nothing to undo; if that fails there still is.
    ///
    /// # Errors
    /// Those of `finish`.
    pub fn finish<T, E>(self, finish: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        let mut unfinished = lock();
        let finished = finish();
        unfinished.clean_ups.remove(&self.0);
        std::mem::forget(self);
        finished
    }
}

impl Drop for Registration {
    fn drop(&mut self) {
        lock().clean_ups.remove(&self.0);
    }
}

/// Removes all unfinished files and ends the programs that write them, latest first. Whoever would begin or finish a
/// file afterwards waits for ever: this is for a process that is about to exit, and has other threads.
pub fn discard_unfinished() {
    let mut unfinished = lock();
    for clean_up in unfinished.clean_ups.values_mut().rev() {
        clean_up();
    }
    std::mem::forget(unfinished);
}
