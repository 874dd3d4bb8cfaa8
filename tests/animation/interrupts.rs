//! Ctrl-C in the middle of a batch, and worse.
#![cfg(unix)]

use super::*;
use std::io::{BufRead, BufReader, Lines};
use std::process::{Child, ChildStderr, Stdio};
use std::time::{Duration, Instant};

/// A run of the program whose messages are read line by line.
struct Run {
    child: Child,
    lines: Lines<BufReader<ChildStderr>>,
}

impl Run {
    fn start(folder: &Path, line: &str) -> Run {
        let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_gpu-trace"))
            .current_dir(folder)
            .env_remove("RUST_LOG")
            .args(line.split_whitespace())
            .args(["--device", "cpu"])
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program");
        let lines = BufReader::new(child.stderr.take().expect("a pipe")).lines();
        Run { child, lines }
    }

    fn wait_for(&mut self, text: &str) {
        let found = self.lines.by_ref().map_while(Result::ok).any(|line| line.contains(text));
        assert!(found, "no line with '{text}' before the end");
    }

    fn signal(&self, signal: &str) {
        let pid = self.child.id().to_string();
        let sent = std::process::Command::new("kill").args([signal, &pid]).status();
        assert!(sent.is_ok_and(|status| status.success()), "no signal was sent");
    }

    /// The exit code, and how long it took to come.
    fn end(&mut self) -> (Option<i32>, Duration) {
        let start = Instant::now();
        (self.child.wait().expect("a child").code(), start.elapsed())
    }
}

/// Frames that take the better part of a second each.
const SLOW: &str = "--size 160x120 --samples 200";
/// A frame that takes minutes.
const ENDLESS: &str = "--size 800x600 --samples 100000";

#[test]
fn one_interrupt_lets_the_frame_in_hand_be_finished() {
    let folder = folder(&swing(""));
    let mut run = Run::start(folder.path(), &format!("scene.lua --frames 1..50 -o %02d.png {SLOW}"));
    run.wait_for("wrote 01.png");
    run.signal("-INT");
    run.wait_for("run again with --resume");
    assert_eq!(run.end().0, Some(130));
    let written = files(folder.path());
    assert!((2..50).contains(&written.len()), "{written:?}");
    for name in &written {
        image::open(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn a_second_interrupt_ends_the_program_within_a_second_and_leaves_nothing() {
    for output in ["%d.png", "clip.gif", "clip.mp4"] {
        let folder = folder(&swing("").replace("samples=4", "samples = gr.frame() == 1 and 1 or 1000000"));
        // The first frame is quick, so that the clip is begun.
        let mut run = Run::start(folder.path(), &format!("scene.lua --frames 1..3 -o {output} --size 200x150"));
        run.wait_for("wrote");
        run.signal("-INT");
        run.signal("-INT");
        let (code, took) = run.end();
        assert_eq!(code, Some(130), "{output}");
        assert!(took < Duration::from_secs(1), "{output}: {took:?}");
        let expected = if output == "%d.png" { vec!["1.png"] } else { Vec::new() };
        assert_eq!(files(folder.path()), expected, "{output}");
    }
}

#[test]
fn an_interrupted_clip_is_not_there() {
    for output in ["clip.gif", "clip.apng", "clip.mp4"] {
        let folder = folder(&swing(""));
        let mut run = Run::start(folder.path(), &format!("scene.lua --frames 1..500 -o {output} {SLOW}"));
        run.wait_for("frame 1: wrote");
        run.signal("-INT");
        run.wait_for("interrupted; nothing was written");
        let (code, took) = run.end();
        assert_eq!(code, Some(130), "{output}");
        assert!(took < Duration::from_secs(1), "{output}: {took:?}");
        assert_eq!(files(folder.path()), [""; 0], "{output}");
    }
}

#[test]
fn an_interrupt_ends_a_script() {
    let folder = folder(&swing("if gr.frame() == 2 then while true do end end"));
    let mut run = Run::start(folder.path(), "scene.lua --frames 1..3 -o %d.png");
    run.wait_for("wrote 1.png");
    run.signal("-INT");
    let (code, took) = run.end();
    assert_eq!(code, Some(130));
    assert!(took < Duration::from_secs(1), "{took:?}");
    assert_eq!(files(folder.path()), ["1.png"]);
}

#[test]
fn a_killed_batch_is_resumed() {
    let folder = folder(&swing(""));
    let line = format!("scene.lua --frames 1..4 -o %d.png {SLOW}");
    let mut run = Run::start(folder.path(), &line);
    run.wait_for("wrote 1.png");
    run.signal("-KILL");
    run.end();
    let left = files(folder.path());
    assert!(left.contains(&"1.png".to_owned()) && !left.contains(&"4.png".to_owned()), "{left:?}");
    let modified =
        |name: &str| fs::metadata(folder.path().join(name)).and_then(|data| data.modified()).expect("a file");
    let before = modified("1.png");
    program(folder.path(), &format!("{line} --resume -q")).assert().success();
    assert_eq!(modified("1.png"), before, "a whole frame was made again");
    program(folder.path(), &format!("{line} -q").replace("%d", "whole-%d")).assert().success();
    for frame in 1..=4 {
        let [resumed, whole] = [format!("{frame}.png"), format!("whole-{frame}.png")];
        assert_eq!(read(folder.path(), &resumed), read(folder.path(), &whole), "frame {frame}");
    }
}

/// One picture is not finished first: there is nothing that it would complete.
#[test]
fn an_interrupt_ends_a_plain_run_at_once() {
    let folder = folder(&swing(""));
    let mut run = Run::start(folder.path(), &format!("scene.lua 1 {ENDLESS}"));
    run.wait_for("rendering on CPU");
    run.signal("-INT");
    let (code, took) = run.end();
    assert_eq!(code, Some(130));
    assert!(took < Duration::from_secs(1), "{took:?}");
    assert_eq!(files(folder.path()), [""; 0]);
}
