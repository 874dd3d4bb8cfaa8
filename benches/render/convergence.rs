//! How the error falls with the number of camera samples, and what time a given error takes.
//!
//! The error is the root of the mean square over pixels and channels of sRGB-encoded values in [0, 1], against a
//! reference of other random numbers. Independent samples are one-sample pictures of different seeds, averaged.

use crate::peers::{self, PeerPoint};
use crate::{Result, reference, scene};
use gpu_trace::device::{DeviceChoice, open_renderer};
use gpu_trace::film::{Film, encode};
use gpu_trace::flatten::flatten;
use gpu_trace::render::{RenderOptions, Unattended, render};
use gpu_trace::renderer::Renderer;
use gpu_trace::scene::{Scene, Transfer};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Camera samples, 2 to these powers.
const POWERS: std::ops::RangeInclusive<u32> = 0..=8;

/// What to measure.
pub struct Request {
    pub scenes: Vec<String>,
    pub devices: Vec<String>,
    pub with_peers: bool,
    /// Shadow rays a light at the first hit, in place of the scene's.
    pub shadow: Option<u32>,
    pub size: Option<[u32; 2]>,
    /// The errors whose times are asked for.
    pub errors: Vec<f64>,
}

/// A picture's error and the seconds that it took, after a warm-up.
#[derive(Clone, Copy, Serialize)]
pub struct Point {
    pub samples: u32,
    pub seconds: f64,
    pub rmse: f64,
}

/// What an error takes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TimeToError {
    pub rmse: f64,
    /// `None` where it is more than the samples measured.
    pub seconds: Option<f64>,
}

/// The error of a scene over the number of samples, of Sobol's points and of independent ones.
#[derive(Serialize)]
pub struct Curve {
    pub scene: String,
    pub device: String,
    pub driver: String,
    pub size: [u32; 2],
    /// Shadow rays a light at the first hit.
    pub shadow: u32,
    pub sobol: Vec<Point>,
    pub independent: Vec<Point>,
    /// POV-Ray on the scene's twin, where that was asked for.
    pub povray: Vec<PeerPoint>,
    /// With Sobol's points.
    pub times_to_rmse: Vec<TimeToError>,
}

/// Prints the errors of every scene on every device, and returns them.
pub fn report(request: &Request) -> Result<Vec<Curve>> {
    let mut curves = Vec::new();
    for name in &request.scenes {
        let mut scene = scene::load(name, request.size, None)?;
        scene.sampling.shadow = request.shadow.unwrap_or(scene.sampling.shadow);
        let mut renderers = Vec::new();
        for device in &request.devices {
            renderers.push(open_renderer(&device.parse::<DeviceChoice>()?, false)?);
        }
        let Some((first, _)) = renderers.first_mut() else { return Err("no device to measure".into()) };
        let reference = reference::film(name, &scene, first.as_mut())?;
        eprintln!("{name}: independent samples");
        let independent = independent(&scene, first.as_mut(), &reference)?;
        let peer = if request.with_peers { peers::convergence(name)? } else { Vec::new() };
        for (renderer, info) in &mut renderers {
            eprintln!("{name} on {}", info.name);
            let sobol = sobol(&scene, renderer.as_mut(), &reference, 0.0)?;
            let times_to_rmse = times_to(&request.errors, &sobol);
            let curve = Curve {
                scene: name.clone(),
                device: info.name.clone(),
                driver: info.driver.clone(),
                size: scene.size,
                shadow: scene.sampling.shadow,
                sobol,
                independent: independent.clone(),
                povray: peer.clone(),
                times_to_rmse,
            };
            curve.print();
            for point in &peer {
                print_ratio(point, &curve.sobol);
            }
            curves.push(curve);
        }
    }
    Ok(curves)
}

impl Curve {
    fn print(&self) {
        let Curve { scene, device, size: [width, height], shadow, sobol, independent, .. } = self;
        println!("\n{scene} {width}x{height} on {device}, {shadow} shadow rays a light at the first hit:\n");
        println!("| samples | s | RMSE | RMSE of independent samples |\n|--:|--:|--:|--:|");
        for (point, independent) in sobol.iter().zip(independent) {
            println!("| {} | {:.3} | {:.5} | {:.5} |", point.samples, point.seconds, point.rmse, independent.rmse);
        }
        println!("\nRMSE falls as N^{:.2}, of independent samples as N^{:.2}", slope(sobol), slope(independent));
        for TimeToError { rmse, seconds } in &self.times_to_rmse {
            match seconds {
                Some(seconds) => println!("RMSE {rmse}: {seconds:.3} s"),
                None => println!("RMSE {rmse}: not within {} samples", 1 << POWERS.end()),
            }
        }
    }
}

