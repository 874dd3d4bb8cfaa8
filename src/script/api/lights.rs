//! Lights.

use super::Function;
use super::materials::colour;
use crate::scene::{Light, LightExtent};
use crate::script::arguments::{Call, LightHandle, Outcome};
use glam::DVec3;
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] = &[("gr.light", 3, light)];

/// `gr.light({x, y, z}, {r, g, b}, {c0, c1, c2})`.
fn light(call: &Call) -> Outcome<Value> {
    let position = DVec3::from_array(call.tuple(0)?);
    let colour = colour(call, 1)?;
    let falloff = DVec3::from_array(call.tuple(2)?).as_vec3();
    if falloff.min_element() < 0.0 || falloff.max_element() == 0.0 {
        return Err(call.unexpected(2, "attenuation {c0, c1, c2}, none below 0 and one above"));
    }
    let light = Light { position, colour, falloff, extent: LightExtent::Classic, visible: false };
    Ok(Value::UserData(call.lua.create_userdata(LightHandle(light))?))
}
