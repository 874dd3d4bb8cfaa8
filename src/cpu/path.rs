//! The tree of rays under one camera ray, walked by recursion: the reference for `shaders/path.wgsl`.

use crate::cpu::bindings::Bindings;
use crate::cpu::camera::CameraRay;
use crate::cpu::dimensions::{BRANCH_REFLECTED, BRANCH_REFRACTED, DIMENSION_CHOICE, DIMENSION_GLOSSY, DIMENSION_MIST};
use crate::cpu::geometry::bvh::{mist_intersect, scene_intersect, scene_occluded};
use crate::cpu::geometry::hit::{Hit, Surface};
use crate::cpu::geometry::instance::surface_at;
use crate::cpu::math::elementary::unit_vector;
use crate::cpu::math::offset::offset_ray_origin;
use crate::cpu::math::rng::{hash_combine, sobol_2d};
use crate::cpu::math::sampling::{keep_above, sample_glossy};
use crate::cpu::ray::{Ray, T_INFINITY};
use crate::cpu::shading::background::background;
use crate::cpu::shading::detail::surface_detail;
use crate::cpu::shading::light::{SHADOW_T_MAX, light_sample, light_sample_range};
use crate::cpu::shading::material::{
    fresnel_schlick, media_contains, media_enter, media_index, media_leave, refract_direction,
};
use crate::cpu::shading::medium::{
    MIST_CROSSINGS, beyond_boundary, choose_mist, free_flight, mist_cross, mist_density, mist_event, mists_density,
};
use crate::layout::{FRAME_TRANSPARENT, Material, RAY_REFLECTED, RAY_REFRACTED, RAY_SHADOW, STATUS_MIST_CROSSINGS};
use crate::renderer::Tally;
use glam::{UVec2, Vec2, Vec3, Vec4};

/// The shares of reflected and refracted light at a surface, and where the refracted ray goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    pub reflected: f32,
    pub refracted: f32,
    pub direction: Vec3,
    pub media: UVec2,
}

/// Only reflective: REFL. Only refractive: everything goes through. Both: F * REFL and 1 - F. Total internal reflection
/// reflects everything.
pub fn scatter(scene: &Bindings, surface: &Surface, material: &Material, ray: &Ray) -> Scattering {
    let mut scattering =
        Scattering { reflected: material.reflection, refracted: 0.0, direction: Vec3::ZERO, media: ray.media };
    if material.ior > 0.0 {
        let mut n1 = media_index(scene, ray.media);
        let media;
        let n2;
        if surface.entering {
            media = media_enter(ray.media, material.medium);
            n2 = material.ior;
        } else {
            // A ray that never met the outer side (an open mesh) is inside all the same.
            if !media_contains(ray.media, material.medium) {
                n1 = material.ior;
            }
            media = media_leave(ray.media, material.medium);
            n2 = media_index(scene, media);
        }
        let refraction = refract_direction(ray.direction, surface.shading_normal, n1, n2);
        if refraction.total {
            scattering.reflected = 1.0;
        } else {
            let fresnel = fresnel_schlick(n1, n2, refraction.cos_incident, refraction.cos_refracted);
            let both = material.reflection > 0.0;
            scattering.reflected = if both { fresnel * material.reflection } else { 0.0 };
            scattering.refracted = if both { 1.0 - fresnel } else { 1.0 };
            scattering.direction = unit_vector(keep_above(refraction.direction, -surface.geometric_normal));
            scattering.media = media;
        }
    }
    scattering
}

/// Direction of the reflected ray: the mirror direction, spread over the glossy square, never below the surface.
pub fn reflected_direction(surface: &Surface, material: &Material, ray: &Ray, index: u32) -> Vec3 {
    let n = surface.shading_normal;
    let mut r = ray.direction - 2.0 * ray.direction.dot(n) * n;
    if material.glossy > 0.0 {
        r = sample_glossy(r, material.glossy, sobol_2d(index, hash_combine(ray.key, DIMENSION_GLOSSY)));
    }
    unit_vector(keep_above(r, surface.geometric_normal))
}

