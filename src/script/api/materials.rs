//! Materials.

use super::Function;
use crate::scene::{Bump, Material};
use crate::script::arguments::{Call, Failure, MaterialHandle, Outcome};
use crate::script::fields::Fields;
use crate::script::given::Given;
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] = &[
    ("gr.material", 3, material),
    ("gr.refl_material", 6, refl_material),
    ("gr.texture_material", 6, texture_material),
    ("gr.bump_material", 8, bump_material),
    ("gr.perlin_bump_material", 7, perlin_bump_material),
    ("gr.volumetric_material", 4, volumetric_material),
];

const KEYS: &[&str] = &[
    "diffuse",
    "specular",
    "shininess",
    "reflection",
    "glossy",
    "ior",
    "texture",
    "bump",
    "noise",
    "density",
    "emission",
    "casts_shadow",
];

/// What a volume has no surface for.
const SURFACE_KEYS: &[&str] = &["reflection", "glossy", "ior", "bump", "noise", "emission", "texture", "casts_shadow"];

/// `gr.material({kd}, {ks}, shininess)`, Phong's; or `gr.material{…}` with any of [`KEYS`].
fn material(call: &Call) -> Outcome<Value> {
    match Fields::of_only_argument(call, KEYS) {
        Some(fields) => finish(call, build(call, &fields?)?),
        None => positional(call, &["diffuse", "specular", "shininess"], 3),
    }
}

/// `gr.refl_material({kd}, {ks}, shininess, REFL[, AREA[, IOR]])`.
fn refl_material(call: &Call) -> Outcome<Value> {
    positional(call, &["diffuse", "specular", "shininess", "reflection", "glossy", "ior"], 4)
}

/// `gr.texture_material(FILE, {ks}, shininess[, REFL, AREA, IOR])`: the diffuse colour is the image's.
fn texture_material(call: &Call) -> Outcome<Value> {
    positional(call, &["texture", "specular", "shininess", "reflection", "glossy", "ior"], 3)
}

/// `gr.bump_material(FILE, {kd}, {ks}, shininess, REFL, AREA, IOR, POS)`: with POS 1 the diffuse colour is the image's
/// too, with POS 2 it is kd.
fn bump_material(call: &Call) -> Outcome<Value> {
    let names = ["bump", "diffuse", "specular", "shininess", "reflection", "glossy", "ior", "position"];
    let fields = Fields::of_arguments(call, &names, 8);
    let mut material = build(call, &fields)?;
    let expected = "POS to be 1 (diffuse colour from the image) or 2 (from argument 2)";
    if fields.get("position").whole_number(expected, 1, 2)? == 1 {
        material.texture = Some(fields.get("bump").image()?);
    }
    finish(call, material)
}

/// `gr.perlin_bump_material({kd}, {ks}, shininess, REFL, AREA, IOR, Z_HEIGHT)`.
fn perlin_bump_material(call: &Call) -> Outcome<Value> {
    positional(call, &["diffuse", "specular", "shininess", "reflection", "glossy", "ior", "noise"], 7)
}

/// `gr.volumetric_material({kd}, {ks}, shininess, DENSITY)`.
fn volumetric_material(call: &Call) -> Outcome<Value> {
    positional(call, &["diffuse", "specular", "shininess", "density"], 4)
}

fn positional(call: &Call, names: &[&'static str], required: usize) -> Outcome<Value> {
    let material = build(call, &Fields::of_arguments(call, names, required))?;
    finish(call, material)
}

/// The material that the fields describe, whatever form they came in.
fn build(call: &Call, fields: &Fields) -> Outcome<Material> {
    fields.exclude(&[&["bump"], &["noise"]])?;
    warn_of_surface(call, fields);
    let plain = Material::default();
    let at_least_0 = |key, default, expected: &str| {
        fields.get(key).or(default, |given| Ok(given.number_where(expected, |number| number >= 0.0)? as f32))
    };
    let image = fields.get("bump").optional(Given::image)?.map(Bump::Image);
    let noise =
        fields.get("noise").optional(|given| given.number_where("a height in the noise, a number", |_| true))?;
    Ok(Material {
        texture: fields.get("texture").optional(Given::image)?,
        diffuse: fields.get("diffuse").or(plain.diffuse, Given::colour)?,
        specular: fields.get("specular").or(plain.specular, Given::colour)?,
        shininess: at_least_0("shininess", plain.shininess, "a shininess of at least 0")?,
        reflection: at_least_0("reflection", plain.reflection, "a reflectance of at least 0")?,
        glossy: at_least_0("glossy", plain.glossy, "the edge of the glossy square, at least 0")?,
        ior: fields.get("ior").optional(refractive_index)?.flatten(),
        bump: image.or(noise.map(|z| Bump::Noise { z: z as f32 })),
        density: fields.get("density").optional(density)?,
        emission: fields.get("emission").or(plain.emission, Given::colour)?,
        casts_shadow: fields.get("casts_shadow").or(plain.casts_shadow, Given::flag)?,
    })
}

fn refractive_index(given: &Given) -> Outcome<Option<f32>> {
    let expected = "a refractive index above 0, or -1 for none";
    let ior = given.number_where(expected, |ior| ior as f32 > 0.0 || ior == -1.0)?;
    Ok((ior > 0.0).then_some(ior as f32))
}

fn density(given: &Given) -> Outcome<f32> {
    let inside = |density: f64| density as f32 > 0.0 && density <= 1.0;
    Ok(given.number_where("a density above 0 and at most 1", inside)? as f32)
}

fn warn_of_surface(call: &Call, fields: &Fields) {
    let idle: Vec<String> = SURFACE_KEYS.iter().filter(|key| fields.has(key)).map(|key| format!("'{key}'")).collect();
    if fields.has("density") && !idle.is_empty() {
        let keys = idle.join(", ");
        let message = format!("gr.material: with 'density' the shape is mist and has no surface; {keys} does nothing");
        call.state_mut().warn(call.lua, &message);
    }
}

fn finish(call: &Call, material: Material) -> Outcome<Value> {
    call.context.guard.charge_memory(call.lua, size_of::<Material>()).map_err(Failure::Lua)?;
    let id = call.state_mut().add_material(material);
    Ok(Value::UserData(call.lua.create_userdata(MaterialHandle(id))?))
}
