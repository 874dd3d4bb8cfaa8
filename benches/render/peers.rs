//! POV-Ray on the same scenes, where it is installed: benches/peers has the twins.

use crate::Result;
use crate::measurement::Measurement;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

const WIDTH: u32 = 320;
const HEIGHT: u32 = 240;
/// Edges of the square of camera samples in a pixel.
const EDGES: [u32; 5] = [1, 2, 3, 4, 6];
const REFERENCE_EDGE: u32 = 12;

/// POV-Ray at one number of samples.
#[derive(Clone, Serialize)]
pub struct PeerPoint {
    /// Edge of the square of samples: +R.
    pub samples: u32,
    pub seconds: f64,
    pub rmse: f64,
}

fn twin(name: &str) -> Option<PathBuf> {
    let path = Path::new("benches/peers").join(name).with_extension("pov");
    path.exists().then_some(path)
}

/// Says before anything is measured what would keep POV-Ray from being compared.
pub fn check(names: &[String], size: Option<[u32; 2]>, samples: Option<u32>) -> Result<()> {
    if names.iter().all(|name| twin(name).is_none()) {
        return Err(format!("--peers: no twin of {} in benches/peers", names.join(", ")).into());
    }
    if size.is_some_and(|size| size != [WIDTH, HEIGHT]) {
        return Err(format!("--peers: the twins are rendered at {WIDTH}x{HEIGHT}").into());
    }
    if let Some(samples) = samples.filter(|samples| samples.isqrt().pow(2) != *samples) {
        return Err(format!("--peers: POV-Ray takes a square number of samples, not {samples}").into());
    }
    let version = Command::new("povray").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    version.map_err(not_run)?;
    Ok(())
}

fn not_run(error: std::io::Error) -> String {
    format!("povray can't be run ({error}): install the package povray")
}

/// Renders with `edge`² camera samples a pixel on two threads, and returns the seconds that the process took.
fn povray(scene: &Path, output: &Path, edge: u32) -> Result<f64> {
    let start = Instant::now();
    let status = Command::new("povray")
        .arg(format!("+I{}", scene.display()))
        .arg(format!("+O{}", output.display()))
        .args([&format!("+W{WIDTH}"), &format!("+H{HEIGHT}"), &format!("+R{edge}")])
        .args(["-D", "+A0.0", "+AM1", "+J1.0", "+WT2", "+FN16"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .map_err(not_run)?;
    if !status.success() {
        return Err(format!("povray failed on {}", scene.display()).into());
    }
    Ok(start.elapsed().as_secs_f64())
}

/// Seconds that POV-Ray takes for the twin of a scene at the samples of our own run of it; `None` where it has no twin.
pub fn seconds(ours: &Measurement) -> Result<Option<f64>> {
    let Some(scene) = twin(&ours.scene) else { return Ok(None) };
    if [ours.width, ours.height] != [WIDTH, HEIGHT] {
        return Err(format!("{}: the twin is rendered at {WIDTH}x{HEIGHT}", ours.scene).into());
    }
    std::fs::create_dir_all("target/bench")?;
    eprintln!("{} by POV-Ray", ours.scene);
    povray(&scene, Path::new("target/bench/povray.png"), ours.samples.isqrt()).map(Some)
}

/// Prints the ratios of time.
pub fn print(medians: &[Measurement]) {
    for run in medians {
        let Some(seconds) = run.povray_seconds else { continue };
        println!(
            "{}: POV-Ray +R{} {seconds:.2} s, {} {:.2} s: {:.2} times as fast at equal ray counts",
            run.scene,
            run.samples.isqrt(),
            run.device,
            run.seconds,
            seconds / run.seconds
        );
    }
}

/// POV-Ray's error against a converged picture of its own (12x12 samples, a light of 8x8), and its time, at each of
/// [`EDGES`]; nothing where the scene has no twin.
pub fn convergence(name: &str) -> Result<Vec<PeerPoint>> {
    let Some(scene) = twin(name) else { return Ok(Vec::new()) };
    std::fs::create_dir_all("target/bench")?;
    let converged = Path::new("target/bench/converged.pov");
    let text = std::fs::read_to_string(&scene)?;
    let finer = text.replace("<0,0,3>,4,4 jitter", "<0,0,3>,8,8 jitter");
    if finer == text {
        return Err(format!("{}: no light of 4x4 that could be made finer", scene.display()).into());
    }
    std::fs::write(converged, finer)?;
    let output = Path::new("target/bench/povray.png");
    eprintln!("{name} by POV-Ray: reference");
    povray(converged, output, REFERENCE_EDGE)?;
    let reference = image::open(output)?.into_rgb16();
    let mut points = Vec::new();
    for edge in EDGES {
        eprintln!("{name} by POV-Ray: +R{edge}");
        let seconds = povray(&scene, output, edge)?;
        let picture = image::open(output)?.into_rgb16();
        let differences = picture.iter().zip(reference.iter()).map(|(&a, &b)| (f64::from(a) - f64::from(b)) / 65535.0);
        let mean = differences.map(|difference| difference * difference).sum::<f64>() / picture.len() as f64;
        points.push(PeerPoint { samples: edge, seconds, rmse: mean.sqrt() });
    }
    Ok(points)
}
