//! The program as users meet it: arguments, exit codes, messages, and the files it leaves.

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A red ball of 24x16 pixels with 4 camera samples, under `name`.
fn render_call(name: &str) -> String {
    format!(
        "gr.render(ball, '{name}', 24, 16, {{0, 0, 4}}, {{0, 0, 0}}, {{0, 1, 0}}, 40, {{0.2, 0.2, 0.2}}, \
         {{gr.light({{3, 4, 5}}, {{1, 1, 1}}, {{1, 0, 0}})}}, 2, 1, 1, 1, 0)\n"
    )
}

const BALL: &str = "local ball = gr.sphere('ball')\n\
                    ball:set_material(gr.material({0.9, 0.1, 0.1}, {0.5, 0.5, 0.5}, 20))\n";

/// A folder with `scene.lua`, which renders `picture.png`, and `bad.lua`, which fails in line 2.
fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).expect("a writable folder");
    write("scene.lua", format!("{BALL}{}", render_call("picture.png")));
    write("two.lua", format!("{BALL}{}{}", render_call("one.png"), render_call("sub/two.png")));
    write("bad.lua", "local x = 1\ngr.sphre('ball')\n".to_owned());
    write("none.lua", BALL.to_owned());
    folder
}

fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gpu-trace"));
    command.current_dir(folder).env_remove("RUST_LOG");
    command
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("an ASCII name"))
        .filter(|name| !name.ends_with(".lua"))
        .collect();
    names.sort();
    names
}

/// Runs a line that must fail with this code and message, without a panic and without leaving a file.
fn fails(line: &str, code: i32, message: &str) {
    let folder = folder();
    program(folder.path())
        .args(line.split_whitespace())
        .assert()
        .code(code)
        .stdout("")
        .stderr(contains("gpu-trace: error: ").and(contains(message)).and(contains("panicked").not()));
    assert_eq!(files(folder.path()), [""; 0], "{line}");
}

#[test]
fn help_is_grouped_and_has_examples() {
    let folder = folder();
    let help = program(folder.path()).arg("--help").assert().success().stderr("");
    let text = String::from_utf8_lossy(&help.get_output().stdout).into_owned();
    for part in ["Examples:", "gpu-trace doctor", "Picture:", "Sampling:", "Device:", "exit code", "./doctor"] {
        assert!(text.contains(part), "no '{part}' in\n{text}");
    }
    program(folder.path()).assert().code(2).stdout("").stderr(contains("Usage:"));
    program(folder.path()).arg("--version").assert().success().stdout(contains(env!("CARGO_PKG_VERSION")));
    program(folder.path()).args(["compare", "--help"]).assert().success().stdout(contains("--fail-above"));
}

#[test]
fn wrong_arguments_are_usage_errors() {
    for (line, message) in [
        ("scene.lua --nonsense", "--nonsense"),
        ("scene.lua minus", "minus"),
        ("scene.lua 1.5", "1.5"),
        ("scene.lua -3", "-3"),
        ("scene.lua 99999999999", "99999999999"),
        ("scene.lua 1 2", "'2'"),
        ("scene.lua --size 640", "such as 640x480"),
        ("scene.lua --size 640x", "such as 640x480"),
        ("scene.lua --size 0x480", "no pixels"),
        ("scene.lua --size=-1x480", "such as 640x480"),
        ("scene.lua --size 4294967295x4294967295", "more than"),
        ("scene.lua --samples 0", "--samples"),
        ("scene.lua --samples many", "many"),
        ("scene.lua --seed -1", "--seed"),
        ("scene.lua --max-depth 100000", "--max-depth"),
        ("scene.lua --conventions view=sideways", "sideways"),
        ("scene.lua --conventions nothing", "nothing"),
        ("scene.lua --device=", "part of a device's name"),
        ("scene.lua -o picture.gif", ".png"),
        ("scene.lua -o picture", ".png"),
        ("scene.lua -q -v", "--quiet"),
        ("compare one.png", "B.png"),
        ("compare one.png two.png --mask beta", "beta"),
        ("compare one.png two.png --fail-above -1", "--fail-above"),
        ("compare one.png two.png --fail-above nan", "nan"),
    ] {
        fails(line, 2, message);
    }
}

