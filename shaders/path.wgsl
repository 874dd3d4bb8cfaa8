// The tree of rays under one camera ray, walked with an explicit stack. A hit of a camera ray may split; deeper, each
// choice takes one ray by Russian roulette, so that the stack never holds more than the splits of one hit.

// Keys of the random decisions of a ray, and of the rays it spawns; see hash_combine.
const DIMENSION_PIXEL: u32 = 1u;
const DIMENSION_LENS: u32 = 2u;
const DIMENSION_GLOSSY: u32 = 3u;
const DIMENSION_CHOICE: u32 = 4u;
const DIMENSION_LIGHT_CHOICE: u32 = 5u;
const BRANCH_REFLECTED: u32 = 6u;
const BRANCH_REFRACTED: u32 = 7u;
// Light i has the dimension DIMENSION_LIGHT + i.
const DIMENSION_LIGHT: u32 = 16u;

// The splits of one hit in one pass: glossy rays (`MAX_GLOSSY_SAMPLES` in src/flatten/work.rs) and a refracted one.
const RAY_STACK_SIZE: u32 = 5u;
const T_INFINITY: f32 = 3.0e38;

struct Ray {
    origin: vec3<f32>,
    // Unit.
    direction: vec3<f32>,
    // Share of this ray's radiance in the camera ray's.
    weight: f32,
    media: vec2<u32>,
    // Number among the samples that share `key`, and the key of its random decisions.
    index: u32,
    key: u32,
    depth: u32,
};

var<private> ray_stack: array<Ray, RAY_STACK_SIZE>;
var<private> ray_stack_size: u32;

fn push_ray(ray: Ray) {
    if (ray_stack_size == RAY_STACK_SIZE) {
        tally.flags |= STATUS_STACK_FULL;
        return;
    }
    ray_stack[ray_stack_size] = ray;
    ray_stack_size++;
}

// Radiance of a ray that leaves the scene: a gradient over the height of its direction.
fn background(direction: vec3<f32>) -> vec3<f32> {
    return mix_colour(frame.background_bottom, frame.background_top, 0.5 + 0.5 * direction.y);
}

fn mix_colour(a: vec3<f32>, b: vec3<f32>, t: f32) -> vec3<f32> {
    return a + (b - a) * t;
}

// The shares of reflected and refracted light at a surface, and where the refracted ray goes.
struct Scattering {
    reflected: f32,
    refracted: f32,
    direction: vec3<f32>,
    media: vec2<u32>,
};

// Only reflective: REFL. Only refractive: everything goes through. Both: F * REFL and 1 - F. Total internal reflection
// reflects everything.
fn scatter(surface: Surface, material: Material, ray: Ray) -> Scattering {
    var scattering = Scattering(material.reflection, 0.0, vec3<f32>(0.0), ray.media);
    if (HAS_REFRACTION && material.ior > 0.0) {
        var n1 = media_index(ray.media);
        var media: vec2<u32>;
        var n2: f32;
        if (surface.entering) {
            media = media_enter(ray.media, material.medium);
            n2 = material.ior;
        } else {
            // A ray that never met the outer side (an open mesh) is inside all the same.
            if (!media_contains(ray.media, material.medium)) {
                n1 = material.ior;
            }
            media = media_leave(ray.media, material.medium);
            n2 = media_index(media);
        }
        let refraction = refract_direction(ray.direction, surface.shading_normal, n1, n2);
        if (refraction.total) {
            scattering.reflected = 1.0;
        } else {
            let fresnel = fresnel_schlick(n1, n2, refraction.cos_incident, refraction.cos_refracted);
            let both = material.reflection > 0.0;
            scattering.reflected = select(0.0, fresnel * material.reflection, both);
            scattering.refracted = select(1.0, 1.0 - fresnel, both);
            scattering.direction = unit_vector(keep_above(refraction.direction, -surface.geometric_normal));
            scattering.media = media;
        }
    }
    return scattering;
}

// Direction of the reflected ray: the mirror direction, spread over the glossy square, never below the surface.
fn reflected_direction(surface: Surface, material: Material, ray: Ray, index: u32) -> vec3<f32> {
    let n = surface.shading_normal;
    var r = ray.direction - 2.0 * dot(ray.direction, n) * n;
    if (HAS_GLOSSY && material.glossy > 0.0) {
        r = sample_glossy(r, material.glossy, sobol_2d(index, hash_combine(ray.key, DIMENSION_GLOSSY)));
    }
    return unit_vector(keep_above(r, surface.geometric_normal));
}