/// Radiance of the rays that leave a surface, on which the ray's cone is `cone_width` wide, by recursion.
pub fn spawn_rays(
    scene: &Bindings,
    surface: &Surface,
    material: &Material,
    ray: &Ray,
    cone_width: f32,
    pass_index: u32,
    tally: &mut Tally,
) -> Vec3 {
    let scattering = scatter(scene, surface, material, ray);
    let mut reflected = scattering.reflected;
    let mut refracted = scattering.refracted;
    if ray.depth > 0 && reflected > 0.0 && refracted > 0.0 {
        // Russian roulette: one of the two, with the weight of both.
        let total = reflected + refracted;
        let xi = sobol_2d(ray.index, hash_combine(ray.key, DIMENSION_CHOICE)).x;
        let reflect = xi * total < reflected;
        reflected = if reflect { total } else { 0.0 };
        refracted = if reflect { 0.0 } else { total };
    }
    let mut radiance = Vec3::ZERO;
    if refracted > 0.0 {
        tally.rays[RAY_REFRACTED as usize] += 1;
        let spawned = Ray {
            origin: offset_ray_origin(surface.point, -surface.geometric_normal),
            start: surface.point,
            direction: scattering.direction,
            media: scattering.media,
            mists: ray.mists,
            cone_width,
            cone_spread: ray.cone_spread,
            index: ray.index,
            key: hash_combine(ray.key, BRANCH_REFRACTED),
            depth: ray.depth + 1,
        };
        radiance += refracted * ray_radiance(scene, &spawned, pass_index, tally).unwrap_or_default();
    }
    if reflected > 0.0 {
        let origin = offset_ray_origin(surface.point, surface.geometric_normal);
        let key = hash_combine(ray.key, BRANCH_REFLECTED);
        let mut count = 1;
        let mut first = ray.index;
        if ray.depth == 0 && material.glossy > 0.0 {
            count = scene.frame.glossy_samples;
            first = ray.index.wrapping_mul(scene.frame.pass_count).wrapping_add(pass_index).wrapping_mul(count);
        }
        // A glossy ray stands for its part of the square, of which the samples of a pixel are at least a few.
        let cone_spread = ray.cone_spread + 0.5 * material.glossy;
        for i in 0..count {
            tally.rays[RAY_REFLECTED as usize] += 1;
            let index = first.wrapping_add(i);
            let direction = reflected_direction(surface, material, ray, index);
            let start = surface.point;
            let depth = ray.depth + 1;
            let spawned = Ray { origin, start, direction, cone_width, cone_spread, index, key, depth, ..*ray };
            let weight = reflected / count as f32;
            radiance += weight * ray_radiance(scene, &spawned, pass_index, tally).unwrap_or_default();
        }
    }
    radiance
}

/// What ends a ray's way through mist.
enum Arrival {
    /// The surface ahead, or the open if there is none; the ray is in these mists there.
    Surface(UVec2),
    /// A scattering event.
    Scattered(Surface),
}

/// Random numbers of a leg: the free flight, and which mist scatters.
fn leg_numbers(ray: &Ray, leg: u32) -> Vec2 {
    sobol_2d(ray.index, hash_combine(hash_combine(ray.key, DIMENSION_MIST), leg))
}