#[test]
fn failures_say_what_failed() {
    for (line, message) in [
        ("missing.lua", "missing.lua"),
        ("bad.lua", "bad.lua:2"),
        ("bad.lua", "sphere"),
        ("none.lua --device cpu", "gr.render"),
        ("scene.lua --device no-such-device", "no-such-device"),
        ("-q doctor", "must come first"),
        ("compare missing.png other.png", "missing.png"),
        ("compare scene.lua scene.lua", "scene.lua"),
        // A file stands where a folder is needed; so it does for a report.
        ("scene.lua --device cpu -o scene.lua/picture.png", "cannot write the picture"),
        ("scene.lua --device cpu --json scene.lua/report.json", "cannot write the report"),
        ("scene.lua --device cpu --json .", "cannot write the report"),
    ] {
        fails(line, 1, message);
    }
}

/// A large picture would take long: that the output cannot be written has to be found before.
#[test]
fn an_unwritable_output_is_found_before_rendering() {
    let folder = folder();
    fs::write(folder.path().join("blocked.lua"), format!("{BALL}{}", render_call("scene.lua/picture.png")))
        .expect("a writable folder");
    for arguments in [["scene.lua", "-o", "scene.lua/a.png"].as_slice(), &["blocked.lua"]] {
        program(folder.path())
            .args(arguments)
            .args(["--device", "cpu", "--size", "8000x8000", "--samples", "10000"])
            .timeout(std::time::Duration::from_secs(20))
            .assert()
            .code(1)
            .stderr(contains("cannot write the picture"));
    }
}

#[test]
fn the_cpu_renders_and_reports_json() {
    let folder = folder();
    let output = program(folder.path())
        .args(["scene.lua", "7", "--device", "cpu", "--json", "-", "--samples", "3", "--seed", "5"])
        .assert()
        .success()
        .stderr(contains("rendering on CPU").and(contains("picture.png")).and(contains("\r").not()))
        .get_output()
        .stdout
        .clone();
    let report: serde_json::Value = serde_json::from_slice(&output).expect("one JSON object");
    for (key, value) in [("schema", 1), ("frame", 7), ("width", 24), ("height", 16), ("samples", 3), ("seed", 5)] {
        assert_eq!(report[key], value, "{key}");
    }
    assert_eq!(report["scene"], "scene.lua");
    assert_eq!(report["output"], "picture.png");
    assert_eq!(report["device"]["kind"], "native CPU");
    assert_eq!(report["rays"]["camera"], 24 * 16 * 3);
    let kinds = ["camera", "shadow", "reflected", "refracted"];
    let sum: u64 = kinds.iter().map(|kind| report["rays"][kind].as_u64().expect("a count")).sum();
    assert_eq!(report["rays"]["total"], sum);
    for key in ["seconds", "warmup_seconds", "mrays_per_second"] {
        assert!(report[key].as_f64().is_some_and(|value| value >= 0.0), "{key} of {report}");
    }
    let picture = image::open(folder.path().join("picture.png")).expect("a picture");
    assert_eq!((picture.width(), picture.height(), picture.color()), (24, 16, image::ColorType::Rgb8));
    // The ball's middle is red, the background is not.
    let picture = picture.into_rgb8();
    let [middle, corner] = [picture.get_pixel(12, 8), picture.get_pixel(0, 0)];
    assert!(middle[0] > 2 * middle[2], "{middle:?}");
    assert!(corner[2] > corner[0], "{corner:?}");
    assert_eq!(files(folder.path()), ["picture.png"]);
}

#[test]
fn options_replace_what_the_scene_says() {
    let folder = folder();
    program(folder.path())
        .args(["scene.lua", "--device", "cpu", "-q", "--size", "10x20", "--transparent", "-o", "new/out.png"])
        .args(["--json", "report.json"])
        .assert()
        .success()
        .stdout("")
        .stderr("");
    assert_eq!(files(folder.path()), ["new", "report.json"]);
    let picture = image::open(folder.path().join("new/out.png")).expect("a picture").into_rgba8();
    assert_eq!(picture.dimensions(), (10, 20));
    assert_eq!(picture.get_pixel(0, 0)[3], 0, "the corner shows nothing");
    assert_eq!(picture.get_pixel(5, 10)[3], 255, "the middle shows the ball");
    let report = fs::read_to_string(folder.path().join("report.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_str(&report).expect("one JSON object");
    assert_eq!((&report["transparent"], &report["width"]), (&true.into(), &10.into()));
}

#[test]
fn every_picture_of_a_script_is_written_and_reported() {
    let folder = folder();
    program(folder.path()).args(["two.lua", "--device", "cpu", "-q", "--json", "two.json"]).assert().success();
    assert_eq!(files(folder.path()), ["one.png", "sub", "two.json"]);
    assert_eq!(files(&folder.path().join("sub")), ["two.png"]);
    let report = fs::read_to_string(folder.path().join("two.json")).expect("a report");
    let outputs: Vec<_> = report
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).expect("a JSON object a line")["output"].clone())
        .collect();
    assert_eq!(outputs, ["one.png", "sub/two.png"]);
}

