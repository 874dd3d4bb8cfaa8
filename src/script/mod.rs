//! Runs scene scripts: the only place that knows Lua.
//!
//! A scene is a Lua 5.4 program that builds a graph of nodes with the `gr.*` functions and asks for pictures with
//! `gr.render`. It runs in a sandbox (`sandbox.rs`) under a memory and an instruction limit (`guard.rs`); what it may
//! read is decided by `search.rs`. Each `gr.*` function is a thin mapping from its positional arguments
//! (`arguments.rs`), or the keys of its table, to named values (`fields.rs`), from which one builder makes the
//! descriptions of [`crate::scene`].

mod api;
mod arguments;
mod conventions;
mod diagnostics;
mod fields;
mod given;
mod guard;
mod library;
mod modules;
mod sandbox;
mod search;
mod sequences;
mod state;

pub use conventions::{ConventionOverrides, TransformOrder, ViewConvention};
pub use library::{Library, LibraryCounts};

use crate::error::{Error, Result};
use crate::scene::{FrameRate, Scene};
use guard::Guard;
use state::State;
use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

/// What a script is told, and how much it may use.
#[derive(Clone, Debug)]
pub struct ScriptOptions {
    /// What `gr.frame_cmd()` returns.
    pub frame: u32,
    /// What `gr.frames()` returns: the frames of the whole animation.
    pub frames: u32,
    /// Turns frames into the seconds of `gr.time()`.
    pub rate: FrameRate,
    /// Seeds `math.random`, and becomes the seed of the scenes.
    pub seed: u32,
    /// Conventions that win over those of the script.
    pub conventions: ConventionOverrides,
    /// Bytes that the script's values, nodes and meshes may take together.
    pub memory_limit: usize,
    /// Lua virtual machine instructions that the script may execute; calls of `gr` functions and caught errors count
    /// as what they take. A single call of a Lua library function counts as one, however long it takes.
    pub instruction_limit: u64,
    /// Files that other runs with this library have read are not read again.
    pub library: Arc<Library>,
}

impl ScriptOptions {
    /// Room for some five million triangles given as Lua tables.
    pub const DEFAULT_MEMORY_LIMIT: usize = 2 << 30;
    /// A few seconds of an empty loop; a million triangles computed one by one take a twentieth of it.
    pub const DEFAULT_INSTRUCTION_LIMIT: u64 = 500_000_000;
}

impl Default for ScriptOptions {
    fn default() -> Self {
        ScriptOptions {
            frame: 0,
            frames: 1,
            rate: FrameRate::default(),
            seed: 0,
            conventions: ConventionOverrides::default(),
            memory_limit: Self::DEFAULT_MEMORY_LIMIT,
            instruction_limit: Self::DEFAULT_INSTRUCTION_LIMIT,
            library: Arc::default(),
        }
    }
}

/// What a script did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScriptSummary {
    /// Calls of `gr.render` that went well.
    pub pictures: u32,
    /// What it was warned of, in order. Through `log::warn!` each goes once for a [`Library`].
    pub warnings: Vec<String>,
}

/// Runs the script and calls `render` for every `gr.render` in it, in order; after each the script goes on.
///
/// File names in messages are given as `path` was. Relative output paths are kept as the script gave them.
///
/// # Errors
/// [`Error::File`] if the script cannot be read; [`Error::Script`] if it fails or passes a limit. An error of `render`
/// ends the script, even inside `pcall`, and is returned as it is. [`Error::Interrupted`] after [`Library::stop`].
pub fn run_scene(
    path: &Path,
    options: &ScriptOptions,
    render: &mut dyn FnMut(Scene) -> Result<()>,
) -> Result<ScriptSummary> {
    let source = std::fs::read(path).map_err(|source| Error::file("read the scene", path, source))?;
    let guard = Rc::new(Guard::new(options.memory_limit, options.instruction_limit, Arc::clone(&options.library)));
    let state = Rc::new(RefCell::new(State::new(path, options)));
    let script = sandbox::Script { name: path.display().to_string(), source: &source };
    let outcome = sandbox::run(&script, &guard, &state, render);
    let mut state = state.borrow_mut();
    outcome.map(|()| ScriptSummary { pictures: state.pictures, warnings: std::mem::take(&mut state.warnings) })
}

/// Runs the script and collects the scenes that it asks to render, in order.
///
/// # Errors
/// As [`run_scene`].
pub fn load_scene(path: &Path, options: &ScriptOptions) -> Result<Vec<Scene>> {
    let mut scenes = Vec::new();
    run_scene(path, options, &mut |scene| {
        scenes.push(scene);
        Ok(())
    })?;
    Ok(scenes)
}
