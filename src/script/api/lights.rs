//! Lights.

use super::Function;
use crate::scene::{Light, LightExtent};
use crate::script::arguments::{Call, LightHandle, Outcome};
use crate::script::fields::Fields;
use crate::script::given::Given;
use glam::Vec3;
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] =
    &[("gr.light", 3, light), ("gr.area_light", 6, area_light), ("gr.sphere_light", 5, sphere_light)];

/// Sine of the angle between the edges of an area light below which they span no area.
const PARALLEL: f64 = 1e-9;

/// `gr.light({x, y, z}, {r, g, b}, {c0, c1, c2})` or `gr.light{position=, colour=, falloff=}`.
fn light(call: &Call) -> Outcome<Value> {
    build(call, &["position", "colour", "falloff"], 3, |_| Ok(LightExtent::Classic))
}

/// `gr.area_light{position=, colour=, falloff=, u=, v=, visible=}`, or the values in that order.
fn area_light(call: &Call) -> Outcome<Value> {
    build(call, &["position", "colour", "falloff", "u", "v", "visible"], 5, |fields| {
        let u = fields.get("u").vector()?;
        let v = fields.get("v");
        let other = v.vector()?;
        if u.cross(other).length() <= PARALLEL * u.length() * other.length() {
            return Err(v.unexpected("an edge {x, y, z} that spans an area with u"));
        }
        Ok(LightExtent::Parallelogram { u, v: other })
    })
}

/// `gr.sphere_light{position=, colour=, falloff=, radius=, visible=}`, or the values in that order.
fn sphere_light(call: &Call) -> Outcome<Value> {
    build(call, &["position", "colour", "falloff", "radius", "visible"], 4, |fields| {
        Ok(LightExtent::Sphere {
            radius: fields.get("radius").number_where("a radius above 0", |radius| radius > 0.0)?,
        })
    })
}

fn build(
    call: &Call,
    keys: &[&'static str],
    required: usize,
    extent: impl FnOnce(&Fields) -> Outcome<LightExtent>,
) -> Outcome<Value> {
    let fields =
        Fields::of_only_argument(call, keys).unwrap_or_else(|| Ok(Fields::of_arguments(call, keys, required)))?;
    let light = Light {
        position: fields.get("position").vector()?,
        colour: fields.get("colour").or(Vec3::ONE, Given::colour)?,
        falloff: fields.get("falloff").or(Vec3::X, falloff)?,
        extent: extent(&fields)?,
        visible: fields.get("visible").or(false, Given::flag)?,
    };
    Ok(Value::UserData(call.lua.create_userdata(LightHandle(light))?))
}

fn falloff(given: &Given) -> Outcome<Vec3> {
    let falloff = given.colour()?;
    if falloff.min_element() < 0.0 || falloff.max_element() == 0.0 {
        return Err(given.unexpected("attenuation {c0, c1, c2}, none below 0 and one above"));
    }
    Ok(falloff)
}
