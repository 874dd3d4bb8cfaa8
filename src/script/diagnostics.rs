//! Puts what went wrong in a script into words: `file:line: message` and the chain of calls.

use mlua::debug::Debug;
use mlua::{Lua, Value};
use std::fmt::Write;

/// Chunk name of `prelude.lua`, whose frames and positions are not shown.
pub(super) const PRELUDE: &str = "=prelude";

/// Calls that a chain shows before it breaks off.
const LONGEST_CHAIN: usize = 12;

/// An error raised by one of our functions; `message` starts with its place.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}")]
pub(super) struct Raised {
    pub message: String,
}

/// A Lua function that was running.
struct Frame {
    /// `file:line`.
    place: String,
    what: String,
    is_main: bool,
}

fn frame_of(debug: &Debug) -> Option<Frame> {
    let place = place_of(debug)?;
    let is_main = debug.source().what == "main";
    let names = debug.names();
    let what = match (is_main, names.name_what, names.name) {
        (true, ..) => "the main chunk".to_owned(),
        (_, Some("metamethod"), Some(name)) => format!("metamethod '{name}'"),
        (_, Some("method"), Some(name)) => format!("method '{name}'"),
        (_, _, Some(name)) => format!("function '{name}'"),
        (_, _, None) => "an unnamed function".to_owned(),
    };
    Some(Frame { place, what, is_main })
}

/// `file:line` that a frame is at; `None` for functions of ours and of the library.
pub(super) fn place_of(debug: &Debug) -> Option<String> {
    let line = debug.current_line()?;
    let source = debug.source().source?;
    if source == PRELUDE {
        return None;
    }
    Some(format!("{}:{line}", source.strip_prefix(['@', '=']).unwrap_or(&source)))
}

fn frames(lua: &Lua, limit: usize) -> Vec<Frame> {
    let mut frames = Vec::new();
    let mut level = 0;
    while frames.len() < limit {
        match lua.inspect_stack(level, frame_of) {
            Some(frame) => frames.extend(frame),
            None => break,
        }
        level += 1;
    }
    frames
}

/// `file:line` of the innermost Lua function of the script.
pub(super) fn place(lua: &Lua) -> Option<String> {
    frames(lua, 1).pop().map(|frame| frame.place)
}

/// `place` with ": " after it, or nothing; and the chain of calls.
pub(super) fn where_now(lua: &Lua) -> (String, Vec<String>) {
    (place(lua).map_or_else(String::new, |place| format!("{place}: ")), call_chain(lua))
}

/// The Lua calls that led here, innermost first; empty directly in the main chunk, where the place says it all.
pub(super) fn call_chain(lua: &Lua) -> Vec<String> {
    let frames = frames(lua, LONGEST_CHAIN + 1);
    if let [only] = frames.as_slice()
        && only.is_main
    {
        return Vec::new();
    }
    let mut calls: Vec<String> =
        frames.iter().take(LONGEST_CHAIN).map(|frame| format!("in {} ({})", frame.what, frame.place)).collect();
    if frames.len() > LONGEST_CHAIN {
        calls.push("…".to_owned());
    }
    calls
}

/// What the user should read of an error value, without the marks of Lua and mlua.
pub(super) fn message_of(value: &Value) -> String {
    match value {
        Value::String(text) => strip_marks(&text.to_string_lossy()),
        Value::Error(error) => message_of_error(error),
        Value::Nil => "the script raised an error without a message".to_owned(),
        Value::Table(table)
            if table.metatable().is_some_and(|meta| meta.contains_key("__tostring").unwrap_or(false)) =>
        {
            value.to_string().unwrap_or_else(|_| "the script raised a table".to_owned())
        }
        other => format!("the script raised an error that is not text but a {}", other.type_name()),
    }
}

pub(super) fn message_of_error(error: &mlua::Error) -> String {
    match error {
        mlua::Error::CallbackError { cause, .. } => message_of_error(cause),
        mlua::Error::ExternalError(cause) => cause.to_string(),
        mlua::Error::SyntaxError { message, .. }
        | mlua::Error::RuntimeError(message)
        | mlua::Error::MemoryError(message) => strip_marks(message),
        other => strip_marks(&other.to_string()),
    }
}

/// Whether Lua's allocator refused.
pub(super) fn is_out_of_memory(value: &Value) -> bool {
    matches!(value, Value::String(text) if text.as_bytes() == b"not enough memory".as_slice())
}

/// Takes off a stack trace, and the position in our prelude.
fn strip_marks(message: &str) -> String {
    let message = message.split("\nstack traceback:").next().unwrap_or_default();
    match message.strip_prefix("prelude:").and_then(|rest| rest.split_once(": ")) {
        Some((_, rest)) => rest.to_owned(),
        None => message.to_owned(),
    }
}

/// Whether the message starts with `name:digits:`.
pub(super) fn has_place(message: &str) -> bool {
    let mut parts = message.split(':');
    let _name = parts.next();
    // A Windows path has a colon of its own.
    parts.take(2).any(|part| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Lua's complaint about calling a field or method that is nil: what stands before it, and the name.
pub(super) fn called_nil(message: &str) -> Option<(&str, &str)> {
    let (start, rest) = message.split_once("attempt to call a nil value (")?;
    let rest = rest.strip_prefix("field '").or_else(|| rest.strip_prefix("method '"))?;
    Some((start, rest.strip_suffix("')")?))
}

/// `gr.NAME: no such function`, with the nearest of the known names.
pub(super) fn no_such_function<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let mut message = format!("gr.{name}: no such function");
    if let Some(nearest) = nearest(name, known) {
        let _ = write!(message, "; did you mean gr.{nearest}?");
    }
    message
}

/// The known name that `name` is most likely a misspelling of.
pub(super) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let tolerance = (name.chars().count() / 3).max(2);
    known
        .map(|candidate| (strsim::damerau_levenshtein(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= tolerance)
        .min()
        .map(|(_, candidate)| candidate)
}

/// Longest chunk name that Lua puts into its messages in full (LUA_IDSIZE).
const LONGEST_NAME: usize = 59;

/// Puts the full names of chunks where Lua abbreviated them.
pub(super) fn restore_names<'a>(message: &str, names: impl Iterator<Item = &'a String>) -> String {
    let mut message = message.to_owned();
    for name in names.filter(|name| name.len() > LONGEST_NAME) {
        let end = String::from_utf8_lossy(&name.as_bytes()[name.len() + 3 - LONGEST_NAME..]);
        message = message.replace(&format!("...{end}:"), &format!("{name}:"));
    }
    message
}