/// The way of a ray through mist to `hit`, leg by leg from boundary to boundary. Free flights have no memory, so that
/// each leg samples one of its own.
fn fly(scene: &Bindings, ray: &Ray, hit: Hit, tally: &mut Tally) -> Arrival {
    let mut mists = ray.mists;
    let mut origin = ray.start;
    let mut left = if hit.t < 0.0 { T_INFINITY } else { hit.t };
    let mut boundary = 0;
    let mut step = 0.0;
    for leg in 0..=MIST_CROSSINGS {
        let numbers = leg_numbers(ray, leg);
        let free = free_flight(mists_density(scene, mists), numbers.x);
        let met = mist_intersect(scene, origin, ray.direction, free.min(left), tally);
        if met.t < 0.0 {
            if free < left {
                let scatterer = choose_mist(scene, mists, numbers.y);
                return Arrival::Scattered(mist_event(scene, origin + free * ray.direction, scatterer));
            }
            return Arrival::Surface(mists);
        }
        let surface = surface_at(scene, met, origin, ray.direction);
        let material = &scene.materials[surface.material as usize];
        let number = material.medium;
        if !surface.entering && !media_contains(mists, number) {
            // The ray was in it from the leg's beginning without knowing: its scattering is independent of that of
            // the others, none of which scattered before this boundary.
            let free = free_flight(mist_density(scene, number), numbers.y);
            if free < met.t {
                return Arrival::Scattered(mist_event(scene, origin + free * ray.direction, number));
            }
        }
        mists = mist_cross(mists, number, surface.entering);
        // A grazing ray stays so near to the boundary that it meets it again and again: its steps double.
        let met_boundary = 2 * number + u32::from(surface.entering);
        step = if met_boundary == boundary { 2.0 * step } else { material.mist_step };
        boundary = met_boundary;
        origin = beyond_boundary(surface.point, origin, ray.direction, met.t, step);
        left -= met.t + step;
    }
    tally.flags |= STATUS_MIST_CROSSINGS;
    Arrival::Surface(mists)
}

/// Direct light at a surface or a scattering event.
fn light_radiance(scene: &Bindings, surface: &Surface, ray: &Ray, pass_index: u32, tally: &mut Tally) -> Vec3 {
    let material = &scene.materials[surface.material as usize];
    let mut radiance = Vec3::ZERO;
    for sample in light_sample_range(scene.frame, pass_index, ray.depth) {
        let light = light_sample(scene, surface, material, -ray.direction, ray, sample);
        if light.radiance == Vec3::ZERO {
            continue;
        }
        tally.rays[RAY_SHADOW as usize] += 1;
        if !scene_occluded(scene, light.origin, light.to_light, SHADOW_T_MAX, tally) {
            radiance += light.radiance;
        }
    }
    radiance
}

/// Radiance that arrives along a ray; `None` where a camera ray leaves a transparent scene.
fn ray_radiance(scene: &Bindings, ray: &Ray, pass_index: u32, tally: &mut Tally) -> Option<Vec3> {
    let hit = scene_intersect(scene, ray.origin, ray.direction, T_INFINITY, tally);
    let arrival = if scene.has_mist { fly(scene, ray, hit, tally) } else { Arrival::Surface(ray.mists) };
    let ray = match arrival {
        Arrival::Surface(mists) => Ray { mists, ..*ray },
        Arrival::Scattered(event) => {
            return Some(scene.frame.ambient * event.diffuse + light_radiance(scene, &event, ray, pass_index, tally));
        }
    };
    if hit.t < 0.0 {
        let transparent = ray.depth == 0 && scene.frame.flags & FRAME_TRANSPARENT != 0;
        return (!transparent).then(|| background(scene, ray.direction));
    }
    let surface = surface_at(scene, hit, ray.origin, ray.direction);
    let cone_width = ray.cone_width + ray.cone_spread * hit.t;
    let surface = surface_detail(scene, hit, surface, ray.direction, cone_width);
    let material = &scene.materials[surface.material as usize];
    let mut radiance = material.emission + scene.frame.ambient * surface.diffuse;
    radiance += light_radiance(scene, &surface, &ray, pass_index, tally);
    if ray.depth < scene.frame.max_depth {
        radiance += spawn_rays(scene, &surface, material, &ray, cone_width, pass_index, tally);
    }
    Some(radiance)
}

/// Radiance that arrives along a camera ray, and 1 or 0 for whether it met anything.
pub fn path_radiance(
    scene: &Bindings,
    camera: CameraRay,
    sample_index: u32,
    pass_index: u32,
    tally: &mut Tally,
) -> Vec4 {
    let ray = Ray {
        origin: camera.origin,
        start: camera.origin,
        direction: camera.direction,
        media: scene.frame.medium,
        mists: scene.frame.mist,
        cone_width: 0.0,
        cone_spread: camera.spread,
        index: sample_index,
        key: camera.key,
        depth: 0,
    };
    match ray_radiance(scene, &ray, pass_index, tally) {
        Some(radiance) => radiance.extend(1.0),
        None => Vec4::ZERO,
    }
}
