//! What frames have in common is made once, and is never that of another frame.

use super::*;
use crate::support::{Stage, paint};
use glam::{DAffine3, Vec3};
use gpu_trace::flatten::{FlattenCache, SceneBuffers, flatten, flatten_with};
use gpu_trace::scene::{Mesh, Scene, Shape};
use gpu_trace::script::{Library, ScriptOptions, run_scene};
use std::sync::{Arc, Weak};
use std::time::{Duration, SystemTime};

/// A textured mesh of a file, and one of a table that changes in frame 3 alone.
const FILES: &str = r#"
local box = gr.mesh('box', 'box.obj')
box:set_material(gr.texture_material('check.png', {0, 0, 0}, 1))
scene:add_child(box)
local tip = gr.frame() == 3 and 1 or 0.5
local sail = gr.mesh('sail', {{0, 0, 2}, {1, 0, 2}, {0, tip, 2}}, {{0, 1, 2}})
sail:set_material(red)
scene:add_child(sail)
"#;

const OBJ: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";

/// Without the flag, which is a new mesh in each frame.
fn scene_of_files() -> String {
    swing(FILES).replace("scene:add_child(flag)", "")
}

fn write_files(folder: &Path) {
    fs::write(folder.join("box.obj"), OBJ).expect("a writable folder");
    let image = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([255 * ((x + y) % 2) as u8, 90, 200]));
    image.save(folder.join("check.png")).expect("a writable folder");
}

#[test]
fn meshes_images_and_files_are_made_once_and_again_where_they_change() {
    let folder = folder(&scene_of_files());
    let folder = folder.path();
    write_files(folder);
    program(folder, "scene.lua --frames 1..5 -o %d.png -q --jobs 1 --json report.json").assert().success();
    let reuse = &batch_report(folder, "report.json")["reuse"];
    for (key, count) in [
        ("files_read", 2),
        ("files_reused", 8),
        // The file's mesh, the sail of frame 1, and that of frame 3. That of frame 4 is still known from frame 2.
        ("meshes_built", 3),
        ("meshes_reused", 7),
        ("images_packed", 1),
        ("images_reused", 4),
        ("pipelines_compiled", 0),
    ] {
        assert_eq!(reuse[key], count, "{key} of {reuse}");
    }
    for frame in 1..=5 {
        program(folder, &format!("scene.lua {frame} --total-frames 5 -o single.png -q")).assert().success();
        assert_eq!(read(folder, "single.png"), read(folder, &format!("{frame}.png")), "frame {frame}");
    }
}

/// A missing device is a failure that says how to install one.
#[test]
fn the_gpu_compiles_once_and_uploads_what_changes() {
    let folder = folder(&scene_of_files());
    let folder = folder.path();
    write_files(folder);
    let line = "scene.lua --frames 1..4 -o %d.png -q --jobs 1 --device gpu --json report.json";
    program(folder, line).assert().success();
    let reuse = &batch_report(folder, "report.json")["reuse"];
    assert_eq!((&reuse["pipelines_compiled"], &reuse["pipelines_reused"]), (&1.into(), &3.into()), "{reuse}");
    // Six arrays a frame. In every frame instances and their hierarchy move; triangles change with the sail, to frame 3
    // and back; materials, lights and texels stay.
    assert_eq!(
        (&reuse["buffers_uploaded"], &reuse["buffers_reused"]),
        (&(6 + 2 + 3 + 3).into(), &10.into()),
        "{reuse}"
    );
    for frame in 1..=4 {
        let line = format!("scene.lua {frame} --total-frames 4 -o single.png -q --device gpu");
        program(folder, &line).assert().success();
        assert_eq!(read(folder, "single.png"), read(folder, &format!("{frame}.png")), "frame {frame}");
    }
}

/// A frame with another set of features has a kernel of its own, and the first one is still there afterwards.
#[test]
fn the_gpu_keeps_a_kernel_for_each_set_of_features() {
    let folder = folder(&swing("if gr.frame() == 2 then scene:add_child(gr.torus('ring')) end"));
    let line = "scene.lua --frames 1..3 -o %d.png -q --device gpu --json report.json";
    program(folder.path(), line).assert().success();
    let reuse = &batch_report(folder.path(), "report.json")["reuse"];
    assert_eq!((&reuse["pipelines_compiled"], &reuse["pipelines_reused"]), (&2.into(), &1.into()), "{reuse}");
}

