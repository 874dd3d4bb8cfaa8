//! `gr.render`: from positional arguments to a [`Scene`].

use crate::error::Result as RenderResult;
use crate::scene::{Background, Camera, Light, NodeId, Sampling, Scene, Transfer};
use crate::script::arguments::{Call, Failure, LightHandle, Outcome};
use crate::script::conventions::ViewConvention;
use glam::{DVec3, Vec3};
use mlua::Value;
use std::path::PathBuf;
use std::sync::Arc;

/// Arguments that `gr.render` takes.
pub(in crate::script) const MOST_ARGUMENTS: usize = 15;

/// Largest width and height of a picture.
const LARGEST_EDGE: f64 = 65535.0;

/// Largest AA, GLOSSY, SHADOW and DOF, and largest product AA² · DOF.
const LARGEST_COUNT: u32 = 65535;
const LARGEST_CAMERA_SAMPLES: u32 = 1 << 24;

/// Sine of the angle between up and the direction of view below which they count as parallel.
const PARALLEL: f64 = 1e-9;

/// A picture as the script describes it.
struct Picture {
    root: NodeId,
    output: PathBuf,
    size: [u32; 2],
    camera: Camera,
    ambient: Vec3,
    lights: Vec<Light>,
    counts: SampleCounts,
}

/// The five counts: 1 is off.
struct SampleCounts {
    /// The square root of the jittered camera samples.
    antialiasing: u32,
    glossy: u32,
    shadow: u32,
    depth_of_field: u32,
    /// Edge of the square lens, world units.
    lens: f64,
}

/// `gr.render(node, file, w, h, {eye}, {view}, {up}, fov, {ambient}, {lights}[, AA, GLOSSY, SHADOW, DOF, LENS])`.
pub(in crate::script) fn render(call: &Call, render: &mut dyn FnMut(Scene) -> RenderResult<()>) -> Outcome<Value> {
    let picture = Picture {
        root: call.node(0)?,
        output: output(call)?,
        size: [edge(call, 2)?, edge(call, 3)?],
        camera: camera(call)?,
        ambient: super::materials::colour(call, 8)?,
        lights: lights(call)?,
        counts: sample_counts(call)?,
    };
    call.state_mut().warn_of_bare_nodes(call.lua, picture.root);
    let scene = picture.scene(call)?;
    match render(scene) {
        Ok(()) => {
            call.state_mut().pictures += 1;
            Ok(Value::Nil)
        }
        Err(error) => Err(Failure::Lua(call.context.guard.stop(call.lua, error))),
    }
}

impl Picture {
    fn scene(self, call: &Call) -> Outcome<Scene> {
        let counts = &self.counts;
        let camera_samples = counts
            .antialiasing
            .checked_mul(counts.antialiasing)
            .and_then(|samples| samples.checked_mul(counts.depth_of_field))
            .filter(|samples| *samples <= LARGEST_CAMERA_SAMPLES)
            .ok_or_else(|| Failure::Call(format!("AA² · DOF is more than {LARGEST_CAMERA_SAMPLES} camera samples")))?;
        let lens_edge = if counts.depth_of_field > 1 { counts.lens } else { 0.0 };
        let state = call.state();
        Ok(Scene {
            graph: Arc::clone(state.graph()),
            root: self.root,
            camera: Camera { lens_edge, ..self.camera },
            ambient: self.ambient,
            lights: self.lights,
            background: Background::default(),
            sampling: Sampling {
                camera: camera_samples,
                shadow: counts.shadow,
                glossy: counts.glossy,
                seed: state.seed,
                ..Sampling::default()
            },
            conventions: state.conventions.rendering(),
            output: self.output,
            size: self.size,
            transfer: Transfer::default(),
        })
    }
}

fn output(call: &Call) -> Outcome<PathBuf> {
    let expected = "the name of the picture's file";
    match call.text(1, expected)? {
        name if name.is_empty() || name.contains('\0') => Err(call.unexpected(1, expected)),
        name => Ok(PathBuf::from(name)),
    }
}

fn edge(call: &Call, index: usize) -> Outcome<u32> {
    let expected = if index == 2 { "a width of 1 to 65535 pixels" } else { "a height of 1 to 65535 pixels" };
    let pixels = call.number_where(index, expected, |pixels| (1.0..=LARGEST_EDGE).contains(&pixels.trunc()))?;
    Ok(pixels.trunc() as u32)
}

fn camera(call: &Call) -> Outcome<Camera> {
    let eye = DVec3::from_array(call.tuple(4)?);
    let view = DVec3::from_array(call.tuple(5)?);
    let up = DVec3::from_array(call.tuple(6)?);
    let fov =
        call.number_where(7, "a vertical angle of view between 0 and 180 degrees", |fov| 0.0 < fov && fov < 180.0)?;
    let (gaze, hint) = match call.state().conventions.view() {
        ViewConvention::Point => (view - eye, "a point to look at that is not the eye itself (or view=\"direction\")"),
        ViewConvention::Direction => (view, "a direction of view that is not zero"),
    };
    let distance = gaze.length();
    let forward = gaze / distance;
    if !forward.is_finite() {
        return Err(Failure::Argument { index: 5, message: format!("expected {hint}, got {}", vector(view)) });
    }
    let up_length = up.length();
    if forward.cross(up).length() <= PARALLEL * up_length {
        let message =
            format!("expected an up that is not along the direction of view {}, got {}", vector(forward), vector(up));
        return Err(Failure::Argument { index: 6, message });
    }
    Ok(Camera { eye, forward, up, fov, lens_edge: 0.0, focus_distance: distance })
}

fn vector(v: DVec3) -> String {
    format!("{{{}, {}, {}}}", v.x, v.y, v.z)
}

fn lights(call: &Call) -> Outcome<Vec<Light>> {
    let table = call.table(9, "a table of lights")?;
    let mut lights = Vec::with_capacity(table.raw_len());
    for position in 1..=table.raw_len() {
        let value = table.raw_get::<Value>(position)?;
        let light = match &value {
            Value::UserData(data) => data.borrow::<LightHandle>().map(|handle| handle.0).ok(),
            _ => None,
        };
        lights.push(light.ok_or_else(|| Failure::Argument {
            index: 9,
            message: format!("expected a table of lights, got {} at [{position}]", call.describe(&value)),
        })?);
    }
    Ok(lights)
}

fn sample_counts(call: &Call) -> Outcome<SampleCounts> {
    let count = |index, name| {
        if call.absent(index) {
            return Ok(1);
        }
        let expected = format!("{name} to be a whole number from 1 to {LARGEST_COUNT}");
        let whole = |n: f64| n.fract() == 0.0 && (1.0..=f64::from(LARGEST_COUNT)).contains(&n);
        call.number_where(index, &expected, whole).map(|n| n as u32)
    };
    let lens = || {
        if call.absent(14) {
            return Ok(0.0);
        }
        call.number_where(14, "LENS, the edge of the lens, to be at least 0", |edge| edge >= 0.0)
    };
    Ok(SampleCounts {
        antialiasing: count(10, "AA")?,
        glossy: count(11, "GLOSSY")?,
        shadow: count(12, "SHADOW")?,
        depth_of_field: count(13, "DOF")?,
        lens: lens()?,
    })
}
