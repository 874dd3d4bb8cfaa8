//! What flattening keeps from scene to scene: built meshes and packed images.

use super::mesh::BuiltMesh;
use crate::Result;
use crate::scene::{Image, Mesh};
use rayon::prelude::*;
use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::Hasher;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Meshes with their hierarchies, and images with their levels, of the scenes flattened lately. May be used from
/// several threads, but not from inside rayon's, whose tasks could then wait for one another.
///
/// A mesh is known again by its allocation, which the cache keeps alive so that no other can take its address, or else
/// by its contents, bit for bit: scripts make meshes of tables anew in every run. Images come from files, which
/// [`crate::script::Library`] keeps; they are known by their allocations alone.
#[derive(Debug, Default)]
pub struct FlattenCache {
    kept: Option<Mutex<Kept>>,
    /// Scenes that an unused mesh or image outlives.
    keep: u64,
}

/// How often meshes were built and images packed, and how often that was spared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlattenCounts {
    pub meshes_built: u64,
    pub meshes_reused: u64,
    pub images_packed: u64,
    pub images_reused: u64,
}

#[derive(Debug, Default)]
struct Kept {
    /// The number of the scene in hand.
    scene: u64,
    meshes: Vec<KeptMesh>,
    /// By their addresses.
    images: HashMap<usize, KeptImage>,
    counts: FlattenCounts,
}

#[derive(Debug)]
struct KeptMesh {
    mesh: Arc<Mesh>,
    /// Of the contents.
    hash: u64,
    built: Arc<BuiltMesh>,
    last_scene: u64,
}

#[derive(Debug)]
struct KeptImage {
    /// Keeps the address taken.
    _image: Arc<Image>,
    packed: Arc<Vec<u32>>,
    last_scene: u64,
}

impl FlattenCache {
    /// A cache that keeps nothing.
    pub fn none() -> Self {
        FlattenCache::default()
    }

    /// A cache that drops what `keep` scenes in a row did not use.
    pub fn new(keep: u64) -> Self {
        FlattenCache { kept: Some(Mutex::default()), keep }
    }

    pub fn counts(&self) -> FlattenCounts {
        self.lock().map_or_else(FlattenCounts::default, |kept| kept.counts)
    }

    /// Begins a scene: what has been unused for too long goes.
    pub(super) fn begin_scene(&self) {
        let Some(mut kept) = self.lock() else { return };
        kept.scene += 1;
        let oldest = kept.scene.saturating_sub(self.keep);
        kept.meshes.retain(|mesh| mesh.last_scene >= oldest);
        kept.images.retain(|_, image| image.last_scene >= oldest);
    }

    /// Each mesh built, those that are not known by `build` and in parallel.
    ///
    /// # Errors
    /// Those of `build`.
    pub(super) fn built(
        &self,
        meshes: &[&Arc<Mesh>],
        build: impl Fn(&Mesh) -> Result<BuiltMesh> + Sync,
    ) -> Result<Vec<Arc<BuiltMesh>>> {
        let Some(mut kept) = self.lock() else {
            return meshes.par_iter().map(|mesh| build(mesh).map(Arc::new)).collect();
        };
        // Locked until all are built: another scene that needs the same meshes at the same time then finds them.
        let known: Vec<Option<Arc<BuiltMesh>>> = meshes.iter().map(|mesh| kept.find_mesh(mesh)).collect();
        let finished = meshes
            .par_iter()
            .zip(&known)
            .map(|(mesh, known)| match known {
                Some(built) => Ok((None, Arc::clone(built))),
                None => build(mesh).map(|built| (Some(contents_hash(mesh)), Arc::new(built))),
            })
            .collect::<Result<Vec<_>>>()?;
        let last_scene = kept.scene;
        for (mesh, (hash, built)) in meshes.iter().zip(&finished) {
            match hash {
                Some(hash) => {
                    kept.counts.meshes_built += 1;
                    let (mesh, built) = (Arc::clone(mesh), Arc::clone(built));
                    kept.meshes.push(KeptMesh { mesh, hash: *hash, built, last_scene });
                }
                None => kept.counts.meshes_reused += 1,
            }
        }
        Ok(finished.into_iter().map(|(_, built)| built).collect())
    }

    /// The image packed, by `pack` where it is not known.
    pub(super) fn packed(&self, image: &Arc<Image>, pack: impl FnOnce(&Image) -> Vec<u32>) -> Arc<Vec<u32>> {
        let Some(mut kept) = self.lock() else { return Arc::new(pack(image)) };
        let scene = kept.scene;
        let address = Arc::as_ptr(image) as usize;
        if let Some(known) = kept.images.get_mut(&address) {
            known.last_scene = scene;
            let packed = Arc::clone(&known.packed);
            kept.counts.images_reused += 1;
            return packed;
        }
        let packed = Arc::new(pack(image));
        kept.counts.images_packed += 1;
        let entry = KeptImage { _image: Arc::clone(image), packed: Arc::clone(&packed), last_scene: scene };
        kept.images.insert(address, entry);
        packed
    }

    fn lock(&self) -> Option<MutexGuard<'_, Kept>> {
        // Entries are whole at any time, whatever may have panicked.
        self.kept.as_ref().map(|kept| kept.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Kept {
    fn find_mesh(&mut self, mesh: &Arc<Mesh>) -> Option<Arc<BuiltMesh>> {
        let scene = self.scene;
        let by_address = self.meshes.iter().position(|kept| Arc::ptr_eq(&kept.mesh, mesh));
        let place = by_address.or_else(|| {
            // The size is compared first, so that a mesh of a new size costs nothing.
            if !self.meshes.iter().any(|kept| same_size(&kept.mesh, mesh)) {
                return None;
            }
            let hash = contents_hash(mesh);
            self.meshes.iter().position(|kept| kept.hash == hash && same_contents(&kept.mesh, mesh))
        })?;
        let found = &mut self.meshes[place];
        // The later allocation is the one that may be asked for again.
        found.mesh = Arc::clone(mesh);
        found.last_scene = scene;
        Some(Arc::clone(&found.built))
    }
}

/// Everything that building a mesh reads; its name is for messages.
fn parts(mesh: &Mesh) -> [&[u8]; 4] {
    [
        bytemuck::cast_slice(&mesh.positions),
        bytemuck::cast_slice(&mesh.normals),
        bytemuck::cast_slice(&mesh.uvs),
        bytemuck::cast_slice(&mesh.triangles),
    ]
}

fn same_size(a: &Mesh, b: &Mesh) -> bool {
    parts(a).map(<[u8]>::len) == parts(b).map(<[u8]>::len)
}

fn same_contents(a: &Mesh, b: &Mesh) -> bool {
    parts(a) == parts(b)
}

fn contents_hash(mesh: &Mesh) -> u64 {
    let mut hasher = DefaultHasher::new();
    for part in parts(mesh) {
        hasher.write_usize(part.len());
        hasher.write(part);
    }
    hasher.finish()
}
