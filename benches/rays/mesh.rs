//! The mesh of scenes/bench/mesh.lua in one piece, flat.

use crate::Result;
use glam::Vec3;
use gpu_trace::scene::{Geometry, Mesh, Node, Scene, SceneGraph, Shape};
use gpu_trace::script::{ScriptOptions, load_scene};
use std::path::Path;
use std::sync::Arc;

/// A scene of the mesh alone, in a square picture with edges of `edge` pixels.
pub fn scene(edge: u32) -> Result<(Scene, Arc<Mesh>)> {
    let scenes = load_scene(Path::new("scenes/bench/mesh.lua"), &ScriptOptions::default())?;
    let [mut scene] = <[Scene; 1]>::try_from(scenes).map_err(|_| "scenes/bench/mesh.lua has more than one picture")?;
    let mut whole = Mesh { name: "balls and floor".into(), ..Mesh::default() };
    for node in &scene.graph.nodes {
        let Some(Geometry { shape: Shape::Mesh(mesh), .. }) = &node.geometry else { continue };
        let base = whole.positions.len() as u32;
        whole.positions.extend(&mesh.positions);
        whole.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| base + corner)));
    }
    let mesh = Arc::new(whole);
    let mut graph = SceneGraph::default();
    scene.root = graph.add_node(Node::new("mesh", Some(Geometry::new(Shape::Mesh(mesh.clone())))));
    scene.graph = Arc::new(graph);
    scene.size = [edge, edge];
    Ok((scene, mesh))
}

/// The corners of each triangle in a row, little-endian, as benches/peers/rays.cpp reads them.
pub fn corners(mesh: &Mesh) -> Vec<u8> {
    let corner = |&index: &u32| mesh.positions[index as usize];
    let bytes = |corner: Vec3| corner.to_array().into_iter().flat_map(f32::to_le_bytes);
    mesh.triangles.iter().flatten().map(corner).flat_map(bytes).collect()
}
