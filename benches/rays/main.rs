//! Rays of incoherent diffuse paths through one mesh of 264,320 triangles: the rate of traversal alone, beside Embree's
//! over the same rays where it is installed (Debian: libembree-dev, g++).
//!
//! `cargo bench --bench rays`: each in turn, after a run that is left out; medians.

mod embree;
mod mesh;

use clap::Parser;
use embree::Embree;
use glam::{UVec2, Vec3};
use gpu_trace::blocks::BlockOrder;
use gpu_trace::cpu::bindings::Bindings;
use gpu_trace::cpu::geometry::bvh::scene_intersect;
use gpu_trace::cpu::geometry::triangle::triangle_geometric_normal;
use gpu_trace::cpu::ray::T_INFINITY;
use gpu_trace::flatten::{SceneBuffers, flatten};
use gpu_trace::gpu::probe::loop_cap;
use gpu_trace::gpu::{Device, DeviceSelector, GpuOptions, GpuRenderer};
use gpu_trace::layout::Dispatch;
use gpu_trace::renderer::{Renderer, Tally};
use gpu_trace::shader::{Part, Program};
use rayon::prelude::*;
use std::f32::consts::TAU;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

type Result<T, E = Box<dyn std::error::Error>> = std::result::Result<T, E>;

/// Edge of the square picture that the paths begin in, pixels.
const EDGE: u32 = 512;
const SAMPLES: u32 = 4;
const BOUNCES: u32 = 3;
/// As in rays.wgsl: blocks of a workgroup.
const BLOCKS: u32 = 4;
/// Parts that the picture is submitted in, so that none is long.
const SUBMITS: u32 = 4;

/// Trace incoherent rays through a mesh: lavapipe or the GPU, the CPU renderer, and Embree where it is installed
#[derive(Debug, Parser)]
struct Arguments {
    /// Rounds; the median is given
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,

    /// What cargo bench passes on.
    #[arg(long, hide = true)]
    bench: bool,
}

/// Rays traced, and the seconds that they took.
#[derive(Clone, Copy)]
pub struct Traced {
    pub rays: u64,
    pub seconds: f64,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rays: error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<()> {
    let (scene, mesh) = mesh::scene(EDGE)?;
    let embree = Embree::prepare(&mesh)?;
    let buffers = Arc::new(flatten(&scene)?);
    println!(
        "{} triangles, hierarchy built in {:.3} s, {:.1} MiB",
        buffers.triangles.len(),
        buffers.statistics.mesh_seconds,
        buffers.statistics.buffer_bytes as f64 / 1048576.0
    );
    let mut gpu = Gpu::new(buffers.clone())?;
    let mut rows: Vec<(String, Vec<Traced>)> =
        vec![(gpu.name.clone(), Vec::new()), ("CPU renderer".into(), Vec::new())];
    if embree.is_some() {
        rows.push(("Embree".into(), Vec::new()));
    }
    for round in 0..=arguments.rounds {
        let mut traced = vec![gpu.trace()?, trace_cpu(&buffers)];
        if let Some(embree) = &embree {
            traced.push(embree.trace()?);
        }
        // The first round is the warm-up.
        if round > 0 {
            rows.iter_mut().zip(traced).for_each(|((_, runs), traced)| runs.push(traced));
        }
    }
    let rates: Vec<f64> = rows.iter().map(|(_, runs)| median(runs)).collect();
    println!("| | rays | Mray/s | share of Embree's |\n|---|--:|--:|--:|");
    for ((name, runs), rate) in rows.iter().zip(&rates) {
        let share = if embree.is_some() { format!("{:.2}", rate / rates[2]) } else { "not installed".into() };
        println!("| {name} | {} | {rate:.2} | {share} |", runs[0].rays);
    }
    Ok(())
}

/// Millions of rays a second.
fn median(runs: &[Traced]) -> f64 {
    let mut rates: Vec<f64> = runs.iter().map(|run| run.rays as f64 / run.seconds / 1e6).collect();
    rates.sort_by(f64::total_cmp);
    let middle = rates.len() / 2;
    if rates.len() % 2 == 1 { rates[middle] } else { 0.5 * (rates[middle - 1] + rates[middle]) }
}

/// The kernel `walk` of rays.wgsl.
struct Gpu {
    name: String,
    renderer: GpuRenderer,
    buffers: Arc<SceneBuffers>,
    takes_work: bool,
}

impl Gpu {
    fn new(buffers: Arc<SceneBuffers>) -> Result<Self> {
        let walk = Part { path: "benches/rays/rays.wgsl", text: include_str!("rays.wgsl") };
        let device = Device::open(&DeviceSelector::Any)?;
        let program = Program::renderer(device.memory_access(), &[walk])?;
        let name = format!("{} ({})", device.description().name, device.description().driver);
        // The kernel doesn't notice loops that are cut short, as `render` does.
        let cuts_loops = loop_cap(&device)?.turns().is_some();
        let mut renderer = GpuRenderer::with_program(device, GpuOptions { checked: false }, program, "walk");
        renderer.prepare(buffers.clone())?;
        renderer.begin_band(0..EDGE)?;
        let takes_work = renderer.takes_work() && !cuts_loops;
        Ok(Gpu { name, renderer, buffers, takes_work })
    }

