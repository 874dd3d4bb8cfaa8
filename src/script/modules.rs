//! What `prelude.lua` needs from the program: files inside the scene's folders, and the guard.

use super::api::{self, Function};
use super::arguments::{Call, Context, Failure, NodeHandle, Outcome};
use super::diagnostics;
use super::guard::{COROUTINE_COST, ERROR_COST};
use crate::scene::load_obj;
use mlua::chunk::ChunkMode;
use mlua::{Lua, Table, Value};
use std::fs;
use std::io::Write;
use std::path::Path;

/// Functions for the prelude's eyes only; the names are those that a failing script sees.
const FUNCTIONS: &[(&str, Function)] = &[
    ("load_file", ("dofile", 1, |call| load_inside(call, &call.text(0, "a file name")?))),
    ("find_module", ("require", 1, find_module)),
    ("find_readable", ("io.open", 1, find_readable)),
    ("read_obj", ("readobj", 1, read_obj)),
    ("caught", ("error", 1, caught)),
    ("check", ("check", 0, |_| Ok(Value::Nil))),
    ("charge", ("coroutine.create", 0, charge)),
    ("is_node", ("getmetatable", 1, is_node)),
    ("print", ("print", 1, print)),
    ("refuse", ("refuse", 2, refuse)),
    ("source_at", ("debug.getinfo", 1, source_at)),
];

/// The table that the prelude gets.
pub(super) fn host(lua: &Lua, context: &Context) -> mlua::Result<Table> {
    let host = lua.create_table()?;
    for &(key, ours) in FUNCTIONS {
        host.raw_set(key, api::function(lua, context, ours)?)?;
    }
    host.raw_set("seed", context.state.borrow().seed)?;
    Ok(host)
}

/// Compiles a file's text, without the `#` line that makes it a program on Unix.
pub(super) fn compile(lua: &Lua, context: &Context, name: &str, source: &[u8]) -> mlua::Result<mlua::Function> {
    context.state.borrow_mut().chunks.insert(name.to_owned());
    let source = source.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(source);
    let start = match source.first() {
        // The line's end stays, so that the lines keep their numbers.
        Some(b'#') => source.iter().position(|byte| *byte == b'\n').unwrap_or(source.len()),
        _ => 0,
    };
    lua.load(&source[start..]).set_name(format!("@{name}")).set_mode(ChunkMode::Text).into_function()
}

fn load_inside(call: &Call, name: &str) -> Outcome<Value> {
    let path = call.state().files.find_inside(name).map_err(|missing| Failure::Call(missing.message(name)))?;
    load_path(call, &path)
}

fn load_path(call: &Call, path: &Path) -> Outcome<Value> {
    let source = fs::read(path).map_err(|error| Failure::Call(format!("cannot read '{}': {error}", path.display())))?;
    match compile(call.lua, call.context, &path.display().to_string(), &source) {
        Ok(chunk) => Ok(Value::Function(chunk)),
        Err(error) => Err(Failure::Lua(mlua::Error::external(diagnostics::Raised {
            message: api::explain(call.lua, call.context, &diagnostics::message_of_error(&error)),
        }))),
    }
}

/// The chunk of a module, by the templates of `package.path`; nil if there is none and the prelude has its own.
fn find_module(call: &Call) -> Outcome<Value> {
    let name = call.text(0, "the name of a module")?;
    if name == "readobj" {
        call.state_mut().recognise_old_skeleton(call.lua, "require('readobj')");
    }
    let package = call.lua.globals().raw_get::<Option<Table>>("package").ok().flatten();
    let templates = package.and_then(|package| package.raw_get::<Option<String>>("path").ok().flatten());
    let templates = templates.unwrap_or_else(|| "?.lua;?/init.lua".to_owned());
    let mut failure = None;
    for template in templates.split(';').filter(|template| !template.is_empty()) {
        let file = template.replace('?', &name.replace('.', "/"));
        let found = call.state().files.find_inside(&file);
        match found {
            Ok(path) => return load_path(call, &path),
            Err(missing) => failure = failure.or(Some(missing.message(&file))),
        }
    }
    match failure {
        _ if name == "readobj" => Ok(Value::Nil),
        Some(message) => Err(Failure::Call(format!("no module '{name}': {message}"))),
        None => Err(Failure::Call(format!("no module '{name}': package.path is empty"))),
    }
}

