//! Animations in chunks, as farms render them: the job of Open Job Description, and the lines of farm/README.md.

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::OnceLock;
use tempfile::TempDir;

/// The release of PyPI's openjd-cli that farm/README.md names too.
const OPENJD_CLI: &str = "openjd-cli==0.8.0";
const README: &str = include_str!("../farm/README.md");
const LAST: u32 = 6;

/// Each frame differs from the others by all that a frame may depend on, so that a chunk can't pass for another.
const SCENE: &str = "local ball = gr.sphere('ball')\n\
    ball:set_material(gr.material{diffuse={0.8, gr.frame() / gr.frames(), 0.1}})\n\
    ball:translate(4 * gr.time(), 0, -6)\n\
    local sun = gr.light({4, 8, 6}, {0.8, 0.8, 0.8}, {1, 0, 0})\n\
    gr.render(ball, 'swing.png', 24, 16, {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40, {0.2, 0.2, 0.2}, {sun}, 2, 1, 1)\n";

/// The contents of the files in a folder, by name.
type Frames = BTreeMap<OsString, Vec<u8>>;

fn frames_in(folder: &Path) -> Frames {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let read = |entry: fs::DirEntry| (entry.file_name(), fs::read(entry.path()).expect("a readable frame"));
    entries.map(|entry| read(entry.expect("an entry"))).collect()
}

/// The names of the frames that only one has, or that differ in a byte.
fn differences(a: &Frames, b: &Frames) -> Vec<OsString> {
    let mut names: Vec<OsString> =
        a.keys().chain(b.keys()).filter(|name| a.get(*name) != b.get(*name)).cloned().collect();
    names.sort();
    names.dedup();
    names
}

/// A folder with a blank in its name, the scene in it, and the frames of one batch in `batch`.
fn folder_and_batch() -> (TempDir, Frames) {
    let folder = tempfile::Builder::new().prefix("a farm").tempdir().expect("a temporary folder");
    fs::write(folder.path().join("swing.lua"), SCENE).expect("a writable folder");
    Command::new(env!("CARGO_BIN_EXE_gpu-trace"))
        .current_dir(folder.path())
        .args(["swing.lua", "--frames", &format!("1..{LAST}"), "-o", "batch/frame-%04d.png", "--device", "cpu", "-q"])
        .assert()
        .success();
    let batch = frames_in(&folder.path().join("batch"));
    assert_eq!(batch.len(), LAST as usize);
    (folder, batch)
}

/// Runs one step of an installation; ends the test with what to do where it fails.
fn install(command: &mut process::Command, advice: &str) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; {advice}"));
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?} has failed; {advice}\n{said}");
}

/// `openjd` of the pinned release, installed into target/openjd-venv at the first call if it isn't there.
fn openjd() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let venv = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("openjd-venv");
        let python = venv.join("bin/python");
        let has_release = || {
            let found = process::Command::new(&python).args(["-m", "pip", "freeze"]).output();
            found.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).lines().any(|line| line == OPENJD_CLI))
        };
        if !has_release() {
            let advice = "this test needs Python 3.9 or newer with venv; on Debian: apt-get install python3-venv";
            install(process::Command::new("python3").args(["-m", "venv", "--clear"]).arg(&venv), advice);
            let advice = format!("by hand: {} -m pip install {OPENJD_CLI}", python.display());
            install(process::Command::new(&python).args(["-m", "pip", "install", "--quiet", OPENJD_CLI]), &advice);
        }
        venv.join("bin/openjd")
    })
}

/// The job's frames in chunks of at most `chunk`, and what openjd said.
fn run_job(folder: &Path, chunk: u32) -> (Frames, String) {
    let out = format!("job-{chunk}");
    let assert = Command::new(openjd())
        .current_dir(folder)
        .arg("run")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("farm/render.job.yaml"))
        .args(["-p", "Scene=swing.lua", "-p", &format!("LastFrame={LAST}"), "-p", &format!("ChunkSize={chunk}")])
        .args(["-p", &format!("OutputDir={out}"), "-p", "Device=cpu"])
        .args(["-p", concat!("GpuTrace=", env!("CARGO_BIN_EXE_gpu-trace"))])
        .assert()
        .success();
    let said = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    (frames_in(&folder.join(out)), said)
}