    fn trace(&mut self) -> Result<Traced> {
        let order = BlockOrder::new(EDGE, EDGE);
        let block_count = order.places() / BLOCKS / SUBMITS;
        let start = Instant::now();
        let mut rays = 0;
        for part in 0..SUBMITS {
            let dispatch = Dispatch {
                band_rows: EDGE,
                first_block: part * block_count,
                block_count,
                tile_stride: order.stride(),
                portions: self.renderer.portions(),
                takes_work: u32::from(self.takes_work),
                ..Dispatch::default()
            };
            let tally = self.renderer.submit(&self.buffers.frame, &[dispatch])?;
            if tally.flags != 0 {
                return Err(format!("the kernel reports {:#x}", tally.flags).into());
            }
            rays += tally.total_rays();
        }
        Ok(Traced { rays, seconds: start.elapsed().as_secs_f64() })
    }
}

fn trace_cpu(buffers: &SceneBuffers) -> Traced {
    let scene = Bindings::new(buffers, &buffers.frame);
    let start = Instant::now();
    let rays = (0..EDGE).into_par_iter().map(|y| (0..EDGE).map(|x| walk(&scene, UVec2::new(x, y))).sum::<u64>()).sum();
    Traced { rays, seconds: start.elapsed().as_secs_f64() }
}

fn pcg(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

fn uniform(state: &mut u32) -> f32 {
    *state = pcg(*state);
    (*state >> 8) as f32 / 16_777_216.0
}

/// The paths of one pixel; returns their rays.
fn walk(scene: &Bindings, pixel: UVec2) -> u64 {
    let mut state = pcg(pixel.x + pixel.y * EDGE);
    let mut tally = Tally::default();
    let mut rays = 0;
    for _ in 0..SAMPLES {
        let x = (pixel.x as f32 + uniform(&mut state)) / EDGE as f32 * 2.0 - 1.0;
        let y = 1.0 - (pixel.y as f32 + uniform(&mut state)) / EDGE as f32 * 2.0;
        let mut origin = Vec3::new(0.0, 1.2, 3.2);
        let mut direction = Vec3::new(0.8 * x, 0.8 * y - 0.35, -1.0).normalize();
        for _ in 0..=BOUNCES {
            rays += 1;
            let hit = scene_intersect(scene, origin, direction, T_INFINITY, &mut tally);
            if hit.t < 0.0 {
                break;
            }
            let triangle = &scene.triangles[hit.primitive as usize];
            let mut normal = triangle_geometric_normal(triangle.p0, triangle.p1, triangle.p2);
            if normal.dot(direction) > 0.0 {
                normal = -normal;
            }
            origin += hit.t * direction + 1e-3 * normal;
            let phi = TAU * uniform(&mut state);
            let z = 2.0 * uniform(&mut state) - 1.0;
            let sine = (1.0 - z * z).max(0.0).sqrt();
            direction = (normal + 0.999 * Vec3::new(sine * phi.cos(), sine * phi.sin(), z)).normalize();
        }
    }
    rays
}
