// Camera rays: jittered in the pixel, from a square lens (Cook, Porter, Carpenter 1984, section 4).

struct CameraRay {
    origin: vec3<f32>,
    // Unit.
    direction: vec3<f32>,
    // The key of all random numbers of this pixel.
    key: u32,
    // Angle to the neighbouring camera samples, radians.
    spread: f32,
};

// A pixel of the flat picture is seen under a solid angle that falls with the cube of the cosine of its direction's
// angle to the axis: twice for its distance, once for its slant. The edge of a square of that solid angle is the root.
fn sample_spread(direction: vec3<f32>) -> f32 {
    let cosine = max(dot(direction, frame.forward), 0.0);
    return frame.pixel_spread * cosine * sqrt(cosine);
}

// The ray of camera sample `sample_index` through a pixel (column, row from the top).
fn camera_ray(pixel: vec2<u32>, sample_index: u32) -> CameraRay {
    let key = hash_combine(hash_combine(frame.seed, pixel.x), pixel.y);
    var offset = vec2<f32>(0.5);
    if ((frame.flags & FRAME_SAMPLE_CENTRE) == 0u) {
        offset = sobol_2d(sample_index, hash_combine(key, DIMENSION_PIXEL));
    }
    if ((frame.flags & FRAME_SAMPLE_CORNER) != 0u) {
        offset -= vec2<f32>(0.5);
    }
    let size = vec2<f32>(frame.image_size);
    let ndc = 2.0 * (vec2<f32>(pixel) + offset) / size - vec2<f32>(1.0);
    let x = ndc.x * frame.aspect * frame.tan_half_fov;
    let y = -ndc.y * frame.tan_half_fov;
    let through = frame.forward + x * frame.right + y * frame.up;
    if (!HAS_LENS) {
        let direction = unit_vector(through);
        return CameraRay(frame.eye, direction, key, sample_spread(direction));
    }
    let xi = sobol_2d(sample_index, hash_combine(key, DIMENSION_LENS));
    let lens = frame.lens_edge * ((xi.x - 0.5) * frame.right + (xi.y - 0.5) * frame.up);
    let direction = unit_vector(frame.focus_distance * through - lens);
    return CameraRay(frame.eye + lens, direction, key, sample_spread(direction));
}
