//! The constants of one picture: camera, light counts, flags, and the plan of its work.

use super::instances::BuiltInstances;
use super::work::plan_work;
use crate::layout::{FRAME_BLINN, FRAME_SAMPLE_CENTRE, FRAME_SAMPLE_CORNER, FRAME_TRANSPARENT, Frame, NONE};
use crate::scene::{PixelOrigin, Scene, Specular};
use crate::{Error, Result};
use glam::{UVec2, Vec3};

/// Shadow rays of one camera ray at its first hit, over all lights; more are refused.
const MAX_SHADOW_RAYS: u64 = 1 << 24;

/// Reflections and refractions one after another; the reference renderer recurses once for each.
const MAX_DEPTH: u32 = 100;

/// The angle between neighbouring camera samples, radians: that between pixels, shared out to their samples as far as
/// these are reliably apart (as pbrt-v4 does, section 10.1.3).
fn sample_spread(scene: &Scene) -> f32 {
    let pixel = 2.0 * (0.5 * scene.camera.fov.to_radians()).tan() / f64::from(scene.size[1]);
    let share = (1.0 / f64::from(scene.sampling.camera.max(1)).sqrt()).max(0.125);
    (pixel * share) as f32
}

pub fn frame(scene: &Scene, built: &BuiltInstances) -> Result<Frame> {
    let camera = &scene.camera;
    let sampling = &scene.sampling;
    let right = camera.forward.cross(camera.up);
    let (Some(forward), Some(right)) = (camera.forward.try_normalize(), right.try_normalize()) else {
        return Err(Error::Scene("the camera's up vector is parallel to its direction of view".into()));
    };
    if !(camera.fov > 0.0 && camera.fov < 180.0) {
        return Err(Error::Scene(format!(
            "the camera's angle of view is {} degrees; it must lie between 0 and 180",
            camera.fov
        )));
    }
    if sampling.max_depth > MAX_DEPTH {
        return Err(Error::Scene(format!(
            "a depth of {} is asked for; at most {MAX_DEPTH} is possible",
            sampling.max_depth
        )));
    }
    let shadow_rays = scene.lights.len() as u64 * u64::from(sampling.shadow);
    if shadow_rays > MAX_SHADOW_RAYS {
        return Err(Error::Scene(format!(
            "{} lights with {} shadow rays each are {shadow_rays} rays for each camera ray; \
             at most {MAX_SHADOW_RAYS} are possible",
            scene.lights.len(),
            sampling.shadow
        )));
    }
    let mut flags = 0;
    if sampling.camera <= 1 {
        flags |= FRAME_SAMPLE_CENTRE;
    }
    if scene.conventions.sample == PixelOrigin::Corner {
        flags |= FRAME_SAMPLE_CORNER;
    }
    if scene.background.transparent {
        flags |= FRAME_TRANSPARENT;
    }
    if scene.conventions.specular == Specular::Blinn {
        flags |= FRAME_BLINN;
    }
    let [width, height] = scene.size;
    let frame = Frame {
        eye: camera.eye.as_vec3(),
        lens_edge: camera.lens_edge as f32,
        right: right.as_vec3(),
        tan_half_fov: (0.5 * camera.fov.to_radians()).tan() as f32,
        up: right.cross(forward).as_vec3(),
        focus_distance: camera.focus_distance as f32,
        forward: forward.as_vec3(),
        aspect: (f64::from(width) / f64::from(height)) as f32,
        ambient: scene.ambient,
        seed: sampling.seed,
        background_bottom: scene.background.bottom,
        flags,
        background_top: scene.background.top,
        max_depth: sampling.max_depth,
        medium: UVec2::ZERO,
        image_size: UVec2::new(width, height),
        plane_count: built.plane_count,
        bounded_count: built.surface_count,
        mist_count: built.instances.len() as u32 - built.plane_count - built.surface_count,
        mist_root: built.mist_root,
        light_count: scene.lights.len() as u32,
        background_image: NONE,
        pixel_spread: sample_spread(scene),
        ..Frame::default()
    };
    let vectors: [Vec3; 5] = [frame.eye, frame.ambient, frame.background_bottom, frame.background_top, frame.right];
    let numbers = [frame.lens_edge, frame.tan_half_fov, frame.focus_distance];
    if !(vectors.iter().all(|vector| vector.is_finite()) && numbers.iter().all(|number| number.is_finite())) {
        return Err(Error::Scene(
            "the camera, the ambient light or the background has numbers outside the range of single precision".into(),
        ));
    }
    Ok(plan_work(frame.light_count, sampling.shadow, sampling.glossy, 1).applied_to(frame))
}