/// What each of the errors takes on a device, in one run after a warm-up, and the device's name.
pub fn times(name: &str, device: &str, size: Option<[u32; 2]>, errors: &[f64]) -> Result<(String, Vec<TimeToError>)> {
    let scene = scene::load(name, size, None)?;
    let (mut renderer, info) = open_renderer(&device.parse::<DeviceChoice>()?, false)?;
    let reference = reference::film(name, &scene, renderer.as_mut())?;
    eprintln!("{name} on {}: time to an error", info.name);
    let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let points = sobol(&scene, renderer.as_mut(), &reference, least)?;
    Ok((info.name, times_to(errors, &points)))
}

fn print_ratio(peer: &PeerPoint, points: &[Point]) {
    match seconds_to(peer.rmse, points) {
        Some(seconds) => println!(
            "RMSE {:.4}: POV-Ray +R{} {:.2} s, ours {seconds:.3} s: {:.1} times as fast",
            peer.rmse,
            peer.samples,
            peer.seconds,
            peer.seconds / seconds
        ),
        None => println!("RMSE {:.4}: not within the samples measured", peer.rmse),
    }
}

/// The first `samples` samples of a picture that has `of` of them.
fn first(scene: &Scene, renderer: &mut dyn Renderer, samples: u32, of: u32, seed: u32) -> Result<(Film, f64)> {
    let mut scene = scene.clone();
    scene.sampling.camera = of;
    scene.sampling.seed = seed;
    let buffers = Arc::new(flatten(&scene)?);
    let options = RenderOptions { samples: 0..samples, ..RenderOptions::whole(&buffers) };
    let rendered = render(buffers, renderer, &options, &mut Unattended)?;
    Ok((rendered.film, rendered.seconds))
}

/// The points up to the first whose error is at most `least`.
fn sobol(scene: &Scene, renderer: &mut dyn Renderer, reference: &Film, least: f64) -> Result<Vec<Point>> {
    first(scene, renderer, 1, 1, scene.sampling.seed)?;
    let mut points = Vec::new();
    for power in POWERS {
        let (film, seconds) = first(scene, renderer, 1 << power, 1 << power, scene.sampling.seed)?;
        let rmse = rmse(&film, reference);
        points.push(Point { samples: 1 << power, seconds, rmse });
        if rmse <= least {
            break;
        }
    }
    Ok(points)
}

fn independent(scene: &Scene, renderer: &mut dyn Renderer, reference: &Film) -> Result<Vec<Point>> {
    let mut points = Vec::new();
    let (mut sum, mut seconds) = (Film::new(reference.width, reference.height), 0.0);
    for power in POWERS {
        while sum.samples < 1 << power {
            // The only sample of a picture would be its pixels' centres.
            let (film, took) = first(scene, renderer, 1, 1 << POWERS.end(), 1_000_000 + sum.samples)?;
            sum.merge(&film)?;
            seconds += took;
        }
        points.push(Point { samples: 1 << power, seconds, rmse: rmse(&sum, reference) });
    }
    Ok(points)
}

fn rmse(film: &Film, reference: &Film) -> f64 {
    let encoded =
        |film: &Film, x, y| film.radiance(x, y).map(|linear| encode(Transfer::Srgb, f64::from(linear).clamp(0.0, 1.0)));
    let mut sum = 0.0;
    for y in 0..film.height {
        for x in 0..film.width {
            let (a, b) = (encoded(film, x, y), encoded(reference, x, y));
            sum += (0..3).map(|channel| (a[channel] - b[channel]).powi(2)).sum::<f64>();
        }
    }
    (sum / (3.0 * f64::from(film.width) * f64::from(film.height))).sqrt()
}

/// The exponent of the power of N that the error falls by, by least squares over the logarithms from two samples on: a
/// picture of one sample has its pixels' centres for it.
pub fn slope(points: &[Point]) -> f64 {
    let log = |point: &Point| (f64::from(point.samples).ln(), point.rmse.ln());
    let logs: Vec<(f64, f64)> = points.iter().filter(|point| point.samples > 1).map(log).collect();
    let count = logs.len() as f64;
    let (mean_x, mean_y) =
        (logs.iter().map(|p| p.0).sum::<f64>() / count, logs.iter().map(|p| p.1).sum::<f64>() / count);
    let covariance: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    covariance / logs.iter().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
}

fn times_to(errors: &[f64], points: &[Point]) -> Vec<TimeToError> {
    errors.iter().map(|&rmse| TimeToError { rmse, seconds: seconds_to(rmse, points) }).collect()
}

/// Seconds in which the error is reached, between two measured points by their logarithms.
fn seconds_to(rmse: f64, points: &[Point]) -> Option<f64> {
    if points.first()?.rmse <= rmse {
        return Some(points[0].seconds);
    }
    let pair = points.windows(2).find(|pair| pair[0].rmse > rmse && pair[1].rmse <= rmse)?;
    let share = (pair[0].rmse / rmse).ln() / (pair[0].rmse / pair[1].rmse).ln();
    Some(pair[0].seconds * (pair[1].seconds / pair[0].seconds).powf(share))
}