/// The path of a file that may be read, or nil and why not.
fn find_readable(call: &Call) -> Outcome<Value> {
    let name = call.text(0, "a file name")?;
    let answer = call.lua.create_table()?;
    match call.state().files.find_inside(&name) {
        Ok(path) => answer.raw_set("path", path.display().to_string())?,
        Err(missing) => answer.raw_set("problem", missing.message(&name))?,
    }
    Ok(Value::Table(answer))
}

/// The vertices and faces of an OBJ file as tables, for `readobj`: polygons as triangles, faces counted from 0.
fn read_obj(call: &Call) -> Outcome<Value> {
    let name = call.text(0, "the name of an OBJ file")?;
    let fail = |message: String| Failure::Argument { index: 0, message };
    let path = call.state().files.find(&name).map_err(|missing| fail(missing.message(&name)))?;
    let mesh = load_obj(&path).map_err(|error| fail(error.to_string()))?;
    let lua = call.lua;
    let vertices = lua.create_table_with_capacity(mesh.positions.len(), 0)?;
    for position in &mesh.positions {
        vertices.raw_push(lua.create_sequence_from(position.to_array())?)?;
    }
    let faces = lua.create_table_with_capacity(mesh.triangles.len(), 0)?;
    for triangle in &mesh.triangles {
        faces.raw_push(lua.create_sequence_from(*triangle)?)?;
    }
    let both = lua.create_table()?;
    both.raw_set(1, vertices)?;
    both.raw_set(2, faces)?;
    Ok(Value::Table(both))
}

/// What a script gets to see of an error that it caught: text instead of our error objects. Raises again what must not
/// be caught.
fn caught(call: &Call) -> Outcome<Value> {
    call.context.guard.charge_instructions(call.lua, ERROR_COST)?;
    let value = call.value(0);
    match value {
        value if diagnostics::is_out_of_memory(value) => Err(Failure::Lua(call.context.guard.out_of_memory(call.lua))),
        Value::String(_) | Value::Error(_) => {
            let message = api::explain(call.lua, call.context, &diagnostics::message_of(value));
            Ok(Value::String(call.lua.create_string(message)?))
        }
        other => Ok(other.clone()),
    }
}

fn charge(call: &Call) -> Outcome<Value> {
    call.context.guard.charge_instructions(call.lua, COROUTINE_COST)?;
    Ok(Value::Nil)
}

fn is_node(call: &Call) -> Outcome<Value> {
    let node = matches!(call.value(0), Value::UserData(data) if data.is::<NodeHandle>());
    Ok(Value::Boolean(node))
}

/// Prints to stderr: stdout belongs to what the program reports.
fn print(call: &Call) -> Outcome<Value> {
    if let Value::String(text) = call.value(0) {
        // A closed stderr is no reason to end a script.
        let _ = std::io::stderr().write_all(&text.as_bytes());
    }
    Ok(Value::Nil)
}

/// Raises the error `NAME: WHY` at the script's line.
fn refuse(call: &Call) -> Outcome<Value> {
    let place = diagnostics::place(call.lua).map_or_else(String::new, |place| format!("{place}: "));
    let message = format!("{place}{}: {}", call.text(0, "a name")?, call.text(1, "a reason")?);
    Err(Failure::Lua(mlua::Error::external(diagnostics::Raised { message })))
}

/// `file:line` of the script's innermost function.
fn source_at(call: &Call) -> Outcome<Value> {
    let place = diagnostics::place(call.lua).unwrap_or_default();
    Ok(Value::String(call.lua.create_string(place)?))
}
