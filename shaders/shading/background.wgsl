// What rays that leave the scene see: a gradient over the height of their direction, or a picture all around.
fn background(direction: vec3<f32>) -> vec3<f32> {
    if (HAS_BACKGROUND_IMAGE && frame.background_image != NONE) {
        return environment_lookup(frame.background_image, direction);
    }
    return mix_colour(frame.background_bottom, frame.background_top, 0.5 + 0.5 * direction.y);
}

fn mix_colour(a: vec3<f32>, b: vec3<f32>, t: f32) -> vec3<f32> {
    return a + (b - a) * t;
}
