//! Which refractive solids the eye is in, found before rendering starts.

use crate::cpu::bindings::Bindings;
use crate::cpu::geometry::bvh::scene_intersect;
use crate::cpu::geometry::instance::surface_at;
use crate::cpu::math::offset::offset_ray_origin;
use crate::renderer::Tally;
use glam::{UVec2, Vec3};

/// Surfaces crossed before the search ends; the scene beyond them cannot change the result of ordinary scenes.
const MAX_CROSSINGS: usize = 1024;
/// Any direction does for closed solids; this one is parallel to nothing that people model.
const PROBE: Vec3 = Vec3::new(0.267_261, 0.534_522, -0.801_784);

/// The media around `point` (world space) as a list for `media_index`: a solid that the probe ray leaves without
/// having entered it holds the point, the innermost first.
pub fn media_at(scene: &Bindings, point: Vec3) -> UVec2 {
    let mut entered = vec![0_u32; scene.materials.len() + 1];
    let mut around = Vec::new();
    let mut origin = point;
    let mut tally = Tally::default();
    for _ in 0..MAX_CROSSINGS {
        let hit = scene_intersect(scene, origin, PROBE, f32::MAX, &mut tally);
        if hit.t < 0.0 {
            break;
        }
        let surface = surface_at(scene, hit, origin, PROBE);
        let medium = scene.materials[surface.material as usize].medium;
        if medium != 0 {
            let count = &mut entered[medium as usize];
            match (surface.entering, *count) {
                (true, _) => *count += 1,
                (false, 0) => around.push(medium),
                (false, _) => *count -= 1,
            }
        }
        origin = offset_ray_origin(surface.point, -surface.geometric_normal);
    }
    // The list is built from its innermost end: the outermost medium is entered first.
    around.into_iter().take(4).rev().fold(UVec2::ZERO, crate::cpu::shading::material::media_enter)
}
