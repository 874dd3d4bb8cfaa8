//! What maps do to a surface: its colour from a texture, its normal from a bump map. Twin of
//! `shaders/shading/detail.wgsl`.

use super::bump::{bump_normal, visible_normal};
use super::texture::texture_lookup;
use crate::cpu::bindings::Bindings;
use crate::cpu::geometry::hit::{Hit, Surface};
use crate::cpu::geometry::instance::{transform_normal, transform_vector};
use crate::cpu::geometry::parameterisation::parameterise_at;
use crate::layout::{MATERIAL_NOISE_BUMP, MATERIAL_TEXTURE_REPLACES, NONE};
use glam::Vec3;

/// Wider filters than this many repetitions of a map see its mean.
pub const FOOTPRINT_MAX: f32 = 1024.0;

/// Edge, in units of uv, of the square of the map that a cone of rays covers: the cone's width (world units) over the
/// cosine of its incidence and the root of |Pu × Pv|, the area of the unit square of uv (Akenine-Möller et al.,
/// "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, 2019, chapter 20).
pub fn map_footprint(cone_width: f32, cosine: f32, dpdu: Vec3, dpdv: Vec3) -> f32 {
    let c = dpdu.cross(dpdv);
    let area = (c.x * c.x + c.y * c.y + c.z * c.z).sqrt();
    let width = cone_width / cosine.abs().max(1.0e-3);
    (width / area.max(1.0e-20).sqrt()).clamp(0.0, FOOTPRINT_MAX)
}

/// The surface with the colour and the normal that its material's maps give it, for a ray of the unit direction and of
/// the width `cone_width` (world units) there.
pub fn surface_detail(scene: &Bindings, hit: Hit, surface: Surface, direction: Vec3, cone_width: f32) -> Surface {
    let mut detailed = surface;
    let material = &scene.materials[surface.material as usize];
    let textured = material.flags & MATERIAL_TEXTURE_REPLACES != 0 && material.texture != NONE;
    let bumped = material.flags & MATERIAL_NOISE_BUMP != 0 || material.bump != NONE;
    if !textured && !bumped {
        return detailed;
    }
    let mut parameterisation = parameterise_at(scene, hit, surface);
    let cosine = direction.dot(surface.geometric_normal);
    let footprint = map_footprint(cone_width, cosine, parameterisation.dpdu, parameterisation.dpdv);
    if textured {
        detailed.diffuse = texture_lookup(scene, material.texture, parameterisation.uv, footprint);
    }
    if bumped {
        // In object space, so that bumps grow with the shape. Heights rise out of the shape: the inner side, whose
        // normals point inwards, shows dents.
        let instance = &scene.instances[hit.instance as usize];
        parameterisation.dpdu = transform_vector(&instance.object_from_world, parameterisation.dpdu);
        parameterisation.dpdv = transform_vector(&instance.object_from_world, parameterisation.dpdv);
        let side = if surface.entering { 1.0 } else { -1.0 };
        let outward = transform_normal(&instance.world_from_object, side * surface.shading_normal);
        let turned = bump_normal(scene, material, &parameterisation, outward, footprint);
        let normal = side * transform_normal(&instance.object_from_world, turned);
        detailed.shading_normal = visible_normal(normal, surface.geometric_normal, -direction);
    }
    detailed
}
