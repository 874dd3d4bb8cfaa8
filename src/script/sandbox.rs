//! The Lua state that a scene runs in: which libraries it has, and how a run begins and ends.
//!
//! `prelude.lua` replaces what reaches beyond the scene (see there); native modules, bytecode and the `debug` library
//! are out of reach. What is left out: a single library call that computes for long (a pathological pattern, say)
//! counts as one instruction and is not interrupted.

use super::arguments::{Context, call};
use super::diagnostics::{self, PRELUDE};
use super::guard::Guard;
use super::state::State;
use super::{api, modules};
use crate::error::{Error, Result};
use crate::scene::Scene;
use mlua::chunk::ChunkMode;
use mlua::{Function, Lua, LuaOptions, MultiValue, StdLib, Value};
use std::cell::RefCell;
use std::rc::Rc;

/// A script's text, and its name as the user gave it.
pub(super) struct Script<'a> {
    pub name: String,
    pub source: &'a [u8],
}

/// Runs a script to its end.
pub(super) fn run(
    script: &Script,
    guard: &Rc<Guard>,
    state: &Rc<RefCell<State>>,
    render: &mut dyn FnMut(Scene) -> Result<()>,
) -> Result<()> {
    let context = Context { state: Rc::clone(state), guard: Rc::clone(guard) };
    let outcome = run_in_lua(script, &context, render);
    match (guard.take_reason(), outcome) {
        (Some(reason), _) => Err(reason),
        (None, Ok(outcome)) => outcome,
        (None, Err(error)) => {
            let message = format!("{}: {}", script.name, diagnostics::message_of_error(&error));
            Err(Error::Script { message, calls: Vec::new() })
        }
    }
}

/// The outer result is about setting Lua up, the inner one about the script.
fn run_in_lua(
    script: &Script,
    context: &Context,
    render: &mut dyn FnMut(Scene) -> Result<()>,
) -> mlua::Result<Result<()>> {
    let libraries =
        StdLib::COROUTINE | StdLib::TABLE | StdLib::STRING | StdLib::UTF8 | StdLib::MATH | StdLib::IO | StdLib::OS;
    let lua = Lua::new_with(libraries, LuaOptions::default())?;
    let xpcall: Function = lua.globals().raw_get("xpcall")?;
    let gr = api::register(&lua, context)?;
    let prelude = lua.load(include_str!("prelude.lua")).set_name(PRELUDE).set_mode(ChunkMode::Text);
    prelude.call::<()>(modules::host(&lua, context)?)?;
    context.guard.install(&lua)?;
    lua.scope(|scope| {
        let render = RefCell::new(render);
        let render = scope.create_function(move |lua, arguments: MultiValue| {
            call(lua, context, "gr.render", api::MOST_RENDER_ARGUMENTS, arguments, |call| {
                match render.try_borrow_mut() {
                    Ok(mut render) => api::render(call, &mut **render),
                    // `render` does not call into Lua.
                    Err(error) => Err(mlua::Error::external(error).into()),
                }
            })
        })?;
        gr.raw_set("render", render)?;
        run_chunk(&lua, script, context, &xpcall)
    })
}

fn run_chunk(lua: &Lua, script: &Script, context: &Context, xpcall: &Function) -> mlua::Result<Result<()>> {
    let fail = |message: &str, place: &str, calls| {
        let message = api::explain(lua, context, message);
        let message = if diagnostics::has_place(&message) { message } else { format!("{place}: {message}") };
        Ok(Err(Error::Script { message, calls }))
    };
    let main = match modules::compile(lua, context, &script.name, script.source) {
        Ok(main) => main,
        Err(error) => return fail(&diagnostics::message_of_error(&error), &script.name, Vec::new()),
    };
    let caught = Rc::new(RefCell::new(None));
    let handler = lua.create_function({
        let caught = Rc::clone(&caught);
        // Runs where the error was raised, while the calls that led there are still on the stack.
        move |lua, value: Value| {
            *caught.borrow_mut() =
                Some((diagnostics::message_of(&value), diagnostics::place(lua), diagnostics::call_chain(lua)));
            Ok(())
        }
    })?;
    let (done, value): (bool, Value) = xpcall.call((main, handler))?;
    if done {
        return Ok(Ok(()));
    }
    if let Some((message, place, calls)) = caught.borrow_mut().take() {
        return fail(&message, place.as_deref().unwrap_or(&script.name), calls);
    }
    if diagnostics::is_out_of_memory(&value) {
        // Lua runs no handler then.
        return Err(context.guard.out_of_memory(lua));
    }
    fail(&diagnostics::message_of(&value), &script.name, Vec::new())
}
