//! `gr.render`: from arguments, or the keys of a table, to a [`Scene`].

use super::background::background;
use super::camera::{self, camera};
use crate::error::Result as RenderResult;
use crate::scene::{Camera, Light, Sampling, Scene, Transfer};
use crate::script::arguments::{Call, Failure, LightHandle, Outcome};
use crate::script::conventions::ViewConvention;
use crate::script::diagnostics::nearest;
use crate::script::fields::Fields;
use crate::script::given::Given;
use glam::Vec3;
use mlua::Value;
use std::path::PathBuf;
use std::sync::Arc;

/// Arguments that `gr.render` takes.
pub(in crate::script) const MOST_ARGUMENTS: usize = 15;

/// The table's keys.
const KEYS: &[&str] = &[
    "scene",
    "output",
    "size",
    "camera",
    "ambient",
    "lights",
    "samples",
    "shadow",
    "glossy",
    "max_depth",
    "background",
    "transfer",
    "seed",
];

/// Largest width and height of a picture.
const LARGEST_EDGE: f64 = 65535.0;

/// Width and height of a picture that does not say, pixels.
const USUAL_SIZE: [u32; 2] = [640, 480];

/// Largest AA, GLOSSY, SHADOW and DOF, and largest product AA² · DOF.
const LARGEST_COUNT: u32 = 65535;
const LARGEST_CAMERA_SAMPLES: u32 = 1 << 24;

/// As on the command line.
const LARGEST_DEPTH: u32 = 1000;

/// `gr.render{…}` with [`KEYS`], or
/// `gr.render(node, file, w, h, {eye}, {view}, {up}, fov, {ambient}, {lights}[, AA, GLOSSY, SHADOW, DOF, LENS])`.
pub(in crate::script) fn render(call: &Call, render: &mut dyn FnMut(Scene) -> RenderResult<()>) -> Outcome<Value> {
    let scene = match Fields::of_only_argument(call, KEYS) {
        Some(fields) => {
            let fields = fields?;
            let size = fields.get("size").or(USUAL_SIZE, size)?;
            build(call, &fields, size, || camera(&fields.inner("camera", camera::KEYS)?))?
        }
        None => positional(call)?,
    };
    call.state_mut().warn_of_bare_nodes(call.lua, scene.root);
    match render(scene) {
        Ok(()) => {
            call.state_mut().pictures += 1;
            Ok(Value::Nil)
        }
        Err(error) => Err(Failure::Lua(call.context.guard.stop(call.lua, error))),
    }
}

/// The positional form: its arguments under the names of the table's keys, and the five counts.
fn positional(call: &Call) -> Outcome<Scene> {
    let view = match call.state().conventions.view() {
        ViewConvention::Point => "look_at",
        ViewConvention::Direction => "direction",
    };
    let names = [
        "scene", "output", "width", "height", "eye", view, "up", "fov", "ambient", "lights", "AA", "glossy", "shadow",
        "DOF", "lens",
    ];
    let fields = Fields::of_arguments(call, &names, 10);
    // Before the size, as they stand in the call.
    fields.get("scene").node()?;
    output(&fields.get("output"))?;
    let size = [edge(&fields.get("width"), "a width")?, edge(&fields.get("height"), "a height")?];
    let scene = build(call, &fields, size, || camera(&fields))?;

    let antialiasing = fields.get("AA").or(1, |given| count(given, "AA"))?;
    let depth_of_field = fields.get("DOF").or(1, |given| count(given, "DOF"))?;
    let camera_samples = antialiasing
        .checked_mul(antialiasing)
        .and_then(|samples| samples.checked_mul(depth_of_field))
        .filter(|samples| *samples <= LARGEST_CAMERA_SAMPLES)
        .ok_or_else(|| Failure::Call(format!("AA² · DOF is more than {LARGEST_CAMERA_SAMPLES} camera samples")))?;
    let lens_edge = if depth_of_field > 1 { scene.camera.lens_edge } else { 0.0 };
    Ok(Scene {
        camera: Camera { lens_edge, ..scene.camera },
        sampling: Sampling { camera: camera_samples, ..scene.sampling },
        ..scene
    })
}

