//! How the error falls with the number of camera samples, and what time a given error takes.
//!
//! The error is the root of the mean square over pixels and channels of sRGB-encoded values in [0, 1], against a
//! reference of other random numbers. Independent samples are one-sample pictures of different seeds, averaged.

use crate::peers::{self, PeerPoint};
use crate::{Result, scene};
use gpu_trace::device::{DeviceChoice, open_renderer};
use gpu_trace::film::{Film, encode};
use gpu_trace::flatten::flatten;
use gpu_trace::render::{RenderOptions, Unattended, render};
use gpu_trace::renderer::Renderer;
use gpu_trace::scene::{Scene, Transfer};
use plotters::prelude::*;
use std::path::Path;
use std::sync::Arc;

const REFERENCE_SAMPLES: u32 = 4096;
/// Any number that is not the scenes' own seed.
const REFERENCE_SEED: u32 = 0x5eed;
/// Camera samples, 2 to these powers.
const POWERS: std::ops::RangeInclusive<u32> = 0..=8;

/// A picture's error and the seconds that it took, after a warm-up.
#[derive(Clone, Copy)]
pub struct Point {
    pub samples: u32,
    pub seconds: f64,
    pub rmse: f64,
}

pub fn report(names: &[String], devices: &[String], with_peers: bool, shadow: Option<u32>) -> Result<()> {
    let mut curves = Vec::new();
    for name in names {
        let mut scene = scene::load(name, None, None)?;
        scene.sampling.shadow = shadow.unwrap_or(scene.sampling.shadow);
        let mut renderers = Vec::new();
        for device in devices {
            renderers.push(open_renderer(&device.parse::<DeviceChoice>()?, false)?);
        }
        let Some((first, _)) = renderers.first_mut() else { return Err("no device to measure".into()) };
        eprintln!("{name}: reference");
        let reference = reference(&scene, first.as_mut())?;
        eprintln!("{name}: independent samples");
        let independent = independent(&scene, first.as_mut(), &reference)?;
        let peer = if with_peers { peers::povray_convergence(name)? } else { None };
        for (renderer, info) in &mut renderers {
            eprintln!("{name} on {}", info.name);
            let points = sobol(&scene, renderer.as_mut(), &reference)?;
            println!("\n{name} on {}, {} shadow rays a light at the first hit:\n", info.name, scene.sampling.shadow);
            println!("| samples | s | RMSE | RMSE of independent samples |\n|---|---|---|---|");
            for (point, independent) in points.iter().zip(&independent) {
                println!("| {} | {:.3} | {:.5} | {:.5} |", point.samples, point.seconds, point.rmse, independent.rmse);
            }
            println!("\nslope {:.2}, of independent samples {:.2}", slope(&points), slope(&independent));
            for point in peer.iter().flatten() {
                print_ratio(point, &points);
            }
            if curves.iter().all(|(curve, _, _): &(String, Vec<Point>, Vec<Point>)| curve != name) {
                curves.push((name.clone(), points, independent.clone()));
            }
        }
    }
    let target = Path::new("target/bench/convergence.svg");
    std::fs::create_dir_all("target/bench")?;
    plot(target, &curves)?;
    println!("\nplot: {}", target.display());
    Ok(())
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

fn reference(scene: &Scene, renderer: &mut dyn Renderer) -> Result<Film> {
    Ok(first(scene, renderer, REFERENCE_SAMPLES, REFERENCE_SAMPLES, REFERENCE_SEED)?.0)
}

fn sobol(scene: &Scene, renderer: &mut dyn Renderer, reference: &Film) -> Result<Vec<Point>> {
    first(scene, renderer, 1, 1, scene.sampling.seed)?;
    POWERS
        .map(|power| {
            let (film, seconds) = first(scene, renderer, 1 << power, 1 << power, scene.sampling.seed)?;
            Ok(Point { samples: 1 << power, seconds, rmse: rmse(&film, reference) })
        })
        .collect()
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

/// The exponent of the power of N that the error falls by, by least squares over the logarithms.
fn slope(points: &[Point]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|point| (f64::from(point.samples).ln(), point.rmse.ln())).collect();
    let count = logs.len() as f64;
    let (mean_x, mean_y) =
        (logs.iter().map(|p| p.0).sum::<f64>() / count, logs.iter().map(|p| p.1).sum::<f64>() / count);
    let covariance: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    covariance / logs.iter().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
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

/// Both axes logarithmic: solid with Sobol's points, thin with independent samples.
fn plot(path: &Path, curves: &[(String, Vec<Point>, Vec<Point>)]) -> Result<()> {
    let all = || curves.iter().flat_map(|(_, sobol, independent)| sobol.iter().chain(independent));
    let lowest = all().map(|point| point.rmse).fold(f64::INFINITY, f64::min);
    let highest = all().map(|point| point.rmse).fold(0.0, f64::max);
    let area = SVGBackend::new(path, (720, 480)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(16)
        .x_label_area_size(36)
        .y_label_area_size(64)
        .build_cartesian_2d((1f64..256.0).log_scale(), (lowest * 0.8..highest * 1.2).log_scale())?;
    chart.configure_mesh().x_desc("camera samples a pixel").y_desc("RMSE").draw()?;
    for (number, (name, sobol, independent)) in curves.iter().enumerate() {
        let colour = Palette99::pick(number).to_rgba();
        let line = |points: &[Point]| points.iter().map(|p| (f64::from(p.samples), p.rmse)).collect::<Vec<_>>();
        chart
            .draw_series(LineSeries::new(line(sobol), colour.stroke_width(3)))?
            .label(format!("{name}: Owen-scrambled Sobol, N^{:.2}", slope(sobol)))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], colour.stroke_width(3)));
        chart
            .draw_series(LineSeries::new(line(independent), colour.stroke_width(1)))?
            .label(format!("{name}: independent, N^{:.2}", slope(independent)))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], colour.stroke_width(1)));
    }
    chart.configure_series_labels().position(SeriesLabelPosition::LowerLeft).border_style(BLACK).draw()?;
    area.present()?;
    Ok(())
}
