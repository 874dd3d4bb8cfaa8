//! What a batch of frames costs beside single runs of the same frames, and beside rendering alone; see `--help`.
//!
//! In each round the single runs and the batch take turns, so that a slow minute of the machine meets both alike. The
//! first round warms up the driver's cache of compiled kernels and the system's of files, and is left out.

use clap::Parser;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

/// Whatever goes wrong ends the benchmark with its message.
type Result<T, E = Box<dyn std::error::Error>> = std::result::Result<T, E>;

/// Compare batches of frames of benches/batch.lua with single runs
#[derive(Debug, Parser)]
#[command(name = "cargo bench --bench batch --")]
struct Arguments {
    /// Frames of the animation
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,

    /// Rounds that count; medians are given
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,

    /// Devices as for gpu-trace, with commas between
    #[arg(long, value_delimiter = ',', default_values_t = ["gpu".to_owned(), "cpu".to_owned()])]
    devices: Vec<String>,

    /// Options for every run of gpu-trace, such as "--size 1920x1080 --samples 16"
    #[arg(long, default_value = "", allow_hyphen_values = true)]
    options: String,

    /// Given by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

/// One round, seconds.
struct Round {
    /// The single runs, one after another, from start to end of each process.
    singles: f64,
    /// What the single runs spent on rendering.
    singles_rendering: f64,
    /// The batch, from start to end of its process.
    batch: f64,
    /// What the batch spent on rendering.
    batch_rendering: f64,
}

fn main() -> ExitCode {
    match measure(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("benches/batch: {error}");
            ExitCode::FAILURE
        }
    }
}

fn measure(arguments: &Arguments) -> Result<()> {
    println!(
        "| device | batch / single runs | batch / rendering alone | batch / rendering in it | single runs | batch | rendering alone | in the batch |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for device in &arguments.devices {
        round(arguments, device)?;
        let rounds = (0..arguments.rounds).map(|_| round(arguments, device)).collect::<Result<Vec<_>>>()?;
        let median = |of: &dyn Fn(&Round) -> f64| {
            let mut values: Vec<f64> = rounds.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            let middle = values.len() / 2;
            if values.len() % 2 == 1 { values[middle] } else { (values[middle - 1] + values[middle]) / 2.0 }
        };
        println!(
            "| {device} | {:.3} | {:.3} | {:.3} | {:.2} s | {:.2} s | {:.2} s | {:.2} s |",
            median(&|round| round.batch / round.singles),
            median(&|round| round.batch / round.singles_rendering),
            median(&|round| round.batch / round.batch_rendering),
            median(&|round| round.singles),
            median(&|round| round.batch),
            median(&|round| round.singles_rendering),
            median(&|round| round.batch_rendering),
        );
    }
    Ok(())
}

fn round(arguments: &Arguments, device: &str) -> Result<Round> {
    let folder = tempfile::tempdir()?;
    let start = Instant::now();
    let mut singles_rendering = 0.0;
    for frame in 1..=arguments.frames {
        let output = folder.path().join(format!("single-{frame}.png"));
        let line = format!("{frame} --total-frames {}", arguments.frames);
        let reports = run(arguments, device, &line, &output)?;
        singles_rendering += seconds(&reports[0]["seconds"])?;
    }
    let singles = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let output = folder.path().join("batch-%d.png");
    let reports = run(arguments, device, &format!("--frames 1..{}", arguments.frames), &output)?;
    let batch = start.elapsed().as_secs_f64();
    for frame in 1..=arguments.frames {
        let read = |name: String| std::fs::read(folder.path().join(name));
        if read(format!("single-{frame}.png"))? != read(format!("batch-{frame}.png"))? {
            return Err(format!("frame {frame} of the batch is another picture than alone").into());
        }
    }
    let batch_rendering = reports.last().map_or(Ok(0.0), |last| seconds(&last["batch"]["render_seconds"]))?;
    Ok(Round { singles, singles_rendering, batch, batch_rendering })
}

/// Runs the program; returns the objects of its report.
fn run(arguments: &Arguments, device: &str, line: &str, output: &Path) -> Result<Vec<Value>> {
    let run = Command::new(env!("CARGO_BIN_EXE_gpu-trace"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("benches/batch.lua")
        .args(line.split_whitespace())
        .args(arguments.options.split_whitespace())
        .args(["--device", device, "-q", "--json", "-", "-o"])
        .arg(output)
        .stderr(Stdio::inherit())
        .output()?;
    if !run.status.success() {
        return Err(format!("gpu-trace has failed: {}", run.status).into());
    }
    let reports = String::from_utf8(run.stdout)?;
    Ok(reports.lines().map(serde_json::from_str).collect::<Result<_, _>>()?)
}

fn seconds(value: &Value) -> Result<f64> {
    value.as_f64().ok_or_else(|| "a report without seconds".into())
}
