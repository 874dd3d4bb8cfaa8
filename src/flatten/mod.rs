//! From the scene graph to the buffers that both renderers read.

mod atlas;
mod binned;
mod bounds;
mod bvh;
mod cache;
mod features;
mod frame;
mod instances;
mod lights;
mod materials;
mod mesh;
mod mist;
mod rebraid;
mod support;
mod walk;
mod work;

pub use bvh::TRAVERSAL_STACK;
pub use cache::{FlattenCache, FlattenCounts};
pub use features::FeatureSet;
pub use mesh::encode_octahedral;
pub use work::{MAX_DEEP_LIGHT_SAMPLES, MAX_GLOSSY_SAMPLES, MAX_LIGHT_SAMPLES, WorkPlan, plan_work};

use crate::Result;
use crate::layout::{Frame, Instance, Light, Material, Node, Triangle};
use crate::scene::{Sampling, Scene};
use std::time::Instant;

/// Everything that the renderers read; `layout` says what each field holds.
#[derive(Clone, Debug, Default)]
pub struct SceneBuffers {
    pub frame: Frame,
    /// The hierarchy over the surfaces, root first, that over the mists, and then one for each mesh.
    pub nodes: Vec<Node>,
    /// Infinite planes first (`frame.plane_count`), then the leaves of the hierarchies in their order.
    pub instances: Vec<Instance>,
    /// Mesh after mesh, each in the order of its hierarchy's leaves.
    pub triangles: Vec<Triangle>,
    /// Those in use.
    pub materials: Vec<Material>,
    pub lights: Vec<Light>,
    /// The distinct images in use; `shaders/shading/texture.wgsl` describes the format.
    pub texels: Vec<u32>,
    /// The rays that the scene asks for.
    pub sampling: Sampling,
    /// What the kernel is specialised to.
    pub features: FeatureSet,
    /// What flattening did, for messages.
    pub statistics: Statistics,
}

/// What flattening did, for messages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Different meshes, each stored once.
    pub meshes: usize,
    /// Triangles of those meshes.
    pub triangles: usize,
    /// Planes and light sources that show included.
    pub instances: usize,
    /// Triangles over all instances, as if each were a copy.
    pub instanced_triangles: u64,
    /// Triangles without an area, left out.
    pub degenerate_triangles: usize,
    /// Levels of nodes from the root to the deepest leaf, over both levels of the hierarchy.
    pub depth: u32,
    /// Of all buffers together.
    pub buffer_bytes: usize,
    /// Wall-clock time that the script took to ask for the scene, seconds: set by whoever ran it.
    pub script_seconds: f64,
    /// Wall-clock time of flattening, seconds.
    pub seconds: f64,
    /// The share of `seconds` in which meshes were packed and their hierarchies built.
    pub mesh_seconds: f64,
}

impl SceneBuffers {
    /// Bytes of all arrays together.
    fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.instances.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.materials.as_slice())
            + size_of_val(self.lights.as_slice())
            + size_of_val(self.texels.as_slice())
    }
}

/// Flattens a scene: one instance for each path from the root to a geometry node, meshes stored once.
///
/// # Errors
/// [`crate::Error::Scene`] where the graph has a cycle or too many paths, where a transform cannot be inverted or
/// leaves the range of f32, where a mesh refers to vertices that it lacks, where images are too large, or where the
/// camera is degenerate.
pub fn flatten(scene: &Scene) -> Result<SceneBuffers> {
    flatten_with(scene, &FlattenCache::none())
}

/// As [`flatten`], which gives the same buffers; meshes and images that the cache knows are not built again.
///
/// # Errors
/// As [`flatten`].
pub fn flatten_with(scene: &Scene, cache: &FlattenCache) -> Result<SceneBuffers> {
    let start = Instant::now();
    let scene = &*lights::with_visible_lights(scene);
    let placements = walk::placements(scene)?;
    cache.begin_scene();
    let mesh_start = Instant::now();
    let meshes = mesh::build_all(&placements, cache)?;
    let mesh_seconds = mesh_start.elapsed().as_secs_f64();
    let mut atlas = atlas::Atlas::new(cache);
    let materials::MaterialsInUse { packed: mut materials, of_placement } =
        materials::materials_in_use(scene, &placements, &mut atlas)?;
    let mists = mist::Mists::new(&mut materials, scene.camera.eye);
    let built = instances::build(&scene.graph, &placements, &meshes, &of_placement, mists)?;
    let lights = lights::lights(scene)?;
    let mut frame = frame::frame(scene, &built)?;
    if let Some(image) = &scene.background.image {
        frame.background_image = atlas.add(image)?;
    }

    let mut nodes = built.nodes;
    let mut triangles = Vec::with_capacity(meshes.built.iter().map(|mesh| mesh.triangles.len()).sum());
    for mesh in &meshes.built {
        bvh::append(&mut nodes, &mesh.hierarchy.nodes, triangles.len() as u32);
        triangles.extend_from_slice(&mesh.triangles);
    }
    let mut buffers = SceneBuffers {
        frame,
        nodes,
        instances: built.instances,
        triangles,
        materials,
        lights,
        texels: atlas.into_texels(),
        sampling: scene.sampling,
        features: FeatureSet::ALL_OFF,
        statistics: Statistics {
            meshes: meshes.built.len(),
            instances: built.placed,
            instanced_triangles: built.instanced_triangles,
            degenerate_triangles: meshes.built.iter().map(|mesh| mesh.degenerate).sum(),
            depth: built.depth,
            mesh_seconds,
            ..Statistics::default()
        },
    };
    buffers.features = FeatureSet::of(&buffers);
    buffers.statistics.triangles = buffers.triangles.len();
    buffers.statistics.buffer_bytes = buffers.bytes();
    buffers.statistics.seconds = start.elapsed().as_secs_f64();
    Ok(buffers)
}
