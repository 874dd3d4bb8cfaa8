//! Images, and the noise that bump maps are made of.

use super::Function;
use crate::cpu::math::noise::perlin_noise;
use crate::scene::{Image, load_image};
use crate::script::arguments::{Call, Outcome, TextureHandle};
use crate::script::given::Given;
use glam::DVec3;
use mlua::Value;
use std::sync::Arc;

pub(super) const FUNCTIONS: &[Function] = &[("gr.texture", 1, texture), ("gr.noise", 3, noise)];

/// `gr.texture(file)`.
fn texture(call: &Call) -> Outcome<Value> {
    let file = call.given(0);
    let image = file.image()?;
    Ok(Value::UserData(call.lua.create_userdata(TextureHandle(image))?))
}

/// `gr.noise(x, y, z)`: the shaders' Perlin noise, by their twin.
fn noise(call: &Call) -> Outcome<Value> {
    let point = DVec3::new(call.number(0)?, call.number(1)?, call.number(2)?);
    Ok(Value::Number(f64::from(perlin_noise(point.as_vec3()))))
}

/// Reads a file once; the second time the same image is shared.
pub(in crate::script) fn load(given: &Given, name: &str) -> Outcome<Arc<Image>> {
    let call = given.call;
    let path = call.state().files.find(name).map_err(|missing| given.fail(missing.message(name)))?;
    let real = std::fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
    if let Some(image) = call.state().images.get(&real) {
        return Ok(Arc::clone(image));
    }
    let (library, run) = (Arc::clone(&call.state().library), call.state().run);
    let image = library.images.get(&real, run, || load_image(&path)).map_err(|error| given.fail(error.to_string()))?;
    call.context.guard.charge_memory(call.lua, image.texels.bytes())?;
    call.state_mut().images.insert(real, Arc::clone(&image));
    Ok(image)
}
