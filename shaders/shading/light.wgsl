// Lights: where shadow rays aim, and what arrives.

// The light of a number. Few (FEW_LIGHTS in src/flatten/features.rs) are told apart by constants: lavapipe loads at once
// what all lanes surely share, which the turns of a loop aren't, and lane by lane what each may choose.
fn light_at(index: u32) -> Light {
    if (HAS_MANY_LIGHTS) {
        return lights[index];
    }
    var light = lights[0];
    if (index == 1u) { light = lights[1]; }
    if (index == 2u) { light = lights[2]; }
    if (index == 3u) { light = lights[3]; }
    return light;
}

// A point on the light as seen from `point` (world space): the point itself, uniform over a parallelogram, or uniform in
// the solid angle of a ball (a point within the ball sees its whole surface).
fn sample_light(light: Light, point: vec3<f32>, xi: vec2<f32>) -> vec3<f32> {
    if (!HAS_AREA_LIGHT || light.kind == LIGHT_POINT) {
        return light.position;
    }
    if (light.kind == LIGHT_PARALLELOGRAM) {
        return light.position + (xi.x - 0.5) * light.u + (xi.y - 0.5) * light.v;
    }
    let to_centre = light.position - point;
    let distance_squared = dot(to_centre, to_centre);
    let radius_squared = light.radius * light.radius;
    let inside = distance_squared <= radius_squared;
    // 1 - cos of the cone that touches the ball, without cancellation (pbrt-v4, section 6.2.4).
    let sine_squared = radius_squared / distance_squared;
    let one_minus_cos = select(sine_squared / (1.0 + sqrt(1.0 - sine_squared)), 2.0, inside);
    let axis = select(to_centre / sqrt(distance_squared), vec3<f32>(0.0, 0.0, 1.0), inside);
    let direction = sample_cone(axis, one_minus_cos, xi);
    if (inside) {
        return light.position + light.radius * direction;
    }
    let along = dot(direction, to_centre);
    let half_chord = sqrt(max(radius_squared - max(distance_squared - along * along, 0.0), 0.0));
    return point + (along - half_chord) * direction;
}

// Share of the light's colour that arrives over `distance` (world units).
fn attenuation(light: Light, distance: f32) -> f32 {
    let c = light.falloff;
    return 1.0 / max(c.x + c.y * distance + c.z * distance * distance, 1e-20);
}

// The light samples that a hit takes, first and last + 1. At depth 0 a pass takes its slice of light_count *
// shadow_count samples; deeper, each light gets one, or where lights are many a stratified choice of them.
fn light_sample_range(depth: u32) -> vec2<u32> {
    if (depth > 0u) {
        return vec2<u32>(0u, frame.deep_light_samples);
    }
    let first = dispatch.pass_index * frame.light_samples;
    return vec2<u32>(first, min(first + frame.light_samples, frame.light_count * frame.shadow_count));
}

// A shadow ray from a surface to a point of a light.
struct LightSample {
    // Where it starts, and the way to the light: t = 1 is there.
    origin: vec3<f32>,
    to_light: vec3<f32>,
    // What the surface sends to the viewer if nothing is in between.
    radiance: vec3<f32>,
};

// Light from the unit direction l that goes to the viewer at v. Mist scatters it whatever the directions are.
fn reflected_light(surface: Surface, material: Material, l: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    if (HAS_MIST && is_mist_event(surface)) {
        return surface.diffuse;
    }
    var coloured = material;
    coloured.diffuse = surface.diffuse;
    let reflected = phong(coloured, surface.shading_normal, l, v, (frame.flags & FRAME_BLINN) != 0u);
    // A normal that interpolation or a map has turned must not let in light from below the true surface.
    return select(vec3<f32>(0.0), reflected, dot(surface.geometric_normal, l) > 0.0);
}

// One term of Whitted's sum over the lights, with soft shadows by distributed shadow rays (Cook, Porter, Carpenter
// 1984, section 4). v is the unit vector to the viewer; index, key and depth are those of the ray that came.
fn light_sample(surface: Surface, material: Material, v: vec3<f32>, index: u32, key: u32, depth: u32, sample: u32) -> LightSample {
    var light_index = sample;
    var split_index = index;
    var weight = 1.0;
    if (depth == 0u) {
        light_index = sample / frame.shadow_count;
        split_index = index * frame.shadow_count + sample % frame.shadow_count;
        weight = f32(frame.pass_count) / f32(frame.shadow_count);
    } else if (frame.light_count > frame.deep_light_samples) {
        let choice = sobol_2d(index, hash_combine(key, DIMENSION_LIGHT_CHOICE)).x;
        let share = f32(frame.light_count) / f32(frame.deep_light_samples);
        light_index = min(u32((f32(sample) + choice) * share), frame.light_count - 1u);
        weight = share;
    }
    let light = light_at(light_index);
    var xi = vec2<f32>(0.5);
    if (HAS_AREA_LIGHT) {
        xi = sobol_2d(split_index, hash_combine(key, DIMENSION_LIGHT + light_index));
    }
    let on_light = sample_light(light, surface.point, xi);
    let from_surface = on_light - surface.point;
    let distance = sqrt(dot(from_surface, from_surface));
    let l = from_surface / max(distance, 1e-20);
    let reflected = reflected_light(surface, material, l, v);
    let radiance = (weight * attenuation(light, distance)) * (light.colour * reflected);
    let origin = offset_ray_origin(surface.point, surface.geometric_normal);
    return LightSample(origin, on_light - origin, radiance);
}

// A shadow ray ends just before t = 1: a surface that carries the light does not shade it.
const SHADOW_T_MAX: f32 = 0.9999;
