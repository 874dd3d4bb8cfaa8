//! Ends a script for good: on a failed picture, or when it has used up its instructions or memory.
//!
//! A Lua error alone would not do, since the script may catch it with `pcall`. So the reason is kept here, and while
//! there is one, everything that could swallow an error (`pcall`, `coroutine.resume`, … in `prelude.lua`), every
//! `gr.*` function and the instruction hook raise it again.

use super::diagnostics;
use super::library::Library;
use crate::error::Error;
use mlua::debug::Debug;
use mlua::{HookTriggers, Lua, VmState};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;

/// Instructions between two looks at the count.
const HOOK_INTERVAL: u32 = 1000;

/// What else takes the time of that many instructions: a call of one of our functions, and an error caught.
pub(super) const CALL_COST: u64 = 200;
pub(super) const ERROR_COST: u64 = 50_000;
/// A coroutine starts its own interval, so that many short ones would otherwise run for free.
pub(super) const COROUTINE_COST: u64 = HOOK_INTERVAL as u64;

/// Memory by which the limit is raised once the script is being ended, so that the unwinding has room.
const UNWINDING_ROOM: usize = 16 << 20;

pub(super) struct Guard {
    memory_limit: usize,
    instruction_limit: u64,
    executed: Cell<u64>,
    /// Bytes outside Lua's allocator: nodes, materials, meshes.
    outside: Cell<usize>,
    reason: RefCell<Option<Error>>,
    stopped: Cell<bool>,
    /// Where the script was when its memory last looked scarce.
    place: RefCell<Option<String>>,
    /// Says whether the user wants no more of it.
    library: Arc<Library>,
}

impl Guard {
    pub fn new(memory_limit: usize, instruction_limit: u64, library: Arc<Library>) -> Self {
        Guard {
            memory_limit,
            instruction_limit,
            executed: Cell::new(0),
            outside: Cell::new(0),
            reason: RefCell::new(None),
            stopped: Cell::new(false),
            place: RefCell::new(None),
            library,
        }
    }

    /// Sets both limits on the Lua state.
    pub fn install(self: &Rc<Self>, lua: &Lua) -> mlua::Result<()> {
        lua.set_memory_limit(self.memory_limit)?;
        let guard = Rc::clone(self);
        let triggers = HookTriggers::new().every_nth_instruction(HOOK_INTERVAL);
        lua.set_global_hook(triggers, move |lua, debug| guard.count(lua, debug).map(|()| VmState::Continue))
    }

    fn count(&self, lua: &Lua, debug: &Debug) -> mlua::Result<()> {
        self.check()?;
        if self.library.is_stopped() {
            return Err(self.stop(lua, Error::Interrupted));
        }
        self.charge_instructions(lua, u64::from(HOOK_INTERVAL))?;
        if lua.used_memory() > self.memory_limit / 4 {
            *self.place.borrow_mut() = diagnostics::place_of(debug);
        }
        Ok(())
    }

    /// Counts instructions, or what takes as long.
    pub fn charge_instructions(&self, lua: &Lua, count: u64) -> mlua::Result<()> {
        let executed = self.executed.get().saturating_add(count);
        self.executed.set(executed);
        if executed <= self.instruction_limit {
            return Ok(());
        }
        let (place, calls) = diagnostics::where_now(lua);
        let message = format!(
            "{place}the script ran for more than {} Lua instructions and was ended; is there an endless loop?",
            self.instruction_limit
        );
        Err(self.stop(lua, Error::Script { message, calls }))
    }

    /// Counts memory that Lua's allocator does not see.
    pub fn charge_memory(&self, lua: &Lua, bytes: usize) -> mlua::Result<()> {
        let outside = self.outside.get().saturating_add(bytes);
        self.outside.set(outside);
        if outside.saturating_add(lua.used_memory()) <= self.memory_limit {
            return Ok(());
        }
        let (place, calls) = diagnostics::where_now(lua);
        Err(self.stop(lua, Error::Script { message: format!("{place}{}", self.memory_message()), calls }))
    }

    /// Lua's allocator refused: ends the script.
    pub fn out_of_memory(&self, lua: &Lua) -> mlua::Error {
        let place = self.place.borrow_mut().take().map_or_else(String::new, |place| format!("{place}: "));
        self.stop(lua, Error::Script { message: format!("{place}{}", self.memory_message()), calls: Vec::new() })
    }

    fn memory_message(&self) -> String {
        format!("the script needs more than {} MiB of memory and was ended", self.memory_limit >> 20)
    }

    /// Ends the script with this reason, unless it is being ended already. Returns the Lua error to raise.
    pub fn stop(&self, lua: &Lua, reason: Error) -> mlua::Error {
        self.reason.borrow_mut().get_or_insert(reason);
        if !self.stopped.replace(true) {
            // Fails only for a Lua state with an allocator that is not mlua's.
            let _ = lua.set_memory_limit(self.memory_limit.saturating_add(UNWINDING_ROOM));
        }
        mlua::Error::external(Stopped)
    }

    /// Raises again if the script is being ended.
    pub fn check(&self) -> mlua::Result<()> {
        if self.stopped.get() { Err(mlua::Error::external(Stopped)) } else { Ok(()) }
    }

    /// Why the script was ended, once.
    pub fn take_reason(&self) -> Option<Error> {
        self.reason.borrow_mut().take()
    }
}

/// The Lua error that carries a script to its end; the reason waits in the [`Guard`].
#[derive(Debug, thiserror::Error)]
#[error("the script is being ended")]
struct Stopped;