// Pushes the rays that leave a surface.
fn spawn_rays(surface: Surface, material: Material, ray: Ray) {
    let scattering = scatter(surface, material, ray);
    var reflected = scattering.reflected;
    var refracted = scattering.refracted;
    if (ray.depth > 0u && reflected > 0.0 && refracted > 0.0) {
        // Russian roulette: one of the two, with the weight of both.
        let total = reflected + refracted;
        let xi = sobol_2d(ray.index, hash_combine(ray.key, DIMENSION_CHOICE)).x;
        let reflect = xi * total < reflected;
        reflected = select(0.0, total, reflect);
        refracted = select(total, 0.0, reflect);
    }
    if (HAS_REFRACTION && refracted > 0.0) {
        tally.rays[RAY_REFRACTED] += 1u;
        let origin = offset_ray_origin(surface.point, -surface.geometric_normal);
        let key = hash_combine(ray.key, BRANCH_REFRACTED);
        push_ray(Ray(origin, scattering.direction, ray.weight * refracted, scattering.media, ray.index, key, ray.depth + 1u));
    }
    if (HAS_REFLECTION && reflected > 0.0) {
        let origin = offset_ray_origin(surface.point, surface.geometric_normal);
        let key = hash_combine(ray.key, BRANCH_REFLECTED);
        var count = 1u;
        var first = ray.index;
        if (HAS_GLOSSY && ray.depth == 0u && material.glossy > 0.0) {
            count = frame.glossy_samples;
            first = (ray.index * frame.pass_count + dispatch.pass_index) * count;
        }
        let weight = ray.weight * reflected / f32(count);
        for (var i = 0u; i < count; i++) {
            tally.rays[RAY_REFLECTED] += 1u;
            let direction = reflected_direction(surface, material, ray, first + i);
            push_ray(Ray(origin, direction, weight, ray.media, first + i, key, ray.depth + 1u));
        }
    }
}

// Radiance that arrives along a camera ray, and 1 or 0 for whether it met anything. Each turn traces one ray, a shadow
// ray of the last surface or else the next ray of the tree: the traversal stands in the program once, and lanes with
// shadow rays keep step with lanes that go on.
fn path_radiance(camera: CameraRay, sample_index: u32) -> vec4<f32> {
    var radiance = vec3<f32>(0.0);
    var coverage = 1.0;
    ray_stack_size = 0u;
    push_ray(Ray(camera.origin, camera.direction, 1.0, frame.medium, sample_index, camera.key, 0u));
    var ray: Ray;
    var surface: Surface;
    // The light samples that the surface still waits for.
    var samples = vec2<u32>(0u);
    let most_samples = max(frame.light_samples, frame.deep_light_samples);
    var turns_left = (1u + RAY_STACK_SIZE * frame.max_depth) * (1u + most_samples);
    while ((samples.x < samples.y || ray_stack_size > 0u) && turns_left > 0u) {
        turns_left--;
        let lighting = samples.x < samples.y;
        var light: LightSample;
        var origin: vec3<f32>;
        var direction: vec3<f32>;
        if (lighting) {
            light = light_sample(surface, materials[surface.material], -ray.direction, ray.index, ray.key, ray.depth, samples.x);
            samples.x++;
            if (all(light.radiance == vec3<f32>(0.0))) {
                continue;
            }
            tally.rays[RAY_SHADOW] += 1u;
            origin = light.origin;
            direction = light.to_light;
        } else {
            ray_stack_size--;
            ray = ray_stack[ray_stack_size];
            origin = ray.origin;
            direction = ray.direction;
        }
        let hit = traverse(origin, direction, select(T_INFINITY, SHADOW_T_MAX, lighting), lighting);
        if (lighting) {
            radiance += select(ray.weight * light.radiance, vec3<f32>(0.0), hit.t > 0.0);
            continue;
        }
        if (hit.t < 0.0) {
            if (ray.depth == 0u && (frame.flags & FRAME_TRANSPARENT) != 0u) {
                coverage = 0.0;
            } else {
                radiance += ray.weight * background(direction);
            }
            continue;
        }
        surface = surface_at(hit, origin, direction);
        let material = materials[surface.material];
        radiance += ray.weight * (material.emission + frame.ambient * material.diffuse);
        samples = light_sample_range(ray.depth);
        if ((HAS_REFLECTION || HAS_REFRACTION) && ray.depth < frame.max_depth) {
            spawn_rays(surface, material, ray);
        }
    }
    if (samples.x < samples.y || ray_stack_size > 0u) {
        tally.flags |= STATUS_LOOP_BOUND;
    }
    return vec4<f32>(radiance, coverage);
}
