//! Large scenes: what they took is told, and the number of threads changes nothing.

use crate::support::{Stage, paint};
use assert_cmd::Command;
use glam::{DAffine3, Vec2, Vec3};
use gpu_trace::flatten::{SceneBuffers, flatten};
use gpu_trace::scene::{Mesh, Scene, Shape};
use predicates::str::contains;
use std::fs;
use std::sync::Arc;

#[test]
fn the_figures_of_a_scene_are_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = "
        local square = gr.mesh{ positions = {0,0,0, 1,0,0, 1,1,0, 0,1,0}, faces = {{0,1,2,3}} }
        local root = gr.node('root')
        for i = 1, 3 do
          local place = gr.node('place')
          place:translate(i, 0, 0)
          place:add_child(square)
          root:add_child(place)
        end
        root:add_child(gr.sphere('ball'))
        gr.render{ scene = root, output = 'a.png', size = {4, 4}, camera = { eye = {0,0,9}, look_at = {0,0,0} } }";
    fs::write(folder.path().join("scene.lua"), scene).expect("a writable folder");
    let output = Command::new(env!("CARGO_BIN_EXE_gpu-trace"))
        .current_dir(folder.path())
        .args(["scene.lua", "--device", "cpu", "-v", "--json", "-"])
        .assert()
        .success()
        .stderr(contains("scene: 2 triangles in 1 mesh, 4 instances, 6 triangles unrolled; script "))
        .get_output()
        .stdout
        .clone();
    let report: serde_json::Value = serde_json::from_slice(&output).expect("one JSON object");
    for (key, value) in [("meshes", 1), ("triangles", 2), ("instances", 4), ("unrolled_triangles", 6)] {
        assert_eq!(report[key], value, "{key}");
    }
    let number = |key: &str| report[key].as_f64().unwrap_or_else(|| panic!("{key} of {report}"));
    assert!(number("script_seconds") > 0.0);
    assert!(0.0 < number("mesh_seconds") && number("mesh_seconds") <= number("flatten_seconds"));
    // Two triangles and four instances at the least.
    assert!(number("buffer_bytes") > 600.0);
    if cfg!(target_os = "linux") {
        assert!(number("peak_memory_bytes") > number("buffer_bytes"));
    }
}

#[test]
fn any_number_of_threads_flattens_to_the_same() {
    let scene = hills(150);
    let of_threads = |count: usize| -> SceneBuffers {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads");
        pool.install(|| flatten(&scene)).unwrap_or_else(|error| panic!("{error}"))
    };
    let [one, three] = [1, 3].map(of_threads);
    assert_eq!(one.triangles.len(), 2 * 150 * 150);
    assert_eq!(bytemuck::cast_slice::<_, u8>(&one.triangles), bytemuck::cast_slice::<_, u8>(&three.triangles));
    assert_eq!(bytemuck::cast_slice::<_, u8>(&one.nodes), bytemuck::cast_slice::<_, u8>(&three.nodes));
    assert_eq!(bytemuck::cast_slice::<_, u8>(&one.instances), bytemuck::cast_slice::<_, u8>(&three.instances));
}

/// A wavy square of so many cells along each edge, two triangles each.
fn hills(cells: u32) -> Scene {
    let mut mesh = Mesh { name: "hills".to_owned(), ..Mesh::default() };
    for row in 0..=cells {
        for column in 0..=cells {
            let (x, z) = (column as f32 / cells as f32, row as f32 / cells as f32);
            mesh.positions.push(Vec3::new(x, 0.1 * (9.0 * x).sin() * (7.0 * z).cos(), z));
            mesh.uvs.push(Vec2::new(3.0 * x - 1.0, z));
        }
    }
    for row in 0..cells {
        for column in 0..cells {
            let corner = row * (cells + 1) + column;
            let below = corner + cells + 1;
            mesh.triangles.extend([[corner, below, below + 1], [corner, below + 1, corner + 1]]);
        }
    }
    mesh.smooth_normals();
    let mut stage = Stage::new(4, 4);
    stage.add(Shape::Mesh(Arc::new(mesh)), DAffine3::IDENTITY, paint(0.5, 0.5, 0.5));
    stage.finish()
}