/// The same length and another time: the version that was read before must not be taken for it.
#[test]
fn a_file_that_changes_between_runs_is_read_again() {
    let folder = folder("");
    let (obj, scene) = (folder.path().join("box.obj"), folder.path().join("scene.lua"));
    let script = "local box = gr.mesh('box', 'box.obj')\n\
                  gr.render(box, 'a.png', 8, 8, {0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 40, {1, 1, 1}, {})";
    fs::write(&scene, script).expect("a writable folder");
    let options = ScriptOptions { library: Arc::new(Library::new(2)), ..ScriptOptions::default() };
    let corner = || {
        let mut found = None;
        run_scene(&scene, &options, &mut |scene| {
            found = Some(mesh_of(&scene).positions[0].x);
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
        found.expect("a mesh")
    };
    let write = |text: &str, seconds: u64| {
        fs::write(&obj, text).expect("a writable folder");
        let time = SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
        fs::File::options().write(true).open(&obj).and_then(|file| file.set_modified(time)).expect("a file");
    };
    write(OBJ, 1_000_000);
    assert_eq!((corner(), corner(), options.library.counts().files_read), (-1.0, -1.0, 1));
    write(&OBJ.replace("v -1 -1", "v -2 -1"), 1_000_001);
    assert_eq!((corner(), options.library.counts().files_read), (-2.0, 2));
    assert_eq!(options.library.counts().files_reused, 1);
}

fn mesh_of(scene: &Scene) -> &Arc<Mesh> {
    scene
        .graph
        .nodes
        .iter()
        .find_map(|node| match &node.geometry.as_ref()?.shape {
            Shape::Mesh(mesh) => Some(mesh),
            _ => None,
        })
        .expect("a mesh")
}

fn triangle(x: f32) -> Arc<Mesh> {
    let positions = vec![Vec3::new(x, 0.0, -3.0), Vec3::new(1.0, 0.0, -3.0), Vec3::new(0.0, 1.0, -3.0)];
    Arc::new(Mesh { name: "triangle".into(), positions, triangles: vec![[0, 1, 2]], ..Mesh::default() })
}

fn stage_of(mesh: &Arc<Mesh>) -> Scene {
    let mut stage = Stage::new(8, 8);
    stage.add(Shape::Mesh(Arc::clone(mesh)), DAffine3::IDENTITY, paint(1.0, 1.0, 1.0));
    stage.finish()
}

fn flattened(scene: &Scene, cache: &FlattenCache) -> SceneBuffers {
    flatten_with(scene, cache).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_mesh_is_known_by_its_bits() {
    let cache = FlattenCache::new(10);
    // Equal numbers, other bits: 0 and -0. The next one is a unit in the last place off.
    let meshes = [triangle(0.0), triangle(0.0), triangle(-0.0), triangle(1e-45), triangle(-0.0)];
    for (mesh, built) in meshes.iter().zip([1, 1, 2, 3, 3]) {
        let scene = stage_of(mesh);
        let (with, without) = (flattened(&scene, &cache), flatten(&scene).unwrap_or_else(|error| panic!("{error}")));
        assert_eq!(cache.counts().meshes_built, built);
        let bits = |buffers: &SceneBuffers| bytemuck::cast_slice::<_, u8>(&buffers.triangles).to_vec();
        assert_eq!(bits(&with), bits(&without));
        assert_eq!(bytemuck::cast_slice::<_, u8>(&with.nodes), bytemuck::cast_slice::<_, u8>(&without.nodes));
    }
    assert_eq!(cache.counts().meshes_reused, 2);
}

#[test]
fn what_is_unused_goes() {
    let cache = FlattenCache::new(2);
    let mesh = triangle(0.25);
    let alive: Weak<Mesh> = Arc::downgrade(&mesh);
    flattened(&stage_of(&mesh), &cache);
    drop(mesh);
    let other = stage_of(&triangle(0.75));
    for scenes_without in 1..=3 {
        flattened(&other, &cache);
        assert_eq!(alive.upgrade().is_some(), scenes_without <= 2, "after {scenes_without} scenes without it");
    }
}
