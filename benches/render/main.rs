//! The benchmark: fixed scenes on each device, in turn, as medians; see `--help`.
//!
//! Every figure comes from a process of its own that renders one scene once on one device, after a warm-up that is left
//! out, so that peak memory is that scene's and a slow minute of the machine meets all devices alike.

mod circumstances;
mod convergence;
mod measurement;
mod peers;
mod plot;
mod reference;
mod scene;
mod table;
mod triangles;

use circumstances::Circumstances;
use clap::Parser;
use gpu_trace::film::{check_writable, write_atomically};
use measurement::Measurement;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Whatever goes wrong ends the benchmark with its message.
type Result<T, E = Box<dyn std::error::Error>> = std::result::Result<T, E>;

const ERROR_PREFIX: &str = "benches/run: error: ";
/// Errors whose times are told with --convergence where none are asked for.
const ERRORS: [f64; 3] = [0.02, 0.01, 0.005];
const PLOT: &str = "target/bench/convergence.svg";

const EXAMPLES: &str = "\
Examples:
  benches/run                               all scenes on software Vulkan or the GPU, and on the CPU
  benches/run --scenes primitives,glass --runs 7 --json bench.json
  benches/run --size 160x90 --rmse 0.02     time to a given error too
  benches/run --scenes primitives --peers   POV-Ray on the same scene, in turn with ours
  benches/run --convergence                 how the error of soft shadows and lenses falls
  benches/run --triangles                   what a ray costs among more and more triangles
  benches/run --old-driver --scenes mesh    on the driver that tests/run --old-driver unpacks;
                                            this option stands first";

/// Measure how fast gpu-trace renders the scenes of scenes/bench
#[derive(Debug, Parser)]
#[command(name = "benches/run", after_help = EXAMPLES)]
struct Arguments {
    /// Names of scenes in scenes/bench, or waterfall, with commas between [default: all; with --convergence, those
    /// of scenes/bench/convergence]
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,

    /// Devices as for gpu-trace, with commas between
    #[arg(long, value_delimiter = ',', default_values_t = ["gpu".to_owned(), "cpu".to_owned()])]
    devices: Vec<String>,

    /// Runs of each scene on each device; the median is given
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,

    /// Width and height in place of the scene's, such as 1920x1080
    #[arg(long, value_parser = scene::parse_size)]
    size: Option<[u32; 2]>,

    /// Camera samples a pixel in place of the scene's
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,

    /// Compare with a reference of 4096 samples: the error at 1, 2, 4, … samples, its slope, the time to a given
    /// error, and a plot
    #[arg(long, conflicts_with_all = ["runs", "samples"])]
    convergence: bool,

    /// Errors whose times are told too, with commas between: RMSE of sRGB-encoded values in [0, 1] against a reference
    /// of 4096 samples, which takes minutes, or an hour for large pictures, and is kept in target/bench/references [default with --convergence:
    /// 0.02,0.01,0.005]
    #[arg(long, value_name = "E", value_delimiter = ',', value_parser = parse_error)]
    rmse: Vec<f64>,

    /// Where the plot goes, with --convergence [default: target/bench/convergence.svg]
    #[arg(long, value_name = "FILE.svg", requires = "convergence")]
    plot: Option<PathBuf>,

    /// Measure rays through one mesh of 10 thousand, 100 thousand, 1, 2 and 10 million triangles, as far as it fits
    /// the device
    #[arg(long, conflicts_with_all = ["convergence", "scenes", "peers", "rmse"])]
    triangles: bool,

    /// Shadow rays a light at the first hit in place of the scene's, with --convergence
    #[arg(long, requires = "convergence", value_parser = clap::value_parser!(u32).range(1..))]
    shadow: Option<u32>,

    /// Run POV-Ray too, where it is installed and the scene has a twin in benches/peers
    #[arg(long)]
    peers: bool,

    /// Write every figure as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Measure one scene on one device and print the figures as JSON: how the benchmark calls itself
    #[arg(long, num_args = 2, value_names = ["SCENE", "DEVICE"], hide = true)]
    one: Option<Vec<String>>,

