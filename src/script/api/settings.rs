//! What a script asks of, and tells, the program.

use super::Function;
use crate::script::arguments::{Call, Failure, Outcome};
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] = &[
    ("gr.frame_cmd", 0, frame),
    ("gr.frame", 0, frame),
    ("gr.frames", 0, frames),
    ("gr.time", 0, time),
    ("gr.conventions", 1, conventions),
];

/// `gr.frame_cmd()` or `gr.frame()`: the number of the frame that the command line asks for, 0 in a plain run.
fn frame(call: &Call) -> Outcome<Value> {
    Ok(Value::Integer(i64::from(call.state().frame)))
}

/// `gr.frames()`: the number of frames of the whole animation, 1 in a plain run.
fn frames(call: &Call) -> Outcome<Value> {
    Ok(Value::Integer(i64::from(call.state().frames)))
}

/// `gr.time()`: seconds from frame 0 to this one.
fn time(call: &Call) -> Outcome<Value> {
    let state = call.state();
    Ok(Value::Number(state.rate.seconds_at(state.frame)))
}

/// `gr.conventions{view=, transforms=, specular=, sample=}`, any of them. Transforms change for the whole scene, the
/// others for the pictures that follow.
fn conventions(call: &Call) -> Outcome<Value> {
    let expected = "a table such as {view=\"direction\"}";
    let mut stated = call.state().conventions.script;
    for pair in call.table(0, expected)?.pairs::<Value, Value>() {
        let (key, value) = pair?;
        let (Value::String(key), Value::String(value)) = (&key, &value) else {
            let message = format!("expected {expected}, got {} = {} in it", call.describe(&key), call.describe(&value));
            return Err(Failure::Argument { index: 0, message });
        };
        stated
            .set(&key.to_string_lossy(), &value.to_string_lossy())
            .map_err(|message| Failure::Argument { index: 0, message })?;
    }
    call.state_mut().change_conventions(|conventions| conventions.script = stated);
    Ok(Value::Nil)
}
