//! What a scene took to build, in numbers: for `-v` and `--json`.

use gpu_trace::flatten::Statistics;
use gpu_trace::memory::peak_memory;
use serde::Serialize;
use std::fmt;

#[derive(Serialize)]
pub struct SceneFigures {
    /// From the script's start, or the picture before, to its call of gr.render.
    script_seconds: f64,
    flatten_seconds: f64,
    /// The share of `flatten_seconds` in which meshes were packed and their hierarchies built.
    mesh_seconds: f64,
    meshes: usize,
    /// Of the different meshes.
    triangles: usize,
    instances: usize,
    /// Of all instances, as if each were a copy.
    unrolled_triangles: u64,
    buffer_bytes: usize,
    /// Of the whole process so far; null where the system does not say.
    peak_memory_bytes: Option<u64>,
}

impl From<&Statistics> for SceneFigures {
    fn from(statistics: &Statistics) -> Self {
        SceneFigures {
            script_seconds: statistics.script_seconds,
            flatten_seconds: statistics.seconds,
            mesh_seconds: statistics.mesh_seconds,
            meshes: statistics.meshes,
            triangles: statistics.triangles,
            instances: statistics.instances,
            unrolled_triangles: statistics.instanced_triangles,
            buffer_bytes: statistics.buffer_bytes,
            peak_memory_bytes: peak_memory(),
        }
    }
}

impl fmt::Display for SceneFigures {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "scene: {} in {}, {}, {} triangles unrolled; script {:.2} s, flatten {:.2} s (meshes {:.2} s); {} of buffers",
            counted(self.triangles as u64, "triangle", "triangles"),
            counted(self.meshes as u64, "mesh", "meshes"),
            counted(self.instances as u64, "instance", "instances"),
            grouped(self.unrolled_triangles),
            self.script_seconds,
            self.flatten_seconds,
            self.mesh_seconds,
            mebibytes(self.buffer_bytes as u64),
        )?;
        match self.peak_memory_bytes {
            Some(bytes) => write!(f, ", {} of memory at most", mebibytes(bytes)),
            None => Ok(()),
        }
    }
}

fn counted(count: u64, one: &str, many: &str) -> String {
    format!("{} {}", grouped(count), if count == 1 { one } else { many })
}

/// A number with commas between its thousands.
fn grouped(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", grouped(number / 1000), number % 1000),
    }
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}
