//! One mesh of ever more triangles under the same view: what a ray costs should grow no faster than their logarithm.

use crate::measurement::{self, Measurement};
use crate::{Result, scene};
use glam::{DVec3, Vec3};
use gpu_trace::scene::{Geometry, Mesh, Node, Scene, SceneGraph, Shape};
use std::sync::Arc;

/// Thousands of triangles.
const THOUSANDS: [u32; 5] = [10, 100, 1000, 2000, 10_000];
/// Lavapipe binds 128 MiB a buffer.
const MOST_ON_GPU: u32 = 2000;

/// The name of the scene with that many thousands of triangles, as [`scene::load`] knows it.
fn name(thousands: u32) -> String {
    format!("hills-{thousands}k")
}

/// Thousands of triangles in the scene of that name.
pub fn thousands(name: &str) -> Option<u32> {
    name.strip_prefix("hills-")?.strip_suffix('k')?.parse().ok().filter(|thousands| *thousands > 0)
}

pub fn report(devices: &[String], runs: u32) -> Result<()> {
    println!(
        "| device | triangles | BVH s | Mray/s | cost of a ray, times the first | logarithm of triangles, times the first \
         | peak MiB |\n|---|--:|--:|--:|--:|--:|--:|"
    );
    for device in devices {
        let mut first: Option<Measurement> = None;
        for thousands in THOUSANDS {
            if device != "cpu" && thousands > MOST_ON_GPU {
                continue;
            }
            let once = || measurement::in_own_process(&name(thousands), device, None, None);
            let medians = Measurement::medians((0..runs).map(|_| once()).collect::<Result<Vec<_>>>()?);
            let Some(run) = medians.into_iter().next() else { continue };
            let first = first.get_or_insert_with(|| run.clone());
            println!(
                "| {} | {} | {:.3} | {:.2} | {:.2} | {:.2} | {} |",
                run.device,
                run.triangles,
                run.mesh_seconds,
                run.mrays_per_second(),
                first.mrays_per_second() / run.mrays_per_second(),
                (run.triangles as f64).ln() / (first.triangles as f64).ln(),
                run.peak_memory >> 20,
            );
        }
    }
    Ok(())
}

/// Hills that fill the picture, in the light of scenes/bench/mesh.lua.
pub fn scene(thousands: u32) -> Result<Scene> {
    let mut scene = scene::load("mesh", Some([320, 240]), Some(8))?;
    let mut graph = SceneGraph::default();
    let mut node = Node::new("hills", Some(Geometry::new(Shape::Mesh(Arc::new(hills(thousands))))));
    let mut materials = scene.graph.materials.clone();
    materials.truncate(1);
    node.material = materials.pop().map(|material| graph.add_material(material));
    scene.root = graph.add_node(node);
    scene.graph = Arc::new(graph);
    scene.camera.eye = DVec3::new(0.0, 1.6, 2.6);
    scene.camera.forward = DVec3::new(0.0, -1.6, -2.4).normalize();
    Ok(scene)
}

/// A square of 8 by 8 world units about the origin.
fn hills(thousands: u32) -> Mesh {
    let cells = (f64::from(thousands) * 500.0).sqrt() as u32;
    let height = |x: f32, z: f32| 0.25 * (2.1 * x).sin() * (1.7 * z).sin() + 0.05 * (9.0 * x + 5.0 * z).sin();
    let at = |i: u32| 8.0 * (i as f32 / cells as f32 - 0.5);
    let vertices = (0..=cells).flat_map(|row| (0..=cells).map(move |column| (at(column), at(row))));
    let corners = |row: u32, column: u32| {
        let corner = row * (cells + 1) + column;
        let below = corner + cells + 1;
        [[corner, below, below + 1], [corner, below + 1, corner + 1]]
    };
    Mesh {
        name: "hills".into(),
        positions: vertices.map(|(x, z)| Vec3::new(x, height(x, z), z)).collect(),
        triangles: (0..cells).flat_map(|row| (0..cells).flat_map(move |column| corners(row, column))).collect(),
        ..Mesh::default()
    }
}
