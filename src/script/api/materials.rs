//! Materials.

use super::Function;
use crate::scene::Material;
use crate::script::arguments::{Call, MaterialHandle, Outcome};
use glam::{DVec3, Vec3};
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] = &[("gr.material", 3, material), ("gr.refl_material", 6, refl_material)];

pub(super) fn colour(call: &Call, index: usize) -> Outcome<Vec3> {
    Ok(DVec3::from_array(call.tuple(index)?).as_vec3())
}

/// `gr.material({kd}, {ks}, shininess)`: Phong's.
fn material(call: &Call) -> Outcome<Value> {
    let material = phong(call)?;
    make_material(call, material)
}

/// `gr.refl_material({kd}, {ks}, shininess, REFL[, AREA[, IOR]])`.
fn refl_material(call: &Call) -> Outcome<Value> {
    let not_negative = |index, expected| call.number_where(index, expected, |number| number >= 0.0);
    let mut material = phong(call)?;
    material.reflection = not_negative(3, "a reflectance of at least 0")? as f32;
    if !call.absent(4) {
        material.glossy = not_negative(4, "the edge of the glossy square, at least 0")? as f32;
    }
    if !call.absent(5) {
        let expected = "a refractive index above 0, or -1 for none";
        let ior = call.number_where(5, expected, |ior| ior > 0.0 || ior == -1.0)?;
        material.ior = (ior > 0.0).then_some(ior as f32);
    }
    make_material(call, material)
}

fn phong(call: &Call) -> Outcome<Material> {
    Ok(Material {
        diffuse: colour(call, 0)?,
        specular: colour(call, 1)?,
        shininess: call.number_where(2, "a shininess of at least 0", |shininess| shininess >= 0.0)? as f32,
        ..Material::default()
    })
}

fn make_material(call: &Call, material: Material) -> Outcome<Value> {
    call.context.guard.charge_memory(call.lua, size_of::<Material>())?;
    let id = call.state_mut().add_material(material);
    Ok(Value::UserData(call.lua.create_userdata(MaterialHandle(id))?))
}
