//! Batches of frames, through the program and through the library.

mod batch;
mod clips;
mod interrupts;
mod reuse;

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Pictures of 32 x 24 pixels of a ball that moves with the time, and a mesh of a table that grows from frame to frame.
/// `__EXTRA__` stands where tests add to the scene, `__SIZE__` for the size.
const SWING: &str = r#"
gr.conventions{transforms="pre"}
local scene = gr.node('scene')
local red = gr.material({0.9, 0.1, 0.1}, {0.5, 0.5, 0.5}, 20)
local ball = gr.sphere('ball')
ball:set_material(red)
ball:translate(2 * gr.frame() / gr.frames() - 1, math.sin(gr.time() * 20) / 2, 0)
scene:add_child(ball)
local h = 0.2 * gr.frame()
local flag = gr.mesh('flag', {{-1, -1, 1}, {0, -1, 1}, {0, h - 1, 1}}, {{0, 1, 2}})
flag:set_material(gr.material({0.1, 0.6, 0.1}, {0, 0, 0}, 1))
scene:add_child(flag)
__EXTRA__
gr.render{scene=scene, output='frame.png', size={__SIZE__}, samples=4, shadow=2, ambient={0.3, 0.3, 0.3},
  camera={eye={0, 0, 6}, fov=40}, lights={gr.light({3, 4, 5}, {0.8, 0.8, 0.8}, {1, 0, 0})}}
"#;

fn swing(extra: &str) -> String {
    SWING.replace("__EXTRA__", extra).replace("__SIZE__", "32, 24")
}

/// A folder with this scene as `scene.lua`.
fn folder(scene: &str) -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    fs::write(folder.path().join("scene.lua"), scene).expect("a writable folder");
    folder
}

/// The program in this folder, on the CPU.
fn program(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gpu-trace"));
    command.current_dir(folder).env_remove("RUST_LOG").args(line.split_whitespace());
    if !line.contains("--device") {
        command.args(["--device", "cpu"]);
    }
    command
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("an ASCII name"))
        .filter(|name| name != "scene.lua")
        .collect();
    names.sort();
    names
}

fn read(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The last object of a report, which is about the whole batch.
fn batch_report(folder: &Path, name: &str) -> serde_json::Value {
    let text = String::from_utf8(read(folder, name)).expect("a report in UTF-8");
    let last = text.lines().last().expect("a line");
    serde_json::from_str::<serde_json::Value>(last).expect("one JSON object a line")["batch"].clone()
}
