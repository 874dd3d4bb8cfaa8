//! Which refractive solids and which mists the eye is in, found before rendering starts.

use crate::cpu::bindings::Bindings;
use crate::cpu::geometry::bvh::{mist_intersect, scene_intersect};
use crate::cpu::geometry::hit::{Hit, Surface};
use crate::cpu::geometry::instance::surface_at;
use crate::cpu::math::offset::offset_ray_origin;
use crate::cpu::ray::T_INFINITY;
use crate::cpu::shading::material::media_enter;
use crate::cpu::shading::medium::{beyond_boundary, mist_cross};
use crate::renderer::Tally;
use glam::{UVec2, Vec3};

/// Surfaces crossed before the search ends; the scene beyond them cannot change the result of ordinary scenes.
const MAX_CROSSINGS: usize = 1024;
/// Any direction does for closed solids; this one is parallel to nothing that people model.
const PROBE: Vec3 = Vec3::new(0.267_261, 0.534_522, -0.801_784);

/// The media around `point` (world space) as a list for `media_index`: a solid that the probe ray leaves without
/// having entered it holds the point, the innermost first.
pub fn media_at(scene: &Bindings, point: Vec3) -> UVec2 {
    let trace = |origin: Vec3, tally: &mut Tally| scene_intersect(scene, origin, PROBE, T_INFINITY, tally);
    let onward = |surface: &Surface, _, _| offset_ray_origin(surface.point, -surface.geometric_normal);
    // The list is built from its innermost end: the outermost medium is entered first.
    surrounding(scene, point, trace, onward).into_iter().take(4).rev().fold(UVec2::ZERO, media_enter)
}

/// The mists around `point` (world space), likewise.
pub fn mists_at(scene: &Bindings, point: Vec3) -> UVec2 {
    let trace = |origin: Vec3, tally: &mut Tally| mist_intersect(scene, origin, PROBE, T_INFINITY, tally);
    let onward = |surface: &Surface, origin, t| {
        beyond_boundary(surface.point, origin, PROBE, t, scene.materials[surface.material as usize].mist_step)
    };
    let around = surrounding(scene, point, trace, onward);
    around.into_iter().take(4).rev().fold(UVec2::ZERO, |mists, number| mist_cross(mists, number, true))
}

/// The numbers of the media that hold `point`, the innermost first, from the boundaries that `trace` finds along the
/// probe; `onward` gives the origin beyond one from where the last was and t.
fn surrounding(
    scene: &Bindings,
    point: Vec3,
    trace: impl Fn(Vec3, &mut Tally) -> Hit,
    onward: impl Fn(&Surface, Vec3, f32) -> Vec3,
) -> Vec<u32> {
    let mut entered = vec![0_u32; scene.materials.len() + 1];
    let mut around = Vec::new();
    let mut origin = point;
    let mut tally = Tally::default();
    for _ in 0..MAX_CROSSINGS {
        let hit = trace(origin, &mut tally);
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
        origin = onward(&surface, origin, hit.t);
    }
    around
}
