//! The tree of rays under one camera ray, walked by recursion: the reference for `shaders/path.wgsl`.

use crate::cpu::bindings::Bindings;
use crate::cpu::camera::CameraRay;
use crate::cpu::geometry::bvh::{scene_intersect, scene_occluded};
use crate::cpu::geometry::hit::Surface;
use crate::cpu::geometry::instance::surface_at;
use crate::cpu::math::elementary::unit_vector;
use crate::cpu::math::offset::offset_ray_origin;
use crate::cpu::math::rng::{hash_combine, sobol_2d};
use crate::cpu::math::sampling::{keep_above, sample_glossy};
use crate::cpu::shading::light::{SHADOW_T_MAX, light_sample, light_sample_range};
use crate::cpu::shading::material::{
    fresnel_schlick, media_contains, media_enter, media_index, media_leave, refract_direction,
};
use crate::layout::{FRAME_TRANSPARENT, Material, RAY_REFLECTED, RAY_REFRACTED, RAY_SHADOW};
use crate::renderer::Tally;
use glam::{UVec2, Vec3, Vec4};

pub const DIMENSION_PIXEL: u32 = 1;
pub const DIMENSION_LENS: u32 = 2;
pub const DIMENSION_GLOSSY: u32 = 3;
pub const DIMENSION_CHOICE: u32 = 4;
pub const DIMENSION_LIGHT_CHOICE: u32 = 5;
pub const BRANCH_REFLECTED: u32 = 6;
pub const BRANCH_REFRACTED: u32 = 7;
/// Light i has the dimension `DIMENSION_LIGHT + i`.
pub const DIMENSION_LIGHT: u32 = 16;

const T_INFINITY: f32 = 3.0e38;

/// A ray of the tree. It has no weight: the recursion multiplies on the way back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: Vec3,
    /// Unit.
    pub direction: Vec3,
    pub media: UVec2,
    /// Number among the samples that share `key`, and the key of its random decisions.
    pub index: u32,
    pub key: u32,
    pub depth: u32,
}

/// Radiance of a ray that leaves the scene: a gradient over the height of its direction.
pub fn background(scene: &Bindings, direction: Vec3) -> Vec3 {
    mix_colour(scene.frame.background_bottom, scene.frame.background_top, 0.5 + 0.5 * direction.y)
}

pub fn mix_colour(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}

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

/// Radiance of the rays that leave a surface, by recursion.
pub fn spawn_rays(
    scene: &Bindings,
    surface: &Surface,
    material: &Material,
    ray: &Ray,
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
            direction: scattering.direction,
            media: scattering.media,
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
        for i in 0..count {
            tally.rays[RAY_REFLECTED as usize] += 1;
            let index = first.wrapping_add(i);
            let direction = reflected_direction(surface, material, ray, index);
            let spawned = Ray { origin, direction, media: ray.media, index, key, depth: ray.depth + 1 };
            let weight = reflected / count as f32;
            radiance += weight * ray_radiance(scene, &spawned, pass_index, tally).unwrap_or_default();
        }
    }
    radiance
}

/// Radiance that arrives along a ray; `None` where a camera ray leaves a transparent scene.
fn ray_radiance(scene: &Bindings, ray: &Ray, pass_index: u32, tally: &mut Tally) -> Option<Vec3> {
    let hit = scene_intersect(scene, ray.origin, ray.direction, T_INFINITY, tally);
    if hit.t < 0.0 {
        let transparent = ray.depth == 0 && scene.frame.flags & FRAME_TRANSPARENT != 0;
        return (!transparent).then(|| background(scene, ray.direction));
    }
    let surface = surface_at(scene, hit, ray.origin, ray.direction);
    let material = &scene.materials[surface.material as usize];
    let mut radiance = material.emission + scene.frame.ambient * material.diffuse;
    for sample in light_sample_range(scene.frame, pass_index, ray.depth) {
        let light = light_sample(scene, &surface, material, -ray.direction, ray, sample);
        if light.radiance == Vec3::ZERO {
            continue;
        }
        tally.rays[RAY_SHADOW as usize] += 1;
        if !scene_occluded(scene, light.origin, light.to_light, SHADOW_T_MAX, tally) {
            radiance += light.radiance;
        }
    }
    if ray.depth < scene.frame.max_depth {
        radiance += spawn_rays(scene, &surface, material, ray, pass_index, tally);
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
        direction: camera.direction,
        media: scene.frame.medium,
        index: sample_index,
        key: camera.key,
        depth: 0,
    };
    match ray_radiance(scene, &ray, pass_index, tally) {
        Some(radiance) => radiance.extend(1.0),
        None => Vec4::ZERO,
    }
}
