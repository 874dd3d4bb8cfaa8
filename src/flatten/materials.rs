//! Materials in use with the textures and bumps of their nodes, and the numbers of the media.

use super::atlas::Atlas;
use super::walk::Placement;
use crate::layout::{MATERIAL_MIST, MATERIAL_NOISE_BUMP, MATERIAL_TEXTURE_REPLACES, Material, NONE};
use crate::scene::{self, Bump, Image, MaterialId, Scene, SceneGraph};
use crate::{Error, Result};
use glam::Vec3;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock};

/// Media are numbered from 1; two of them share a word in the kernel.
pub const MAX_MEDIA: u32 = 65_535;

/// What tells one packed material from another. Images are the same only if they are the same allocation.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key {
    material: Option<MaterialId>,
    texture: Option<*const Image>,
    bump: Option<BumpKey>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum BumpKey {
    Image(*const Image),
    /// The bits of z.
    Noise(u32),
}

/// The material of a placement, with what its node puts in the place of the material's own maps.
struct Described<'a> {
    material: &'a scene::Material,
    texture: Option<&'a Arc<Image>>,
    bump: Option<&'a Bump>,
}

impl Described<'_> {
    /// Whether rays keep in mind that they are inside: solids that refract, and mist.
    fn is_medium(&self) -> bool {
        self.material.ior.is_some() || self.material.density.is_some()
    }
}

/// What a node without a material has.
static DEFAULT: LazyLock<scene::Material> = LazyLock::new(scene::Material::default);

fn describe<'a>(graph: &'a SceneGraph, placement: &Placement) -> (Key, Described<'a>) {
    let node = graph.node(placement.node);
    let material = placement.material.map_or(&*DEFAULT, |id| &graph.materials[id.0 as usize]);
    let texture = node.texture.as_ref().or(material.texture.as_ref());
    // Mist has no surface to bump.
    let bump = node.bump.as_ref().or(material.bump.as_ref()).filter(|_| material.density.is_none());
    let bump_key = bump.map(|bump| match bump {
        Bump::Image(image) => BumpKey::Image(Arc::as_ptr(image)),
        Bump::Noise { z } => BumpKey::Noise(z.to_bits()),
    });
    let key = Key { material: placement.material, texture: texture.map(Arc::as_ptr), bump: bump_key };
    (key, Described { material, texture, bump })
}

/// The materials in use, packed, and the index of that of each placement.
pub struct MaterialsInUse {
    pub packed: Vec<Material>,
    pub of_placement: Vec<u32>,
}

/// The materials of the placements, the refractive ones first: the number of a medium is the index of its material
/// plus 1, which is how the kernels find its refractive index. Adds the images of the materials to the atlas.
///
/// # Errors
/// [`Error::Scene`] for more media than [`MAX_MEDIA`], and what [`Atlas::add`] refuses.
pub fn materials_in_use<'a>(
    scene: &'a Scene,
    placements: &[Placement],
    atlas: &mut Atlas<'a>,
) -> Result<MaterialsInUse> {
    let mut numbers = HashMap::new();
    let mut found = Vec::new();
    let mut number = |placement| {
        let (key, described) = describe(&scene.graph, placement);
        *numbers.entry(key).or_insert_with(|| {
            found.push(described);
            found.len() - 1
        })
    };
    let of_placement: Vec<usize> = placements.iter().map(&mut number).collect();
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by_key(|&number| !found[number].is_medium());
    let media = found.iter().filter(|described| described.is_medium()).count();
    if media > MAX_MEDIA as usize {
        return Err(Error::Scene(format!(
            "the scene uses {media} refractive materials and mists; at most {MAX_MEDIA} are possible"
        )));
    }
    // One glossy ray is none: the reflection is a mirror's.
    let spread = if scene.sampling.glossy > 1 { 1.0 } else { 0.0 };
    let mut packed = Vec::with_capacity(order.len());
    let mut places = vec![0; order.len()];
    for (place, &number) in (0..).zip(&order) {
        packed.push(pack(&found[number], place + 1, spread, atlas)?);
        places[number] = place;
    }
    Ok(MaterialsInUse { packed, of_placement: of_placement.into_iter().map(|number| places[number]).collect() })
}

fn pack<'a>(described: &Described<'a>, medium: u32, spread: f32, atlas: &mut Atlas<'a>) -> Result<Material> {
    let material = described.material;
    let mut packed = Material {
        diffuse: material.diffuse,
        shininess: material.shininess,
        specular: material.specular,
        reflection: material.reflection,
        emission: material.emission,
        glossy: material.glossy * spread,
        ior: material.ior.unwrap_or(0.0),
        density: 0.0,
        noise_z: 0.0,
        flags: 0,
        texture: NONE,
        bump: NONE,
        medium: if described.is_medium() { medium } else { 0 },
        mist_step: 0.0,
    };
    if let Some(density) = material.density {
        packed.density = density;
        packed.flags |= MATERIAL_MIST;
        (packed.specular, packed.reflection, packed.ior, packed.emission) = (Vec3::ZERO, 0.0, 0.0, Vec3::ZERO);
    }
    if let Some(image) = described.texture {
        packed.texture = atlas.add(image)?;
        packed.flags |= MATERIAL_TEXTURE_REPLACES;
    }
    match described.bump {
        Some(Bump::Image(image)) => packed.bump = atlas.add(image)?,
        Some(Bump::Noise { z }) => {
            packed.noise_z = *z;
            packed.flags |= MATERIAL_NOISE_BUMP;
        }
        None => {}
    }
    Ok(packed)
}