#[test]
fn one_output_name_does_not_do_for_two_pictures() {
    let folder = folder();
    program(folder.path())
        .args(["two.lua", "--device", "cpu", "-o", "out.png"])
        .assert()
        .code(1)
        .stderr(contains("-o names one picture").and(contains("panicked").not()));
    assert_eq!(files(folder.path()), ["out.png"], "the first picture stays");
}

#[test]
fn a_scene_named_like_a_subcommand_is_reached_by_its_path() {
    let folder = folder();
    fs::copy(folder.path().join("scene.lua"), folder.path().join("doctor")).expect("a writable folder");
    program(folder.path()).args(["./doctor", "--device", "cpu"]).assert().success();
    assert_eq!(files(folder.path()), ["doctor", "picture.png"]);
}

/// Direct3D and Metal come with their systems, and cannot be taken away.
#[cfg(not(any(windows, target_os = "macos")))]
#[test]
fn without_vulkan_the_gpu_is_an_error_with_advice_and_auto_takes_the_cpu() {
    let folder = folder();
    let without = |line: &str| {
        let mut command = program(folder.path());
        command.args(line.split_whitespace());
        command.env("VK_DRIVER_FILES", "/nonexistent.json").env("VK_ICD_FILENAMES", "/nonexistent.json");
        command
    };
    without("scene.lua --device gpu").assert().code(1).stderr(contains("apt-get install mesa-vulkan-drivers"));
    assert_eq!(files(folder.path()), [""; 0]);
    without("scene.lua --device auto")
        .assert()
        .success()
        .stderr(contains("rendering on CPU").and(contains("no Vulkan")));
    without("doctor").assert().success().stdout(
        contains("apt-get install mesa-vulkan-drivers")
            .and(contains("Lambert's law holds"))
            .and(contains("FAILED").not()),
    );
}

#[test]
fn doctor_finds_that_every_device_computes_right() {
    let folder = folder();
    let output = program(folder.path()).arg("doctor").assert().success().stderr("");
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains("Every device computes right.") && !text.contains("FAILED"), "{text}");
    assert!(text.matches("known answer    ok").count() >= 2, "no Vulkan device; install one with tests/run:\n{text}");
}

#[test]
fn compare_prints_its_line_and_judges() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let mut picture = image::RgbImage::from_pixel(50, 20, image::Rgb([100, 120, 140]));
    picture.save(path("a.png")).expect("a writable folder");
    picture.put_pixel(3, 3, image::Rgb([100, 120, 143]));
    picture.save(path("b.png")).expect("a writable folder");
    image::RgbImage::new(5, 5).save(path("small.png")).expect("a writable folder");

    let compare = |line: &str| program(folder.path()).arg("compare").args(line.split_whitespace()).assert();
    compare("a.png a.png --fail-above 0")
        .success()
        .stdout("FLIP mean 0.0000  PSNR inf dB  0.00 % of pixels differ by more than 2/255\n")
        .stderr("");
    compare("a.png b.png").success().stdout(contains("0.10 % of pixels differ by more than 2/255\n"));
    compare("a.png b.png --fail-above 0.5").success();
    compare("a.png b.png --fail-above 0").code(1).stdout(contains("FLIP mean")).stderr(contains("is above 0"));
    compare("a.png small.png").code(1).stdout("").stderr(contains("50x20").and(contains("5x5")));
    compare("a.png b.png --mask alpha").code(1).stderr(contains("no alpha channel"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_rendering_and_leaves_nothing() {
    use std::io::{BufRead, BufReader};
    use std::process::Stdio;
    let folder = folder();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_gpu-trace"))
        .current_dir(folder.path())
        .args(["scene.lua", "--device", "cpu", "--size", "800x600", "--samples", "100000", "-o", "new/out.png"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program");
    let mut lines = BufReader::new(child.stderr.take().expect("a pipe")).lines().map_while(Result::ok);
    assert!(lines.next().is_some_and(|line| line.contains("rendering on CPU")));
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &pid]).status().is_ok_and(|status| status.success()));
    assert_eq!(child.wait().expect("a child").code(), Some(130));
    assert!(lines.next().is_some_and(|line| line.contains("interrupted; nothing was written")));
    assert_eq!(files(folder.path()), [""; 0]);
}
