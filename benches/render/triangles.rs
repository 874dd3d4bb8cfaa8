//! One mesh of ever more triangles under the same view: what a ray costs should grow no faster than their logarithm.

use crate::measurement::{self, Measurement};
use crate::{Result, scene};
use glam::{DVec3, Vec3};
use gpu_trace::scene::{Geometry, Mesh, Node, Scene, SceneGraph, Shape};
use std::sync::Arc;

/// Thousands of triangles.
const THOUSANDS: [u32; 5] = [10, 100, 1000, 2000, 10_000];

/// The name of the scene with that many thousands of triangles, as [`scene::load`] knows it.
fn name(thousands: u32) -> String {
    format!("hills-{thousands}k")
}

/// Thousands of triangles in the scene of that name.
pub fn thousands(name: &str) -> Option<u32> {
    name.strip_prefix("hills-")?.strip_suffix('k')?.parse().ok().filter(|thousands| *thousands > 0)
}

/// Measures each size on each device, in turn, prints a table, and returns the medians. What a device cannot hold is
/// told and left out.
pub fn report(devices: &[String], runs: u32, size: Option<[u32; 2]>, samples: Option<u32>) -> Result<Vec<Measurement>> {
    let mut measurements = Vec::new();
    let mut refused: Vec<(u32, &String)> = Vec::new();
    for run in 0..runs {
        for thousands in THOUSANDS {
            for device in devices {
                if refused.contains(&(thousands, device)) {
                    continue;
                }
                eprintln!("{} on {device}, run {} of {runs}", name(thousands), run + 1);
                match measurement::in_own_process(&name(thousands), device, size, samples) {
                    Ok(measurement) => measurements.push(measurement),
                    // The smallest fits every device: something else is wrong.
                    Err(error) if thousands == THOUSANDS[0] => return Err(error),
                    Err(error) => {
                        eprintln!("left out: {error}");
                        refused.push((thousands, device));
                    }
                }
            }
        }
    }
    let mut medians = Measurement::medians(measurements);
    medians.sort_by(|a, b| (&a.device, a.triangles).cmp(&(&b.device, b.triangles)));
    print(&medians);
    Ok(medians)
}

/// By device, the fewest triangles first.
fn print(medians: &[Measurement]) {
    println!(
        "| device | triangles | packing and BVH s | Mray/s | cost of a ray, times the first | logarithm of triangles, \
         times the first | peak MiB |\n|---|--:|--:|--:|--:|--:|--:|"
    );
    for rows in medians.chunk_by(|a, b| a.device == b.device) {
        for run in rows {
            println!(
                "| {} | {} | {:.3} | {:.2} | {:.2} | {:.2} | {} |",
                run.device,
                run.triangles,
                run.mesh_seconds,
                run.mrays_per_second(),
                rows[0].mrays_per_second() / run.mrays_per_second(),
                (run.triangles as f64).ln() / (rows[0].triangles as f64).ln(),
                run.peak_memory >> 20,
            );
        }
    }
}

/// Hills that all but fill the picture, in the light of scenes/bench/mesh.lua.
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