/// The picture that the fields describe, whatever form they came in.
fn build(call: &Call, fields: &Fields, size: [u32; 2], camera: impl FnOnce() -> Outcome<Camera>) -> Outcome<Scene> {
    let usual = Sampling::default();
    let (seed, usual_background) = {
        let state = call.state();
        (state.seed, state.background.clone())
    };
    let root = fields.get("scene").node()?;
    let output = output(&fields.get("output"))?;
    let camera = camera()?;
    let ambient = fields.get("ambient").or(Vec3::ZERO, Given::colour)?;
    let lights = fields.get("lights").or(Vec::new(), lights)?;
    let sampling = Sampling {
        camera: fields.get("samples").or(usual.camera, |given| {
            let expected = format!("a whole number from 1 to {LARGEST_CAMERA_SAMPLES}");
            given.whole_number(&expected, 1, LARGEST_CAMERA_SAMPLES)
        })?,
        glossy: fields.get("glossy").or(usual.glossy, |given| count(given, "GLOSSY"))?,
        shadow: fields.get("shadow").or(usual.shadow, |given| count(given, "SHADOW"))?,
        max_depth: fields.get("max_depth").or(usual.max_depth, |given| {
            given.whole_number(&format!("a whole number from 0 to {LARGEST_DEPTH}"), 0, LARGEST_DEPTH)
        })?,
        seed: fields
            .get("seed")
            .or(seed, |given| given.whole_number(&format!("a whole number from 0 to {}", u32::MAX), 0, u32::MAX))?,
    };
    let background = fields.get("background").or(usual_background, background)?;
    let transfer = fields.get("transfer").or(Transfer::default(), transfer)?;
    let state = call.state();
    Ok(Scene {
        graph: Arc::clone(state.graph()),
        root,
        camera,
        ambient,
        lights,
        background,
        sampling,
        conventions: state.conventions.rendering(),
        output,
        size,
        transfer,
    })
}

fn output(given: &Given) -> Outcome<PathBuf> {
    let expected = "the name of the picture's file";
    match given.text(expected)? {
        name if name.is_empty() || name.contains('\0') => Err(given.unexpected(expected)),
        name => Ok(PathBuf::from(name)),
    }
}

fn size(given: &Given) -> Outcome<[u32; 2]> {
    let edges = given.tuple::<2>()?;
    if edges.into_iter().all(is_edge) {
        return Ok(edges.map(|edge| edge.trunc() as u32));
    }
    let [width, height] = edges;
    Err(given.fail(format!("expected a width and a height of 1 to 65535 pixels, got {{{width}, {height}}}")))
}

fn edge(given: &Given, what: &str) -> Outcome<u32> {
    Ok(given.number_where(&format!("{what} of 1 to 65535 pixels"), is_edge)?.trunc() as u32)
}

fn is_edge(pixels: f64) -> bool {
    (1.0..=LARGEST_EDGE).contains(&pixels.trunc())
}

fn lights(given: &Given) -> Outcome<Vec<Light>> {
    let table = given.table("a table of lights")?;
    let mut lights = Vec::with_capacity(table.raw_len());
    for position in 1..=table.raw_len() {
        let value = table.raw_get::<Value>(position)?;
        let light = match &value {
            Value::UserData(data) => data.borrow::<LightHandle>().map(|handle| handle.0).ok(),
            _ => None,
        };
        lights.push(light.ok_or_else(|| {
            given.fail(format!("expected a table of lights, got {} at [{position}]", given.call.describe(&value)))
        })?);
    }
    Ok(lights)
}

fn count(given: &Given, name: &str) -> Outcome<u32> {
    let subject = if given.is_argument() { format!("{name} to be ") } else { String::new() };
    given.whole_number(&format!("{subject}a whole number from 1 to {LARGEST_COUNT}"), 1, LARGEST_COUNT)
}

fn transfer(given: &Given) -> Outcome<Transfer> {
    let expected = "\"linear\" or \"srgb\"";
    match given.text(expected)?.as_str() {
        "linear" => Ok(Transfer::Linear),
        "srgb" => Ok(Transfer::Srgb),
        other => {
            let hint = nearest(other, ["linear", "srgb"].into_iter());
            let hint = hint.map_or_else(String::new, |near| format!("; did you mean \"{near}\"?"));
            Err(given.fail(format!("expected {expected}, got the text '{other}'{hint}")))
        }
    }
}
