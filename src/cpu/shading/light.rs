//! Lights: where shadow rays aim, and what arrives; twin of `shaders/shading/light.wgsl`.

use crate::cpu::bindings::Bindings;
use crate::cpu::dimensions::{DIMENSION_LIGHT, DIMENSION_LIGHT_CHOICE};
use crate::cpu::geometry::hit::Surface;
use crate::cpu::math::offset::offset_ray_origin;
use crate::cpu::math::rng::{hash_combine, sobol_2d};
use crate::cpu::math::sampling::sample_cone;
use crate::cpu::ray::Ray;
use crate::cpu::shading::material::phong;
use crate::cpu::shading::medium::is_mist_event;
use crate::layout::{FRAME_BLINN, Frame, LIGHT_PARALLELOGRAM, LIGHT_POINT, Light, Material};
use glam::{Vec2, Vec3};
use std::ops::Range;

/// A point on the light as seen from `point` (world space): the point itself, uniform over a parallelogram, or uniform
/// in the solid angle of a ball (a point within the ball sees its whole surface).
pub fn sample_light(light: &Light, point: Vec3, xi: Vec2) -> Vec3 {
    if light.kind == LIGHT_POINT {
        return light.position;
    }
    if light.kind == LIGHT_PARALLELOGRAM {
        return light.position + (xi.x - 0.5) * light.u + (xi.y - 0.5) * light.v;
    }
    let to_centre = light.position - point;
    let distance_squared = to_centre.dot(to_centre);
    let radius_squared = light.radius * light.radius;
    let inside = distance_squared <= radius_squared;
    // 1 - cos of the cone that touches the ball, without cancellation (pbrt-v4, section 6.2.4).
    let sine_squared = radius_squared / distance_squared;
    let one_minus_cos = if inside { 2.0 } else { sine_squared / (1.0 + (1.0 - sine_squared).sqrt()) };
    let axis = if inside { Vec3::Z } else { to_centre / distance_squared.sqrt() };
    let direction = sample_cone(axis, one_minus_cos, xi);
    if inside {
        return light.position + light.radius * direction;
    }
    let along = direction.dot(to_centre);
    let half_chord = (radius_squared - (distance_squared - along * along).max(0.0)).max(0.0).sqrt();
    point + (along - half_chord) * direction
}

/// Share of the light's colour that arrives over `distance` (world units).
pub fn attenuation(light: &Light, distance: f32) -> f32 {
    let c = light.falloff;
    1.0 / (c.x + c.y * distance + c.z * distance * distance).max(1e-20)
}

/// The light samples that a hit takes. At depth 0 a pass takes its slice of light_count * shadow_count samples; deeper,
/// each light gets one, or where lights are many a stratified choice of them.
pub fn light_sample_range(frame: &Frame, pass_index: u32, depth: u32) -> Range<u32> {
    if depth > 0 {
        return 0..frame.deep_light_samples;
    }
    let first = pass_index * frame.light_samples;
    first..(first + frame.light_samples).min(frame.light_count * frame.shadow_count)
}

/// A shadow ray from a surface to a point of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Where it starts, and the way to the light: t = 1 is there.
    pub origin: Vec3,
    pub to_light: Vec3,
    /// What the surface sends to the viewer if nothing is in between.
    pub radiance: Vec3,
}

/// Light from the unit direction l that goes to the viewer at v. Mist scatters it whatever the directions are.
fn reflected_light(scene: &Bindings, surface: &Surface, material: &Material, l: Vec3, v: Vec3) -> Vec3 {
    if is_mist_event(surface) {
        return surface.diffuse;
    }
    let coloured = Material { diffuse: surface.diffuse, ..*material };
    let reflected = phong(&coloured, surface.shading_normal, l, v, scene.frame.flags & FRAME_BLINN != 0);
    // A normal that interpolation or a map has turned must not let in light from below the true surface.
    if surface.geometric_normal.dot(l) > 0.0 { reflected } else { Vec3::ZERO }
}

/// One term of Whitted's sum over the lights, with soft shadows by distributed shadow rays (Cook, Porter, Carpenter
/// 1984, section 4). v is the unit vector to the viewer, `ray` the ray that came.
pub fn light_sample(
    scene: &Bindings,
    surface: &Surface,
    material: &Material,
    v: Vec3,
    ray: &Ray,
    sample: u32,
) -> LightSample {
    let frame = scene.frame;
    let mut light_index = sample;
    let mut split_index = ray.index;
    let mut weight = 1.0;
    if ray.depth == 0 {
        light_index = sample / frame.shadow_count;
        split_index = ray.index.wrapping_mul(frame.shadow_count).wrapping_add(sample % frame.shadow_count);
        weight = frame.pass_count as f32 / frame.shadow_count as f32;
    } else if frame.light_count > frame.deep_light_samples {
        let choice = sobol_2d(ray.index, hash_combine(ray.key, DIMENSION_LIGHT_CHOICE)).x;
        let share = frame.light_count as f32 / frame.deep_light_samples as f32;
        light_index = (((sample as f32 + choice) * share) as u32).min(frame.light_count - 1);
        weight = share;
    }
    let light = &scene.lights[light_index as usize];
    let xi = if light.kind == LIGHT_POINT {
        Vec2::splat(0.5)
    } else {
        sobol_2d(split_index, hash_combine(ray.key, DIMENSION_LIGHT.wrapping_add(light_index)))
    };
    let on_light = sample_light(light, surface.point, xi);
    let from_surface = on_light - surface.point;
    let distance = from_surface.dot(from_surface).sqrt();
    let l = from_surface / distance.max(1e-20);
    let reflected = reflected_light(scene, surface, material, l, v);
    let radiance = (weight * attenuation(light, distance)) * (light.colour * reflected);
    let origin = offset_ray_origin(surface.point, surface.geometric_normal);
    LightSample { origin, to_light: on_light - origin, radiance }
}

/// A shadow ray ends just before t = 1: a surface that carries the light does not shade it.
pub const SHADOW_T_MAX: f32 = 0.9999;
