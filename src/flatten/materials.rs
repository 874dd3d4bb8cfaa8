//! Materials in use, and the numbers of the refractive media.

use super::walk::Placement;
use crate::layout::{Material, NONE};
use crate::scene::{self, MaterialId, Scene};
use crate::{Error, Result};
use glam::Vec3;
use std::collections::HashMap;

/// Media are numbered from 1; two of them share a word in the kernel.
pub const MAX_MEDIA: u32 = 65_535;

/// Where each material of the scene went; a node without one has the default.
pub type MaterialIndices = HashMap<Option<MaterialId>, u32>;

/// The materials of the placements, in the order of their first use.
pub fn materials_in_use(scene: &Scene, placements: &[Placement]) -> Result<(Vec<Material>, MaterialIndices)> {
    let mut packed = Vec::new();
    let mut indices = MaterialIndices::new();
    let mut media = 0;
    for placement in placements {
        let default = scene::Material::default();
        indices.entry(placement.material).or_insert_with(|| {
            let material = placement.material.map_or(&default, |id| &scene.graph.materials[id.0 as usize]);
            packed.push(pack(material, &mut media));
            (packed.len() - 1) as u32
        });
    }
    if media > MAX_MEDIA {
        return Err(Error::Scene(format!(
            "the scene uses {media} refractive materials; at most {MAX_MEDIA} are possible"
        )));
    }
    Ok((packed, indices))
}

fn pack(material: &scene::Material, media: &mut u32) -> Material {
    let medium = match material.ior {
        Some(_) => {
            *media += 1;
            *media
        }
        None => 0,
    };
    Material {
        diffuse: material.diffuse,
        shininess: material.shininess,
        specular: material.specular,
        reflection: material.reflection,
        emission: Vec3::ZERO,
        glossy: material.glossy,
        ior: material.ior.unwrap_or(0.0),
        density: 0.0,
        noise_z: 0.0,
        flags: 0,
        texture: NONE,
        bump: NONE,
        medium,
        pad: 0,
    }
}
