//! Camera rays; twin of `shaders/camera.wgsl`.

use crate::cpu::dimensions::{DIMENSION_LENS, DIMENSION_PIXEL};
use crate::cpu::math::elementary::unit_vector;
use crate::cpu::math::rng::{hash_combine, sobol_2d};
use crate::layout::{FRAME_SAMPLE_CENTRE, FRAME_SAMPLE_CORNER, Frame};
use glam::{UVec2, Vec2, Vec3};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    pub origin: Vec3,
    /// Unit.
    pub direction: Vec3,
    /// The key of all random numbers of this pixel.
    pub key: u32,
    /// Angle to the neighbouring camera samples, radians.
    pub spread: f32,
}

/// A pixel of the flat picture is seen under a solid angle that falls with the cube of the cosine of its direction's
/// angle to the axis: twice for its distance, once for its slant. The edge of a square of that solid angle is the root.
fn sample_spread(frame: &Frame, direction: Vec3) -> f32 {
    let cosine = direction.dot(frame.forward).max(0.0);
    frame.pixel_spread * cosine * cosine.sqrt()
}

/// The ray of camera sample `sample_index` through a pixel (column, row from the top): jittered in the pixel, from a
/// square lens (Cook, Porter, Carpenter 1984, section 4).
pub fn camera_ray(frame: &Frame, pixel: UVec2, sample_index: u32) -> CameraRay {
    let key = hash_combine(hash_combine(frame.seed, pixel.x), pixel.y);
    let mut offset = Vec2::splat(0.5);
    if frame.flags & FRAME_SAMPLE_CENTRE == 0 {
        offset = sobol_2d(sample_index, hash_combine(key, DIMENSION_PIXEL));
    }
    if frame.flags & FRAME_SAMPLE_CORNER != 0 {
        offset -= Vec2::splat(0.5);
    }
    let size = frame.image_size.as_vec2();
    let ndc = 2.0 * (pixel.as_vec2() + offset) / size - Vec2::ONE;
    let x = ndc.x * frame.aspect * frame.tan_half_fov;
    let y = -ndc.y * frame.tan_half_fov;
    let through = frame.forward + x * frame.right + y * frame.up;
    if frame.lens_edge == 0.0 {
        let direction = unit_vector(through);
        return CameraRay { origin: frame.eye, direction, key, spread: sample_spread(frame, direction) };
    }
    let xi = sobol_2d(sample_index, hash_combine(key, DIMENSION_LENS));
    let lens = frame.lens_edge * ((xi.x - 0.5) * frame.right + (xi.y - 0.5) * frame.up);
    let direction = unit_vector(frame.focus_distance * through - lens);
    CameraRay { origin: frame.eye + lens, direction, key, spread: sample_spread(frame, direction) }
}
