//! Materials in use, and the numbers of the refractive media.

use super::walk::Placement;
use crate::layout::{MATERIAL_MIST, Material, NONE};
use crate::scene::{self, MaterialId, Scene};
use crate::{Error, Result};
use std::collections::{HashMap, HashSet};

/// Media are numbered from 1; two of them share a word in the kernel.
pub const MAX_MEDIA: u32 = 65_535;

/// Where each material of the scene went; a node without one has the default.
pub type MaterialIndices = HashMap<Option<MaterialId>, u32>;

/// The materials of the placements, the refractive ones first: the number of a medium is the index of its material
/// plus 1, which is how the kernels find its refractive index.
pub fn materials_in_use(scene: &Scene, placements: &[Placement]) -> Result<(Vec<Material>, MaterialIndices)> {
    let default = scene::Material::default();
    let described = |id: Option<MaterialId>| id.map_or(&default, |id| &scene.graph.materials[id.0 as usize]);
    let mut seen = HashSet::new();
    let mut order: Vec<_> =
        placements.iter().map(|placement| placement.material).filter(|id| seen.insert(*id)).collect();
    order.sort_by_key(|id| described(*id).ior.is_none());
    let media = order.iter().filter(|id| described(**id).ior.is_some()).count();
    if media > MAX_MEDIA as usize {
        return Err(Error::Scene(format!(
            "the scene uses {media} refractive materials; at most {MAX_MEDIA} are possible"
        )));
    }
    // One glossy ray is none: the reflection is a mirror's.
    let spread = if scene.sampling.glossy > 1 { 1.0 } else { 0.0 };
    let packed = (1..).zip(&order).map(|(medium, id)| pack(described(*id), medium, spread)).collect();
    Ok((packed, order.into_iter().zip(0..).collect()))
}

fn pack(material: &scene::Material, medium: u32, spread: f32) -> Material {
    Material {
        diffuse: material.diffuse,
        shininess: material.shininess,
        specular: material.specular,
        reflection: material.reflection,
        emission: material.emission,
        glossy: material.glossy * spread,
        ior: material.ior.unwrap_or(0.0),
        density: material.density.unwrap_or(0.0),
        noise_z: 0.0,
        flags: if material.density.is_some() { MATERIAL_MIST } else { 0 },
        texture: NONE,
        bump: NONE,
        medium: if material.ior.is_some() { medium } else { 0 },
        mist_step: 0.0,
    }
}
