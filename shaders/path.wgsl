// The tree of rays under one camera ray, walked with an explicit stack. A hit of a camera ray may split; deeper, each
// choice takes one ray by Russian roulette, so that the stack never holds more than the splits of one hit.

// The splits of one hit in one pass, glossy rays (`MAX_GLOSSY_SAMPLES` in src/flatten/work.rs) and a refracted one, but
// for the next ray.
const RAY_STACK_SIZE: u32 = 4u;
var<private> ray_stack: array<Ray, RAY_STACK_SIZE>;
var<private> ray_stack_size: u32;
// The ray that comes next, if it is known: most hits spawn one ray, which the way through memory would cost dear.
var<private> next_ray: Ray;
var<private> has_next_ray: bool;

fn push_ray(ray: Ray) {
    if (!has_next_ray) {
        next_ray = ray;
        has_next_ray = true;
        return;
    }
    if (ray_stack_size == RAY_STACK_SIZE) {
        tally.flags |= STATUS_STACK_FULL;
        return;
    }
    ray_stack[ray_stack_size] = ray;
    ray_stack_size++;
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

// Pushes the rays that leave a surface, on which the ray's cone is cone_width wide.
fn spawn_rays(surface: Surface, material: Material, ray: Ray, cone_width: f32) {
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
        push_ray(Ray(
            offset_ray_origin(surface.point, -surface.geometric_normal),
            surface.point,
            scattering.direction,
            ray.weight * refracted,
            scattering.media,
            ray.mists,
            cone_width,
            ray.cone_spread,
            ray.index,
            hash_combine(ray.key, BRANCH_REFRACTED),
            ray.depth + 1u,
        ));
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
        // A glossy ray stands for its part of the square, of which the samples of a pixel are at least a few.
        let spread = ray.cone_spread + 0.5 * material.glossy;
        for (var i = 0u; i < count; i++) {
            tally.rays[RAY_REFLECTED] += 1u;
            push_ray(Ray(
                origin,
                surface.point,
                reflected_direction(surface, material, ray, first + i),
                weight,
                ray.media,
                ray.mists,
                cone_width,
                spread,
                first + i,
                key,
                ray.depth + 1u,
            ));
        }
    }
}

// The way of a ray through mist, leg by leg from boundary to boundary, once it is known which surface it would meet.
// Free flights have no memory, so that each leg samples one of its own. World units along the ray.
struct Flight {
    // Still on its way.
    going: bool,
    surface: Hit,
    leg: u32,
    leg_origin: vec3<f32>,
    // From leg_origin to the surface.
    left: f32,
    // The boundary crossed last, twice the number of its mist and 1 where the ray went in, and the step across it.
    boundary: u32,
    step: f32,
};

// Random numbers of the current leg: the free flight, and which mist scatters.
fn leg_numbers(ray: Ray, leg: u32) -> vec2<f32> {
    return sobol_2d(ray.index, hash_combine(hash_combine(ray.key, DIMENSION_MIST), leg));
}

