// Images in the texel buffer: bilinear, repeated, filtered by the width of the ray.
fn environment_lookup(image: u32, direction: vec3<f32>) -> vec3<f32> { return vec3<f32>(0.0); }
