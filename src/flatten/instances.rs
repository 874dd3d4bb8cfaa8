//! Placements as instances in the kernel's layout, and the hierarchy over them.

use super::bounds::{Bounds, shape_bounds};
use super::bvh;
use super::mesh::Meshes;
use super::mist::Mists;
use super::rebraid;
use super::walk::Placement;
use crate::layout::{
    AffineRows, INSTANCE_MIST, INSTANCE_SEEN, INSTANCE_SHADES, Instance, NONE, Node, SHAPE_CONE, SHAPE_CUBE,
    SHAPE_CYLINDER, SHAPE_MESH, SHAPE_PLANE, SHAPE_SPHERE, SHAPE_TORUS,
};
use crate::scene::{SceneGraph, Shape};
use crate::{Error, Result};
use glam::{DAffine3, DVec3, Vec4};
use obvhs::aabb::Aabb;

/// World coordinates beyond this have areas that single precision cannot add up.
const MAX_COORDINATE: f64 = 1e12;

/// A bounded shape, or a part of one, as the upper level of the hierarchy has it.
#[derive(Clone, Copy)]
pub struct Member {
    /// The index of a mesh stands in for its root, which is known once the upper level is built.
    pub instance: Instance,
    /// In world space.
    pub bounds: Aabb,
    /// The node, of the mesh's own, that rays enter it at.
    pub entry: u32,
    pub world_from_object: DAffine3,
}

/// The upper level of the hierarchy and what it is over.
pub struct BuiltInstances {
    pub instances: Vec<Instance>,
    /// Shapes that were placed: those that are in parts are one here, and several in `instances`.
    pub placed: usize,
    pub plane_count: u32,
    /// After the planes; the others after them are mists.
    pub surface_count: u32,
    /// The hierarchy over the surfaces, root first, then that over the mists; each empty where there are none.
    pub nodes: Vec<Node>,
    /// Root of the hierarchy over the mists, if there are any.
    pub mist_root: u32,
    /// Triangles over all instances.
    pub instanced_triangles: u64,
    /// Levels of nodes, those of the deepest mesh included.
    pub depth: u32,
}

/// `materials` has one index for each placement.
pub fn build(
    graph: &SceneGraph,
    placements: &[Placement],
    meshes: &Meshes,
    materials: &[u32],
    mut mists: Mists,
) -> Result<BuiltInstances> {
    let mut planes = Vec::new();
    let mut members = Vec::with_capacity(placements.len());
    let mut instanced_triangles = 0;
    for (placement, &material) in placements.iter().zip(materials) {
        let name = &graph.node(placement.node).name;
        if let Shape::Mesh(mesh) = &placement.geometry.shape
            && meshes.index_of(mesh).is_none_or(|index| meshes.built[index].triangles.is_empty())
        {
            continue;
        }
        let mut world_from_object = placement.world_from_object;
        let mut mist_step = None;
        if mists.holds(material) {
            let Some(object_bounds) = object_bounds(&placement.geometry.shape, meshes) else {
                return Err(Error::Scene(format!(
                    "node '{name}': a plane has no inside that mist could fill; use a closed shape, such as a large cube"
                )));
            };
            let (grown, step) = mists.grown(&world_from_object, &object_bounds);
            (world_from_object, mist_step) = (grown, Some(step));
        }
        let mut instance = pack(&placement.geometry.shape, &world_from_object, name)?;
        instance.material = material;
        if !casts_shadow(graph, placement) {
            instance.flags &= !INSTANCE_SHADES;
        }
        if let Some(step) = mist_step {
            mists.mark(&mut instance, step)?;
        }
        let bounds = match &placement.geometry.shape {
            Shape::Mesh(mesh) => {
                let Some(index) = meshes.index_of(mesh) else { continue };
                let mesh = &meshes.built[index];
                instance.root = index as u32;
                instance.parameters = mesh.uv_rectangle;
                instanced_triangles += mesh.triangles.len() as u64;
                mesh.bounds_in(&world_from_object)
            }
            shape => match shape_bounds(shape, &world_from_object) {
                Some(bounds) => bounds,
                None => {
                    planes.push(instance);
                    continue;
                }
            },
        };
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        if reach.is_nan() || reach > MAX_COORDINATE {
            return Err(Error::Scene(format!(
                "node '{name}' reaches from {} to {}; coordinates must lie within ±1e12",
                bounds.min, bounds.max
            )));
        }
        members.push(Member { instance, bounds: bounds.padded(), entry: 0, world_from_object });
    }
    let placed = planes.len() + members.len();
    Ok(ordered(planes, &rebraid::open(members, meshes), meshes, placed, instanced_triangles))
}

