// What maps do to a surface: its colour from a texture, its normal from a bump map.
fn surface_detail(hit: Hit, surface: Surface, direction: vec3<f32>, cone_width: f32) -> Surface { return surface; }
