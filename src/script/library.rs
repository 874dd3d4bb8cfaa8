//! What the runs of one batch share: the files that they read, and the warnings that were said.

use crate::Result;
use crate::scene::{Image, Mesh};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Meshes and images by their files, which are read again only where they have changed.
#[derive(Debug, Default)]
pub struct Library {
    pub(super) meshes: Shelf<Mesh>,
    pub(super) images: Shelf<Image>,
    warned: Mutex<HashSet<String>>,
    stopped: AtomicBool,
    runs: AtomicU64,
    /// Runs that an unused file outlives.
    keep: u64,
}

/// How often files were read, and how often a mesh or image was there from an earlier run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LibraryCounts {
    pub files_read: u64,
    pub files_reused: u64,
}

impl Library {
    /// A library that drops what `keep` runs in a row did not ask for.
    pub fn new(keep: u64) -> Self {
        Library { keep, ..Library::default() }
    }

    /// Lets the scripts that are running end with [`crate::Error::Interrupted`], and those to come.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    pub fn counts(&self) -> LibraryCounts {
        let sum = |of: fn(&Counts) -> &AtomicU64| {
            of(&self.meshes.counts).load(Ordering::Relaxed) + of(&self.images.counts).load(Ordering::Relaxed)
        };
        LibraryCounts { files_read: sum(|counts| &counts.read), files_reused: sum(|counts| &counts.reused) }
    }

    /// Begins a run; returns its number.
    pub(super) fn begin_run(&self) -> u64 {
        let run = self.runs.fetch_add(1, Ordering::Relaxed);
        self.meshes.drop_unused(run, self.keep);
        self.images.drop_unused(run, self.keep);
        run
    }

    /// Whether this warning is new: a batch says each once.
    pub(super) fn first_time(&self, warning: &str) -> bool {
        lock(&self.warned).insert(warning.to_owned())
    }
}

/// What was read from one kind of file.
#[derive(Debug)]
pub(super) struct Shelf<T> {
    entries: Mutex<HashMap<PathBuf, Entry<T>>>,
    counts: Counts,
}

#[derive(Debug, Default)]
struct Counts {
    read: AtomicU64,
    reused: AtomicU64,
}

#[derive(Debug)]
struct Entry<T> {
    last_run: u64,
    /// Locked while the file is read, so that runs side by side read it once.
    slot: Arc<Slot<T>>,
}

/// The version that was read last, once it was.
type Slot<T> = Mutex<Option<(Stamp, Arc<T>)>>;

/// What tells one version of a file from the next.
type Stamp = (Option<SystemTime>, u64);

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Shelf { entries: Mutex::default(), counts: Counts::default() }
    }
}

impl<T> Shelf<T> {
    /// What the file at `real`, a resolved path, holds: from memory where its length and time are those of the version
    /// that was read, else by `read`.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn get(&self, real: &Path, run: u64, read: impl FnOnce() -> Result<T>) -> Result<Arc<T>> {
        let slot = {
            let mut entries = lock(&self.entries);
            let entry = entries
                .entry(real.to_owned())
                .or_insert_with(|| Entry { last_run: run, slot: Arc::new(Mutex::new(None)) });
            entry.last_run = entry.last_run.max(run);
            Arc::clone(&entry.slot)
        };
        let mut slot = lock(&slot);
        // Taken before reading: a change meanwhile shows as a difference next time.
        let stamp = std::fs::metadata(real).map(|metadata| (metadata.modified().ok(), metadata.len())).ok();
        if let (Some((known, value)), Some(stamp)) = (&*slot, stamp)
            && *known == stamp
        {
            self.counts.reused.fetch_add(1, Ordering::Relaxed);
            return Ok(Arc::clone(value));
        }
        let value = Arc::new(read()?);
        self.counts.read.fetch_add(1, Ordering::Relaxed);
        *slot = stamp.map(|stamp| (stamp, Arc::clone(&value)));
        Ok(value)
    }

    fn drop_unused(&self, run: u64, keep: u64) {
        lock(&self.entries).retain(|_, entry| entry.last_run + keep >= run);
    }
}

/// The maps are whole between any two statements, so that a panic elsewhere leaves nothing to fear.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