    /// What cargo bench passes on.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{ERROR_PREFIX}{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<()> {
    if let Some([scene, device]) = arguments.one.as_deref() {
        let measurement = measurement::measure(scene, device, arguments.size, arguments.samples)?;
        println!("{}", serde_json::to_string(&measurement)?);
        return Ok(());
    }
    let names = match arguments.scenes.as_slice() {
        [] if arguments.convergence => scene::convergence()?,
        [] => scene::all()?,
        names => names.to_vec(),
    };
    check(arguments, &names)?;
    if arguments.triangles {
        let medians = triangles::report(&arguments.devices, arguments.runs, arguments.size, arguments.samples)?;
        return write_json(arguments, "medians", &medians);
    }
    if arguments.convergence {
        let curves = convergence::report(&convergence::Request {
            scenes: names,
            devices: arguments.devices.clone(),
            with_peers: arguments.peers,
            shadow: arguments.shadow,
            size: arguments.size,
            errors: if arguments.rmse.is_empty() { ERRORS.to_vec() } else { arguments.rmse.clone() },
        })?;
        let target = plot_file(arguments);
        plot::write(target, &curves)?;
        println!("\nplot: {}", target.display());
        return write_json(arguments, "curves", &curves);
    }
    let medians = measure(arguments, &names)?;
    table::print(&medians);
    peers::print(&medians);
    write_json(arguments, "medians", &medians)
}

/// Says what can be known to fail before minutes of measuring.
fn check(arguments: &Arguments, names: &[String]) -> Result<()> {
    names.iter().try_for_each(|name| scene::check(name))?;
    if let Some(path) = &arguments.json {
        check_writable("write the figures", path)?;
    }
    if arguments.convergence {
        check_writable("write the plot", plot_file(arguments))?;
    }
    if arguments.peers {
        peers::check(names, arguments.size, arguments.samples)?;
    }
    Ok(())
}

/// Medians of every scene on every device, with the times to the errors that were asked for.
fn measure(arguments: &Arguments, names: &[String]) -> Result<Vec<Measurement>> {
    let Arguments { devices, runs, size, samples, rmse, peers, .. } = arguments;
    let mut measurements = Vec::new();
    for name in names {
        for run in 0..*runs {
            let mut of_run = Vec::new();
            for device in devices {
                eprintln!("{name} on {device}, run {} of {runs}", run + 1);
                of_run.push(measurement::in_own_process(name, device, *size, *samples)?);
            }
            if let (true, Some(ours)) = (*peers, of_run.first()) {
                let seconds = peers::seconds(ours)?;
                of_run.iter_mut().for_each(|measurement| measurement.povray_seconds = seconds);
            }
            measurements.append(&mut of_run);
        }
    }
    let mut medians = Measurement::medians(measurements);
    if rmse.is_empty() {
        return Ok(medians);
    }
    for name in names {
        for device in devices {
            let (device, times) = convergence::times(name, device, *size, rmse)?;
            let of_both = |median: &&mut Measurement| median.scene == *name && median.device == device;
            if let Some(median) = medians.iter_mut().find(of_both) {
                median.times_to_rmse = times;
            }
        }
    }
    Ok(medians)
}

fn plot_file(arguments: &Arguments) -> &Path {
    arguments.plot.as_deref().unwrap_or(Path::new(PLOT))
}

fn write_json(arguments: &Arguments, key: &str, figures: &impl Serialize) -> Result<()> {
    let Some(path) = &arguments.json else { return Ok(()) };
    let all = serde_json::json!({ "circumstances": Circumstances::now(), key: figures });
    write_atomically("write the figures", path, |out| Ok(serde_json::to_writer_pretty(out, &all)?))?;
    Ok(())
}

fn parse_error(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(error) if error > 0.0 && error.is_finite() => Ok(error),
        _ => Err("expected a number above 0, such as 0.01".to_owned()),
    }
}
