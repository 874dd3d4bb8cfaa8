//! What a batch makes is what single runs make; frames that are there, that fail, or that get in each other's way.

use super::*;
use predicates::prelude::*;
use predicates::str::contains;

/// Renders frame by frame what a batch of `total` frames has as `single-N.png`.
fn render_singly(folder: &Path, frames: &[u32], total: u32, options: &str) {
    for frame in frames {
        let line = format!("scene.lua {frame} --total-frames {total} -o single-{frame}.png -q {options}");
        program(folder, &line).assert().success();
    }
}

#[test]
fn a_batch_equals_single_runs_byte_for_byte() {
    for options in ["", "--seed 9 --seed-per-frame --fps 30000/1001", "--transparent --samples 2"] {
        let folder = folder(&swing(""));
        let folder = folder.path();
        render_singly(folder, &[1, 3, 5, 7], 4, options);
        for jobs in [1, 3] {
            let line = format!("scene.lua --frames 1..7:2 -o batch-{jobs}/%d.png -q --jobs {jobs} {options}");
            program(folder, &line).assert().success().stdout("").stderr("");
            for frame in [1, 3, 5, 7] {
                let single = read(folder, &format!("single-{frame}.png"));
                assert_eq!(single, read(folder, &format!("batch-{jobs}/{frame}.png")), "{frame} {options}");
                // The comparison can tell frames apart.
                let other = read(folder, &format!("batch-{jobs}/{}.png", 8 - frame));
                assert_ne!(single, other, "{frame} {options}");
            }
        }
    }
}

#[test]
fn noise_is_the_same_in_all_frames_or_its_own_in_each() {
    let still = swing("").replace("gr.frame()", "1").replace("gr.time()", "1");
    for (option, same) in [("", true), ("--seed-per-frame", false)] {
        let folder = folder(&still);
        let line = format!("scene.lua --frames 4..5 -o %d.png -q {option}");
        program(folder.path(), &line).assert().success();
        assert_eq!(read(folder.path(), "4.png") == read(folder.path(), "5.png"), same, "{option}");
    }
}

#[test]
fn scripts_learn_frame_time_and_number_of_frames() {
    let check = r#"
        assert(gr.frame() == 6 and gr.frame_cmd() == 6)
        assert(math.abs(gr.time() - 0.5) < 1e-12)
        assert(gr.frames() == TOTAL)
    "#;
    for (line, total) in [
        ("scene.lua 6 --fps 12 -q", "1"),
        ("scene.lua 6 --fps 12 --total-frames 40 -q", "40"),
        ("scene.lua --frames 6..6 --fps 12 -o out.png -q", "1"),
        ("scene.lua --frames 6..6 --fps 12 --total-frames 7 -o out.png -q", "7"),
    ] {
        let folder = folder(&swing(&check.replace("TOTAL", total)));
        program(folder.path(), line).assert().success();
    }
}

#[test]
fn resuming_makes_the_missing_and_broken_frames_alone() {
    let folder = folder(&swing(""));
    let folder = folder.path();
    program(folder, "scene.lua --frames 1..4 -o whole-%d.png -q").assert().success();
    for frame in [1, 2] {
        fs::copy(folder.join(format!("whole-{frame}.png")), folder.join(format!("part-{frame}.png"))).expect("a copy");
    }
    // Whole, though of another picture: it is kept as it is.
    fs::copy(folder.join("whole-1.png"), folder.join("part-2.png")).expect("a copy");
    let cut = &read(folder, "whole-3.png")[..100];
    fs::write(folder.join("part-3.png"), cut).expect("a writable folder");
    program(folder, "scene.lua --frames 1..4 -o part-%d.png --resume --json report.json -q").assert().success();
    for (part, whole) in [(1, 1), (2, 1), (3, 3), (4, 4)] {
        let [part, whole] = [format!("part-{part}.png"), format!("whole-{whole}.png")];
        assert_eq!(read(folder, &part), read(folder, &whole), "{part}");
    }
    let report = batch_report(folder, "report.json");
    assert_eq!((&report["frames_written"], &report["frames_skipped"]), (&2.into(), &2.into()));
    program(folder, "scene.lua --frames 1..4 -o part-%d.png --resume")
        .assert()
        .success()
        .stderr(contains("4 were there"));
}

