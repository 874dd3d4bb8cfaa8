//! One scene rendered once on one device, and the medians over several such runs.

use crate::convergence::TimeToError;
use crate::{Result, scene};
use gpu_trace::device::{DeviceChoice, open_renderer};
use gpu_trace::flatten::flatten;
use gpu_trace::layout::{RAY_CAMERA, RAY_REFLECTED, RAY_REFRACTED, RAY_SHADOW};
use gpu_trace::memory::peak_memory;
use gpu_trace::render::{RenderOptions, Rendered, Unattended, render};
use serde::{Deserialize, Serialize};
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

/// Figures of one run; times in seconds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measurement {
    pub scene: String,
    pub device: String,
    pub driver: String,
    pub width: u32,
    pub height: u32,
    pub samples: u32,
    pub camera_rays: u64,
    pub shadow_rays: u64,
    pub reflected_rays: u64,
    pub refracted_rays: u64,
    /// Tracing, after the warm-up.
    pub seconds: f64,
    /// Lua, with the reading of meshes and images.
    pub script_seconds: f64,
    /// From the scene to the buffers, building the hierarchies.
    pub flatten_seconds: f64,
    /// The share of that in which triangles were packed and the hierarchies over them built.
    pub mesh_seconds: f64,
    /// Compiling and the first dispatch, with whatever the driver's cache on disk held.
    pub first_dispatch_seconds: f64,
    pub longest_submit_seconds: f64,
    /// The most memory that the process had in use, bytes; 0 where the system does not say.
    pub peak_memory: u64,
    pub triangles: u64,
    /// As if each instance were a copy.
    pub unrolled_triangles: u64,
    pub instances: u64,
    /// For each error that was asked for.
    pub times_to_rmse: Vec<TimeToError>,
    /// What POV-Ray takes for the scene's twin, where that was measured.
    pub povray_seconds: Option<f64>,
}

impl Measurement {
    pub fn rays(&self) -> u64 {
        self.camera_rays + self.shadow_rays + self.reflected_rays + self.refracted_rays
    }

    pub fn mrays_per_second(&self) -> f64 {
        self.rays() as f64 / self.seconds / 1e6
    }

    /// One measurement for each scene and device, in the order of their first runs, each figure the median of its own.
    pub fn medians(measurements: Vec<Measurement>) -> Vec<Measurement> {
        let mut groups: Vec<Vec<Measurement>> = Vec::new();
        for measurement in measurements {
            let same = |group: &&mut Vec<Measurement>| {
                (&group[0].scene, &group[0].device) == (&measurement.scene, &measurement.device)
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.push(measurement),
                None => groups.push(vec![measurement]),
            }
        }
        groups.iter().map(|group| Self::median(group)).collect()
    }

    fn median(group: &[Measurement]) -> Measurement {
        let povray = group.iter().filter_map(|run| run.povray_seconds).collect();
        let of = |figure: fn(&Measurement) -> f64| median(group.iter().map(figure).collect());
        Measurement {
            seconds: of(|run| run.seconds),
            script_seconds: of(|run| run.script_seconds),
            flatten_seconds: of(|run| run.flatten_seconds),
            mesh_seconds: of(|run| run.mesh_seconds),
            first_dispatch_seconds: of(|run| run.first_dispatch_seconds),
            longest_submit_seconds: group.iter().map(|run| run.longest_submit_seconds).fold(0.0, f64::max),
            peak_memory: of(|run| run.peak_memory as f64) as u64,
            povray_seconds: group.iter().any(|run| run.povray_seconds.is_some()).then(|| median(povray)),
            ..group[0].clone()
        }
    }
}

/// The middle value, or the mean of the two in the middle; NaN for none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        count if count % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

/// Renders the scene once with one sample to warm up, and then whole.
pub fn measure(name: &str, device: &str, size: Option<[u32; 2]>, samples: Option<u32>) -> Result<Measurement> {
    let start = Instant::now();
    let scene = scene::load(name, size, samples)?;
    let script_seconds = start.elapsed().as_secs_f64();
    let buffers = Arc::new(flatten(&scene)?);
    let choice: DeviceChoice = device.parse()?;
    let (mut renderer, info) = open_renderer(&choice, false)?;
    let warm_up = RenderOptions { samples: 0..1, ..RenderOptions::whole(&buffers) };
    let warm_up = render(buffers.clone(), renderer.as_mut(), &warm_up, &mut Unattended)?;
    let options = RenderOptions::whole(&buffers);
    let Rendered { tally, seconds, longest_submit_seconds, .. } =
        render(buffers.clone(), renderer.as_mut(), &options, &mut Unattended)?;
    let rays = |kind: u32| tally.rays[kind as usize];
    Ok(Measurement {
        scene: name.to_owned(),
        device: info.name,
        driver: info.driver,
        width: scene.size[0],
        height: scene.size[1],
        samples: scene.sampling.camera,
        camera_rays: rays(RAY_CAMERA),
        shadow_rays: rays(RAY_SHADOW),
        reflected_rays: rays(RAY_REFLECTED),
        refracted_rays: rays(RAY_REFRACTED),
        seconds,
        script_seconds,
        flatten_seconds: buffers.statistics.seconds,
        mesh_seconds: buffers.statistics.mesh_seconds,
        first_dispatch_seconds: warm_up.warmup_seconds,
        longest_submit_seconds,
        peak_memory: peak_memory().unwrap_or(0),
        triangles: buffers.triangles.len() as u64,
        unrolled_triangles: buffers.statistics.instanced_triangles,
        instances: buffers.instances.len() as u64,
        times_to_rmse: Vec::new(),
        povray_seconds: None,
    })
}

/// [`measure`] in a process of its own.
pub fn in_own_process(name: &str, device: &str, size: Option<[u32; 2]>, samples: Option<u32>) -> Result<Measurement> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["--one", name, device]);
    if let Some([width, height]) = size {
        command.args(["--size", &format!("{width}x{height}")]);
    }
    if let Some(samples) = samples {
        command.args(["--samples", &samples.to_string()]);
    }
    let output = command.output()?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let message = text.trim().trim_start_matches(crate::ERROR_PREFIX);
        return Err(format!("{name} on {device}: {message}").into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}