/// The shell script of a section of farm/README.md, less its line of settings, which the environment gives instead.
fn readme_script(heading: &str) -> String {
    let section = README.split_once(&format!("## {heading}\n")).expect("the section").1;
    let script = section.split_once("```sh\n").expect("a script").1.split_once("```").expect("its end").0;
    let (settings, rest): (Vec<&str>, Vec<&str>) = script.lines().partition(|line| line.starts_with("export SCENE="));
    assert_eq!(settings.len(), 1, "one line of settings in the script of {heading}");
    rest.join("\n")
}

/// Runs such a script with `gpu-trace` on the PATH, and its frames in `out`.
fn run_script(script: &str, folder: &Path, out: &str, chunk: u32, array_task: u32) {
    let programs = Path::new(env!("CARGO_BIN_EXE_gpu-trace")).parent().expect("the program's folder").to_owned();
    let others = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(programs).chain(std::env::split_paths(&others))).expect("a PATH");
    Command::new("sh")
        .current_dir(folder)
        .args(["-c", script])
        .envs([("SCENE", "swing.lua"), ("OUT", out), ("FIRST", "1"), ("DEVICE", "cpu")])
        .envs([("LAST", LAST), ("CHUNK", chunk), ("SLURM_ARRAY_TASK_ID", array_task)].map(|(k, v)| (k, v.to_string())))
        .env("PATH", path)
        .assert()
        .success();
}

#[test]
fn job_gives_the_frames_of_the_batch() {
    let (folder, batch) = folder_and_batch();
    for (chunk, tasks) in [(2, 3), (4, 2)] {
        let (frames, said) = run_job(folder.path(), chunk);
        assert_eq!(differences(&batch, &frames), [] as [OsString; 0], "chunks of {chunk}: {said}");
        assert!(said.contains(&format!("Chunks run: {tasks}\n")), "{said}");
    }
}

#[test]
fn xargs_gives_the_frames_of_the_batch() {
    let (folder, batch) = folder_and_batch();
    let script = readme_script("xargs");
    for chunk in [2, 4] {
        let out = format!("xargs-{chunk}");
        run_script(&script, folder.path(), &out, chunk, 0);
        assert_eq!(differences(&batch, &frames_in(&folder.path().join(out))), [] as [OsString; 0], "chunks of {chunk}");
    }
}

#[test]
fn slurm_array_gives_the_frames_of_the_batch() {
    let (folder, batch) = folder_and_batch();
    let script = readme_script("Slurm");
    for array_task in 0..2 {
        run_script(&script, folder.path(), "slurm", 4, array_task);
    }
    assert_eq!(differences(&batch, &frames_in(&folder.path().join("slurm"))), [] as [OsString; 0]);
}

/// The negative control: a chunk without the animation's total, a changed byte and a missing frame are all noticed.
#[test]
fn wrong_frames_are_noticed() {
    let (folder, batch) = folder_and_batch();
    let script = readme_script("xargs").replace("--total-frames $((LAST - FIRST + 1))", "");
    run_script(&script, folder.path(), "no-total", 2, 0);
    assert_eq!(differences(&batch, &frames_in(&folder.path().join("no-total"))).len(), LAST as usize);

    let mut changed = batch.clone();
    *changed.get_mut(&OsString::from("frame-0003.png")).and_then(|bytes| bytes.last_mut()).expect("a byte") ^= 1;
    assert_eq!(differences(&batch, &changed), ["frame-0003.png"]);
    changed.remove(&OsString::from("frame-0005.png"));
    assert_eq!(differences(&batch, &changed), ["frame-0003.png", "frame-0005.png"]);
}

#[test]
fn readme_names_the_release_under_test() {
    assert!(README.contains(&format!("pip install {OPENJD_CLI}\n")));
}
