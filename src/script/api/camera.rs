//! The camera of a picture.

use crate::scene::Camera;
use crate::script::arguments::Outcome;
use crate::script::fields::Fields;
use crate::script::given::Given;
use glam::DVec3;

/// The keys of `camera` in `gr.render{…}`.
pub(super) const KEYS: &[&str] = &["eye", "look_at", "direction", "up", "fov", "lens", "focus"];

/// Where a camera that does not say stands, looking at the origin; and its vertical angle of view in degrees.
const USUAL_EYE: DVec3 = DVec3::new(0.0, 0.0, 5.0);
const USUAL_FOV: f64 = 50.0;

/// Sine of the angle between up and the direction of view below which they count as parallel.
const PARALLEL: f64 = 1e-9;

/// The camera that the fields describe, with those among [`KEYS`] that they have.
pub(super) fn camera(fields: &Fields) -> Outcome<Camera> {
    fields.exclude(&[&["look_at"], &["direction"]])?;
    let eye = fields.get("eye").or(USUAL_EYE, Given::vector)?;
    let (gaze, gaze_error) = if fields.has("direction") {
        let given = fields.get("direction");
        let direction = given.vector()?;
        (direction, given.fail(format!("expected a direction of view that is not zero, got {}", vector(direction))))
    } else {
        let given = fields.get("look_at");
        let point = given.or(DVec3::ZERO, Given::vector)?;
        let hint = if given.is_argument() { " (or view=\"direction\")" } else { "" };
        let expected = format!("a point to look at that is not the eye itself{hint}");
        (point - eye, given.fail(format!("expected {expected}, got {}", vector(point))))
    };
    let up_given = fields.get("up");
    let up = up_given.or(DVec3::Y, Given::vector)?;
    let fov = fields.get("fov").or(USUAL_FOV, |given| {
        given.number_where("a vertical angle of view between 0 and 180 degrees", |fov| 0.0 < fov && fov < 180.0)
    })?;
    let distance = gaze.length();
    let forward = gaze / distance;
    if !forward.is_finite() {
        return Err(gaze_error);
    }
    if forward.cross(up).length() <= PARALLEL * up.length() {
        let (forward, up) = (vector(forward), vector(up));
        let message = format!("expected an up that is not along the direction of view {forward}, got {up}");
        return Err(up_given.fail(message));
    }
    let lens_edge = fields.get("lens").or(0.0, |given| {
        let argument = "LENS, the edge of the lens, to be at least 0";
        let expected = if given.is_argument() { argument } else { "the edge of the lens, at least 0" };
        given.number_where(expected, |edge| edge >= 0.0)
    })?;
    let focus_distance = fields
        .get("focus")
        .or(distance, |given| given.number_where("a distance above 0", |distance| distance as f32 > 0.0))?;
    Ok(Camera { eye, forward, up, fov, lens_edge, focus_distance })
}

fn vector(v: DVec3) -> String {
    format!("{{{}, {}, {}}}", v.x, v.y, v.z)
}
