//! Scene scripts, run through the library: what they build, and how they fail.

mod errors;
mod files;
mod meshes;
mod pictures;
mod runaways;
mod sandbox;
mod surfaces;
mod tables;
mod transforms;

use gpu_trace::Error;
use gpu_trace::scene::{Node, Scene};
use gpu_trace::script::{ScriptOptions, ScriptSummary, load_scene, run_scene};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What makes a picture of the node `root`; the camera looks along -z.
const RENDER: &str = "gr.render(root, 'a.png', 8, 6, {0,0,5}, {0,0,0}, {0,1,0}, 50, {0.1,0.1,0.1}, {})";

/// A scene four folders below a temporary one, so that its grandparent is not everybody's.
struct Sandbox {
    root: TempDir,
    options: ScriptOptions,
}

impl Sandbox {
    fn new() -> Self {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir_all(root.path().join("a/b/c/d")).unwrap();
        Sandbox { root, options: ScriptOptions::default() }
    }

    fn folder(&self) -> PathBuf {
        self.root.path().join("a/b/c/d")
    }

    /// Writes a file, relative to the scene's folder.
    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.folder().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    fn scene(&self) -> PathBuf {
        self.folder().join("scene.lua")
    }

    fn load(&self, script: &str) -> Result<Vec<Scene>, Error> {
        self.write("scene.lua", script);
        load_scene(&self.scene(), &self.options)
    }

    fn run(&self, script: &str) -> Result<ScriptSummary, Error> {
        self.write("scene.lua", script);
        run_scene(&self.scene(), &self.options, &mut |_| Ok(()))
    }

    /// The message and calls of a script that fails, with `scene.lua` for the whole path.
    fn failure(&self, script: &str) -> (String, Vec<String>) {
        match self.run(script) {
            Err(Error::Script { message, calls }) => {
                (self.shorten(&message), calls.iter().map(|call| self.shorten(call)).collect())
            }
            Err(other) => panic!("not a script error: {other:?}"),
            Ok(_) => panic!("the script went well"),
        }
    }

    fn shorten(&self, message: &str) -> String {
        message.replace(&format!("{}/", self.folder().display()), "")
    }
}

/// The only scene that a script renders.
fn only_scene(script: &str) -> Scene {
    let mut scenes = Sandbox::new().load(script).unwrap();
    assert_eq!(scenes.len(), 1);
    scenes.remove(0)
}

fn node<'a>(scene: &'a Scene, name: &str) -> &'a Node {
    scene.graph.nodes.iter().find(|node| node.name == name).unwrap()
}

/// Message of a script that fails.
fn message(script: &str) -> String {
    Sandbox::new().failure(script).0
}

/// A path below the working folder, given relative to it.
fn relative_to_working_folder(path: &Path) -> PathBuf {
    path.strip_prefix(std::env::current_dir().unwrap()).unwrap().to_owned()
}