// Radiance that arrives along a camera ray, and 1 or 0 for whether it met anything. Each turn traces one ray, a shadow
// ray of the last surface, a leg through mist, or else the next ray of the tree: the traversal stands in the program
// once, and lanes with shadow rays keep step with lanes that go on.
fn path_radiance(camera: CameraRay, sample_index: u32) -> vec4<f32> {
    var radiance = vec3<f32>(0.0);
    var coverage = 1.0;
    ray_stack_size = 0u;
    has_next_ray = false;
    push_ray(Ray(
        camera.origin,
        camera.origin,
        camera.direction,
        1.0,
        frame.medium,
        frame.mist,
        0.0,
        camera.spread,
        sample_index,
        camera.key,
        0u,
    ));
    var ray: Ray;
    var surface: Surface;
    // Of the last surface but a mist's, which scatters without one; kept, as each of its shadow rays asks for it.
    var material: Material;
    // The light samples that the surface still waits for.
    var samples = vec2<u32>(0u);
    var flight: Flight;
    flight.going = false;
    let most_samples = max(frame.light_samples, frame.deep_light_samples);
    let most_legs = select(0u, MIST_CROSSINGS + 1u, HAS_MIST);
    var turns_left = (1u + (1u + RAY_STACK_SIZE) * frame.max_depth) * (1u + most_legs + most_samples);
    while ((samples.x < samples.y || flight.going || has_next_ray || ray_stack_size > 0u) && turns_left > 0u) {
        turns_left--;
        let lighting = samples.x < samples.y;
        let flying = HAS_MIST && flight.going;
        var light: LightSample;
        var numbers: vec2<f32>;
        var free: f32;
        var origin: vec3<f32>;
        var direction: vec3<f32>;
        var t_max = T_INFINITY;
        if (lighting) {
            light = light_sample(surface, material, -ray.direction, ray.index, ray.key, ray.depth, samples.x);
            samples.x++;
            if (all(light.radiance == vec3<f32>(0.0))) {
                continue;
            }
            tally.rays[RAY_SHADOW] += 1u;
            origin = light.origin;
            direction = light.to_light;
            t_max = SHADOW_T_MAX;
        } else if (flying) {
            numbers = leg_numbers(ray, flight.leg);
            free = free_flight(mists_density(ray.mists), numbers.x);
            origin = flight.leg_origin;
            direction = ray.direction;
            t_max = min(free, flight.left);
        } else {
            if (has_next_ray) {
                ray = next_ray;
                has_next_ray = false;
            } else {
                ray_stack_size--;
                ray = ray_stack[ray_stack_size];
            }
            origin = ray.origin;
            direction = ray.direction;
        }
        let mask = select(select(INSTANCE_SEEN, INSTANCE_MIST, flying), INSTANCE_SHADES, lighting);
        let met = traverse(origin, direction, t_max, lighting, mask);
        if (lighting) {
            radiance += select(ray.weight * light.radiance, vec3<f32>(0.0), met.t > 0.0);
            continue;
        }
        var hit = met;
        if (HAS_MIST && !flying) {
            flight = Flight(true, met, 0u, ray.start, select(met.t, T_INFINITY, met.t < 0.0), 0u, 0.0);
            continue;
        }
        let crossing = flying && met.t > 0.0;
        // A flight that ends in a mist, where it does.
        var scatterer = 0u;
        if (flying && !crossing) {
            flight.going = false;
            if (free < flight.left) {
                scatterer = choose_mist(ray.mists, numbers.y);
            }
            hit = flight.surface;
            origin = ray.origin;
        }
        if (scatterer == 0u) {
            if (hit.t < 0.0) {
                if (ray.depth == 0u && (frame.flags & FRAME_TRANSPARENT) != 0u) {
                    coverage = 0.0;
                } else {
                    radiance += ray.weight * background(direction);
                }
                continue;
            }
            surface = surface_at(hit, origin, direction);
        }
        if (crossing) {
            let number = materials[surface.material].medium;
            if (!surface.entering && !media_contains(ray.mists, number)) {
                // The ray was in it from the leg's beginning without knowing: its scattering is independent of that
                // of the others, none of which scattered before this boundary.
                free = free_flight(mist_density(number), numbers.y);
                scatterer = select(0u, number, free < met.t);
            }
            flight.going = scatterer == 0u;
            if (flight.going) {
                ray.mists = mist_cross(ray.mists, number, surface.entering);
                // A grazing ray stays so near to the boundary that it meets it again and again: its steps double.
                let boundary = 2u * number + u32(surface.entering);
                flight.step = select(materials[surface.material].mist_step, 2.0 * flight.step, boundary == flight.boundary);
                flight.boundary = boundary;
                flight.leg_origin = beyond_boundary(surface.point, origin, direction, met.t, flight.step);
                flight.left -= met.t + flight.step;
                flight.leg++;
                if (flight.leg > MIST_CROSSINGS) {
                    tally.flags |= STATUS_MIST_CROSSINGS;
                    flight.going = false;
                }
                continue;
            }
        }
        samples = light_sample_range(ray.depth);
        if (HAS_MIST && scatterer > 0u) {
            surface = mist_event(flight.leg_origin + free * direction, scatterer);
            radiance += ray.weight * (frame.ambient * surface.diffuse);
            continue;
        }
        material = materials[surface.material];
        let cone_width = ray.cone_width + ray.cone_spread * hit.t;
        if (HAS_TEXTURE || HAS_BUMP) {
            surface = surface_detail(hit, surface, direction, cone_width);
        }
        radiance += ray.weight * (material.emission + frame.ambient * surface.diffuse);
        if ((HAS_REFLECTION || HAS_REFRACTION) && ray.depth < frame.max_depth) {
            spawn_rays(surface, material, ray, cone_width);
        }
    }
    if (samples.x < samples.y || flight.going || has_next_ray || ray_stack_size > 0u) {
        tally.flags |= STATUS_LOOP_BOUND;
    }
    return vec4<f32>(radiance, coverage);
}