#[test]
fn a_frame_that_fails_is_reported_and_stops_the_rest_or_not() {
    let scene = swing("if gr.frame() == 3 then error('no third frame') end");
    let folder_without = folder(&scene);
    program(folder_without.path(), "scene.lua --frames 1..5 -o %d.png")
        .assert()
        .code(1)
        .stderr(contains("error: frame 3: scene.lua:13").and(contains("no third frame")));
    assert_eq!(files(folder_without.path()), ["1.png", "2.png"]);

    let folder_with = folder(&scene);
    program(folder_with.path(), "scene.lua --frames 1..5 -o %d.png --keep-going --json report.json")
        .assert()
        .code(1)
        .stderr(contains("error: frame 3: scene.lua:13").and(contains("frames that failed: 3")));
    assert_eq!(files(folder_with.path()), ["1.png", "2.png", "4.png", "5.png", "report.json"]);
    let report = batch_report(folder_with.path(), "report.json");
    assert_eq!(report["frames_written"], 4);
    assert_eq!(report["failures"][0]["frame"], 3);
    assert!(report["failures"][0]["error"].as_str().is_some_and(|error| error.contains("no third frame")), "{report}");

    // A file that can't be written fails its frame likewise, and so does a scene that can't be rendered.
    let folder_file = folder(&swing("if gr.frame() == 2 then ball:scale(1e30, 1, 1) end"));
    fs::create_dir(folder_file.path().join("3.png")).expect("a writable folder");
    program(folder_file.path(), "scene.lua --frames 1..4 -o %d.png --keep-going")
        .assert()
        .code(1)
        .stderr(contains("frames that failed: 2, 3").and(contains("error: frame 3: cannot write the picture")));
    assert_eq!(files(folder_file.path()), ["1.png", "3.png", "4.png"]);
}

#[test]
fn frames_go_where_the_script_says_but_not_over_each_other() {
    let named = swing("").replace("'frame.png'", "'frame-' .. gr.frame() .. '.png'");
    let two = named.clone() + "gr.render{scene=scene, output='again-' .. gr.frame() .. '.png', size={8, 8}}";
    let named_folder = folder(&two);
    program(named_folder.path(), "scene.lua --frames 1..2 -q").assert().success();
    assert_eq!(files(named_folder.path()), ["again-1.png", "again-2.png", "frame-1.png", "frame-2.png"]);

    let same_folder = folder(&swing(""));
    program(same_folder.path(), "scene.lua --frames 1..2")
        .assert()
        .code(1)
        .stderr(contains("frame 2: it would overwrite 'frame.png' of frame 1").and(contains("%04d")));
    for (output, message) in [("%d.png", "-o names one picture"), ("clip.gif", "a clip takes one picture a frame")] {
        let two_folder = folder(&two);
        program(two_folder.path(), &format!("scene.lua --frames 1..2 -o {output}"))
            .assert()
            .code(1)
            .stderr(contains(message));
        let clips = files(two_folder.path()).into_iter().filter(|name| !name.ends_with(".png")).count();
        assert_eq!(clips, 0, "a clip that failed is there");
    }
}

#[test]
fn arguments_that_do_not_go_together_are_usage_errors() {
    for (line, message) in [
        ("scene.lua 3 --frames 1..2", "--frames"),
        ("scene.lua --frames 2..1 -o %d.png", "before the first"),
        ("scene.lua --frames 1..2:0 -o %d.png", "at least 1"),
        ("scene.lua --frames -1..2 -o %d.png", "FIRST..LAST"),
        ("scene.lua --frames 0..4000000000 -o %d.png", "more frames"),
        ("scene.lua --frames 1..2 -o out.png", "%04d"),
        ("scene.lua --frames 1..2 -o %x.png", "%04d"),
        ("scene.lua --frames 1..2 -o %d%d.png", "one %d"),
        ("scene.lua --frames 1..2 -o %d.jpg", ".png"),
        ("scene.lua -o clip.gif", "--frames"),
        ("scene.lua --frames 1..2 -o clip.gif --resume", "whole or not there"),
        ("scene.lua --frames 1..2 -o clip.gif --keep-going", "whole or not there"),
        ("scene.lua --frames 1..2 --resume", "numbered frames"),
        ("scene.lua --resume", "--frames"),
        ("scene.lua --keep-going", "--frames"),
        ("scene.lua --jobs 2", "--frames"),
        ("scene.lua --frames 1..2 -o %d.png --jobs 0", "--jobs"),
        ("scene.lua --frames 1..2 -o - --json -", "standard output"),
        ("scene.lua --fps 0", "frames a second"),
        ("scene.lua --fps -3", "frames a second"),
        ("scene.lua --total-frames 0", "--total-frames"),
    ] {
        let folder = folder(&swing(""));
        program(folder.path(), line)
            .assert()
            .code(2)
            .stdout("")
            .stderr(contains("gpu-trace: error: ").and(contains(message)).and(contains("panicked").not()));
        assert_eq!(files(folder.path()), [""; 0], "{line}");
    }
}
