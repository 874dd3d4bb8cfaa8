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
use measurement::Measurement;
use std::path::PathBuf;
use std::process::ExitCode;

/// Whatever goes wrong ends the benchmark with its message.
type Result<T, E = Box<dyn std::error::Error>> = std::result::Result<T, E>;

const EXAMPLES: &str = "\
Examples:
  benches/run                                  all scenes on software Vulkan or the GPU, and on the CPU
  benches/run --scenes primitives,glass --runs 7 --json bench.json
  benches/run --scenes primitives --peers      POV-Ray on the same scene, in turn with ours
  benches/run --convergence                    how fast the error of soft shadows and depth of field falls
  benches/run --convergence --scenes glass --size 160x120 --rmse 0.01    time to a given error
  benches/run --triangles                      rays through meshes of ten thousand to ten million triangles";

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
    #[arg(long)]
    convergence: bool,

    /// Errors (RMSE of sRGB-encoded values) whose times are asked for, with --convergence
    #[arg(long, value_delimiter = ',', default_values_t = [0.02, 0.01, 0.005])]
    rmse: Vec<f64>,

    /// Where the plot goes, with --convergence
    #[arg(long, value_name = "FILE.svg", default_value = "target/bench/convergence.svg")]
    plot: PathBuf,

    /// Measure rays through one mesh of 10 thousand, 100 thousand, 1, 2 and 10 million triangles
    #[arg(long, conflicts_with_all = ["convergence", "scenes", "peers"])]
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
            eprintln!("benches/run: error: {error}");
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
    if arguments.triangles {
        return triangles::report(&arguments.devices, arguments.runs);
    }
    if arguments.convergence {
        let scenes = match arguments.scenes.as_slice() {
            [] => ["convergence/soft-shadow", "convergence/depth-of-field"].map(str::to_owned).to_vec(),
            names => names.to_vec(),
        };
        return convergence::report(&convergence::Request {
            scenes,
            devices: arguments.devices.clone(),
            with_peers: arguments.peers,
            shadow: arguments.shadow,
            size: arguments.size,
            errors: arguments.rmse.clone(),
            plot: arguments.plot.clone(),
        });
    }
    let names = if arguments.scenes.is_empty() { scene::all()? } else { arguments.scenes.clone() };
    let mut measurements = Vec::new();
    for name in &names {
        for run in 0..arguments.runs {
            for device in &arguments.devices {
                eprintln!("{name} on {device}, run {} of {}", run + 1, arguments.runs);
                measurements.push(measurement::in_own_process(name, device, arguments.size, arguments.samples)?);
            }
        }
    }
    let medians = Measurement::medians(measurements);
    table::print(&medians);
    if arguments.peers {
        peers::report(&names, &medians, arguments.runs)?;
    }
    if let Some(path) = &arguments.json {
        let figures = serde_json::json!({ "circumstances": Circumstances::now(), "medians": medians });
        std::fs::write(path, serde_json::to_vec_pretty(&figures)?)
            .map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}