fn casts_shadow(graph: &SceneGraph, placement: &Placement) -> bool {
    placement.material.is_none_or(|id| graph.materials[id.0 as usize].casts_shadow)
}

/// Planes first, then surfaces and then mists, each in the order of their leaves; the roots of meshes where `flatten`
/// will put them.
fn ordered(
    planes: Vec<Instance>,
    members: &[Member],
    meshes: &Meshes,
    placed: usize,
    instanced_triangles: u64,
) -> BuiltInstances {
    let plane_count = planes.len() as u32;
    let (mists, surfaces): (Vec<&Member>, Vec<&Member>) =
        members.iter().partition(|member| member.instance.flags & INSTANCE_MIST != 0);
    let build = |members: &[&Member]| {
        let boxes: Vec<Aabb> = members.iter().map(|member| member.bounds).collect();
        bvh::over_instances(&boxes, |i| members[i as usize].instance.shape == SHAPE_MESH)
    };
    let (over_surfaces, over_mists) = (build(&surfaces), build(&mists));
    let surface_count = surfaces.len() as u32;
    let mut nodes = Vec::new();
    bvh::append(&mut nodes, &over_surfaces.nodes, plane_count);
    let mist_root = nodes.len() as u32;
    bvh::append(&mut nodes, &over_mists.nodes, plane_count + surface_count);
    let mut end = nodes.len() as u32;
    let mut roots = Vec::with_capacity(meshes.built.len());
    for mesh in &meshes.built {
        roots.push(end);
        end += mesh.hierarchy.nodes.len() as u32;
    }
    let mut instances = planes;
    let in_order = over_surfaces.order.iter().map(|&i| surfaces[i as usize]);
    let in_order = in_order.chain(over_mists.order.iter().map(|&i| mists[i as usize]));
    instances.extend(in_order.map(|member| {
        let mut instance = member.instance;
        if instance.shape == SHAPE_MESH {
            instance.root = roots[instance.root as usize] + member.entry;
        }
        instance
    }));
    let mesh_depth = meshes.built.iter().map(|mesh| mesh.hierarchy.depth).max().unwrap_or(0);
    let depth = over_surfaces.depth.max(over_mists.depth) + mesh_depth;
    BuiltInstances { instances, placed, plane_count, surface_count, nodes, mist_root, instanced_triangles, depth }
}

/// The box around a shape in its own space; `None` for a plane.
fn object_bounds(shape: &Shape, meshes: &Meshes) -> Option<Bounds> {
    match shape {
        Shape::Mesh(mesh) => Some(meshes.built[meshes.index_of(mesh)?].bounds),
        shape => shape_bounds(shape, &DAffine3::IDENTITY),
    }
}

fn pack(shape: &Shape, world_from_object: &DAffine3, name: &str) -> Result<Instance> {
    let (shape, parameters) = match *shape {
        Shape::Sphere => (SHAPE_SPHERE, Vec4::ZERO),
        Shape::Cube => (SHAPE_CUBE, Vec4::ZERO),
        Shape::Cylinder => (SHAPE_CYLINDER, Vec4::ZERO),
        Shape::Cone => (SHAPE_CONE, Vec4::ZERO),
        Shape::Torus { major, minor } => (SHAPE_TORUS, Vec4::new(major as f32, minor as f32, 0.0, 0.0)),
        Shape::Plane => (SHAPE_PLANE, Vec4::ZERO),
        Shape::Mesh(_) => (SHAPE_MESH, Vec4::ZERO),
    };
    if shape == SHAPE_TORUS && !(parameters.is_finite() && parameters.x > 0.0 && parameters.y > 0.0) {
        return Err(Error::Scene(format!("node '{name}': the radii of a torus must be above 0")));
    }
    let instance = Instance {
        object_from_world: rows(&world_from_object.inverse()),
        shape,
        material: 0,
        root: NONE,
        flags: INSTANCE_SEEN | INSTANCE_SHADES,
        world_from_object: rows(world_from_object),
        parameters,
    };
    if !instance.object_from_world.iter().chain(&instance.world_from_object).all(|row| row.is_finite()) {
        return Err(Error::Scene(format!("node '{name}': its transform leaves the range of single precision")));
    }
    Ok(instance)
}

fn rows(map: &DAffine3) -> AffineRows {
    let axes = map.matrix3.transpose();
    let row = |axis: DVec3, translation: f64| axis.as_vec3().extend(translation as f32);
    [row(axes.x_axis, map.translation.x), row(axes.y_axis, map.translation.y), row(axes.z_axis, map.translation.z)]
}
