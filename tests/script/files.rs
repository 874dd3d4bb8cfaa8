//! Where files are looked for.

use super::{RENDER, Sandbox};
use gpu_trace::scene::{Scene, Shape};
use std::sync::Arc;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn mesh(scene: &Scene, index: usize) -> &Arc<gpu_trace::scene::Mesh> {
    match &scene.graph.nodes[index].geometry.as_ref().unwrap().shape {
        Shape::Mesh(mesh) => mesh,
        other => panic!("not a mesh: {other:?}"),
    }
}

#[test]
fn the_scenes_folder_its_parent_and_grandparent_and_their_assets_are_searched() {
    for place in ["", "../", "../../", "Assets/", "../Assets/", "../../Assets/"] {
        let sandbox = Sandbox::new();
        sandbox.write(&format!("{place}models/t.obj"), TRIANGLE);
        let scenes = sandbox.load(&format!("root = gr.mesh('m', 'models/t.obj') {RENDER}")).unwrap();
        assert_eq!(mesh(&scenes[0], 0).triangles, [[0, 1, 2]], "{place}");
    }
}

#[test]
fn the_nearer_file_wins() {
    let sandbox = Sandbox::new();
    sandbox.write("t.obj", TRIANGLE);
    sandbox.write("Assets/t.obj", "v 0 0 0\n");
    sandbox.write("../t.obj", "nonsense");
    assert!(sandbox.load(&format!("root = gr.mesh('m', 't.obj') {RENDER}")).is_ok());
}

#[test]
fn the_working_folder_comes_first() {
    let sandbox = Sandbox::new();
    let working = std::env::current_dir().unwrap();
    let file = tempfile::Builder::new().prefix("gpu-trace-test-").suffix(".obj").tempfile_in(&working).unwrap();
    std::fs::write(file.path(), TRIANGLE).unwrap();
    let name = file.path().file_name().unwrap().to_str().unwrap();
    sandbox.write(name, "nonsense");
    let scenes = sandbox.load(&format!("root = gr.mesh('m', '{name}') {RENDER}")).unwrap();
    assert_eq!(mesh(&scenes[0], 0).name, name);
}

#[test]
fn a_missing_file_lists_where_it_was_looked_for() {
    let sandbox = Sandbox::new();
    let (message, _) = sandbox.failure("\ngr.mesh('m', 'gone.obj')");
    let root = sandbox.root.path().canonicalize().unwrap();
    let root = root.display();
    assert_eq!(
        message,
        format!(
            "scene.lua:2: gr.mesh: argument 2: cannot find 'gone.obj'; looked for 'gone.obj', 'Assets/gone.obj', \
             'gone.obj', 'Assets/gone.obj', '{root}/a/b/c/gone.obj', '{root}/a/b/c/Assets/gone.obj', \
             '{root}/a/b/gone.obj', '{root}/a/b/Assets/gone.obj'"
        )
    );
}

#[test]
fn one_file_is_loaded_once() {
    let sandbox = Sandbox::new();
    sandbox.write("t.obj", TRIANGLE);
    let scenes =
        sandbox.load(&format!("root = gr.mesh('a', 't.obj') gr.mesh('b', '../d/t.obj') {RENDER} {RENDER}")).unwrap();
    assert!(Arc::ptr_eq(mesh(&scenes[0], 0), mesh(&scenes[0], 1)));
    assert!(Arc::ptr_eq(mesh(&scenes[0], 0), mesh(&scenes[1], 0)));
}

#[test]
fn folders_and_devices_are_no_files() {
    let sandbox = Sandbox::new();
    sandbox.write("folder/t.obj", TRIANGLE);
    for name in ["folder", "/dev/null"] {
        let (message, _) = sandbox.failure(&format!("gr.mesh('m', '{name}')"));
        assert!(message.contains(&format!("cannot find '{name}'")), "{message}");
    }
}
