//! `translate`, `scale` and `rotate`.

use super::Function;
use crate::script::arguments::{Call, Failure, Outcome};
use glam::{DAffine3, DVec3};
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] =
    &[("gr.translate", 4, translate), ("gr.scale", 4, scale), ("gr.rotate", 3, rotate)];

/// `node:translate(x, y, z)`, in world units of the parent.
fn translate(call: &Call) -> Outcome<Value> {
    call.node(0)?;
    let offset = DVec3::new(call.number(1)?, call.number(2)?, call.number(3)?);
    apply(call, DAffine3::from_translation(offset))
}

/// `node:scale(x, y, z)`; negative factors mirror.
fn scale(call: &Call) -> Outcome<Value> {
    call.node(0)?;
    let factor = |index| call.number_where(index, "a factor other than 0", |factor| factor != 0.0);
    apply(call, DAffine3::from_scale(DVec3::new(factor(1)?, factor(2)?, factor(3)?)))
}

/// `node:rotate(axis, degrees)`, right-handed about 'x', 'y' or 'z' in either case.
fn rotate(call: &Call) -> Outcome<Value> {
    call.node(0)?;
    let expected = "an axis 'x', 'y' or 'z'";
    let axis = match call.text(1, expected)?.as_str() {
        "x" | "X" => DVec3::X,
        "y" | "Y" => DVec3::Y,
        "z" | "Z" => DVec3::Z,
        _ => return Err(call.unexpected(1, expected)),
    };
    let degrees = call.number_where(2, "an angle in degrees", |_| true)?;
    apply(call, DAffine3::from_axis_angle(axis, degrees.to_radians()))
}

fn apply(call: &Call, step: DAffine3) -> Outcome<Value> {
    let node = call.node(0)?;
    if call.state_mut().transform_node(node, step) {
        return Ok(Value::Nil);
    }
    let name = call.state().graph().node(node).name.clone();
    Err(Failure::Call(format!("the transforms of '{name}' together leave the range of numbers, or flatten it")))
}
