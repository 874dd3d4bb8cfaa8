// Camera rays: jittered in the pixel, from a square lens (Cook, Porter, Carpenter 1984, section 4).

struct CameraRay {
    origin: vec3<f32>,
    // Unit.
    direction: vec3<f32>,
    // The key of all random numbers of this pixel.
    key: u32,
};

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
        return CameraRay(frame.eye, unit_vector(through), key);
    }
    let xi = sobol_2d(sample_index, hash_combine(key, DIMENSION_LENS));
    let lens = frame.lens_edge * ((xi.x - 0.5) * frame.right + (xi.y - 0.5) * frame.up);
    return CameraRay(frame.eye + lens, unit_vector(frame.focus_distance * through - lens), key);
}
