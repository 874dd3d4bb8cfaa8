//! `--json`: what was rendered, with what and how fast, one object a picture and line, and one at the end of a batch.

use super::plan::Plan;
use gpu_trace::device::DeviceInfo;
use gpu_trace::film::{check_writable, write_atomically};
use gpu_trace::flatten::FlattenCounts;
use gpu_trace::layout::{RAY_CAMERA, RAY_REFLECTED, RAY_REFRACTED, RAY_SHADOW};
use gpu_trace::renderer::{PrepareCounts, Tally};
use gpu_trace::script::LibraryCounts;
use gpu_trace::{Error, Result};
use serde::Serialize;
use std::fmt;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Grows when a field changes its meaning or goes; new fields leave it as it is.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
pub struct Report<'a> {
    pub schema: u32,
    pub scene: String,
    pub frame: u32,
    pub output: String,
    pub device: DeviceReport<'a>,
    pub width: u32,
    pub height: u32,
    /// Camera samples a pixel.
    pub samples: u32,
    pub max_depth: u32,
    pub seed: u32,
    pub transparent: bool,
    pub rays: Rays,
    /// Rendering, without `warmup_seconds`, which is compiling and uploading.
    pub seconds: f64,
    pub warmup_seconds: f64,
    pub mrays_per_second: f64,
    /// Passes that each camera sample was split into.
    pub passes: u32,
    pub longest_submit_seconds: f64,
}

impl Report<'_> {
    pub const SCHEMA: u32 = SCHEMA;
}

#[derive(Serialize)]
pub struct DeviceReport<'a> {
    pub name: &'a str,
    pub kind: &'a str,
    pub driver: &'a str,
}

impl<'a> From<&'a DeviceInfo> for DeviceReport<'a> {
    fn from(info: &'a DeviceInfo) -> Self {
        DeviceReport { name: &info.name, kind: info.kind, driver: &info.driver }
    }
}

#[derive(Serialize)]
pub struct Rays {
    pub camera: u64,
    pub shadow: u64,
    pub reflected: u64,
    pub refracted: u64,
    pub total: u64,
}

impl From<&Tally> for Rays {
    fn from(tally: &Tally) -> Self {
        let of = |kind: u32| tally.rays[kind as usize];
        Rays {
            camera: of(RAY_CAMERA),
            shadow: of(RAY_SHADOW),
            reflected: of(RAY_REFLECTED),
            refracted: of(RAY_REFRACTED),
            total: tally.total_rays(),
        }
    }
}

/// The last object of a batch, known by its field "batch".
#[derive(Serialize)]
pub struct BatchReport<'a> {
    schema: u32,
    batch: BatchFigures<'a>,
}

#[derive(Serialize)]
struct BatchFigures<'a> {
    frames_written: u32,
    /// Left out by --resume.
    frames_skipped: usize,
    failures: &'a [FailureReport],
    /// Wall-clock time of the whole batch.
    seconds: f64,
    /// Sums over the pictures.
    render_seconds: f64,
    warmup_seconds: f64,
    reuse: &'a Reuse,
}

#[derive(Serialize)]
pub struct FailureReport {
    pub frame: u32,
    pub error: String,
}

/// What frames had in common: how often it was made, and how often that was spared.
#[derive(Serialize)]
pub struct Reuse {
    files_read: u64,
    files_reused: u64,
    meshes_built: u64,
    meshes_reused: u64,
    images_packed: u64,
    images_reused: u64,
    pipelines_compiled: u64,
    pipelines_reused: u64,
    buffers_uploaded: u64,
    buffers_reused: u64,
}

impl<'a> BatchReport<'a> {
    /// `seconds` of the whole batch; the sums over the pictures are of rendering and of warming up.
    pub fn new(
        plan: &Plan,
        failures: &'a [FailureReport],
        frames_written: u32,
        seconds: f64,
        (render_seconds, warmup_seconds): (f64, f64),
        reuse: &'a Reuse,
    ) -> Self {
        let frames_skipped = plan.skipped;
        let batch =
            BatchFigures { frames_written, frames_skipped, failures, seconds, render_seconds, warmup_seconds, reuse };
        BatchReport { schema: SCHEMA, batch }
    }
}

impl Reuse {
    pub fn new(files: LibraryCounts, flattened: FlattenCounts, prepared: PrepareCounts) -> Self {
        let LibraryCounts { files_read, files_reused } = files;
        let FlattenCounts { meshes_built, meshes_reused, images_packed, images_reused } = flattened;
        let PrepareCounts { pipelines_compiled, pipelines_reused, buffers_uploaded, buffers_reused } = prepared;
        Reuse {
            files_read,
            files_reused,
            meshes_built,
            meshes_reused,
            images_packed,
            images_reused,
            pipelines_compiled,
            pipelines_reused,
            buffers_uploaded,
            buffers_reused,
        }
    }
}

impl fmt::Display for Reuse {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let parts = [
            ("files", self.files_read, self.files_reused),
            ("meshes", self.meshes_built, self.meshes_reused),
            ("images", self.images_packed, self.images_reused),
            ("kernels", self.pipelines_compiled, self.pipelines_reused),
            ("buffers", self.buffers_uploaded, self.buffers_reused),
        ];
        let parts = parts.map(|(what, made, reused)| format!("{what} {made} and {reused}"));
        write!(f, "made and reused: {}", parts.join(", "))
    }
}

const ACTION: &str = "write the report";

/// A file is written at most this often, since all of it is written each time.
const REWRITE: Duration = Duration::from_secs(1);

/// Where reports go.
pub struct ReportWriter {
    path: PathBuf,
    sink: Sink,
}

enum Sink {
    /// Standard output, a pipe, a device.
    Stream(Box<dyn Write + Send>),
    /// A file that is replaced as pictures come, so that it is whole at any time.
    File { lines: Vec<u8>, written: Option<Instant> },
}

impl ReportWriter {
    /// # Errors
    /// [`Error::File`] where nothing can be written there; a file is not made or changed yet.
    pub fn open(path: &Path) -> Result<Self> {
        let error = |source| Error::file(ACTION, path, source);
        let sink = if path == Path::new("-") {
            Sink::Stream(Box::new(io::stdout()))
        } else if path.metadata().is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            Sink::Stream(Box::new(File::options().write(true).open(path).map_err(error)?))
        } else {
            check_writable(ACTION, path)?;
            Sink::File { lines: Vec::new(), written: None }
        };
        Ok(ReportWriter { path: path.to_owned(), sink })
    }

    /// # Errors
    /// [`Error::File`].
    pub fn write(&mut self, report: &impl Serialize) -> Result<()> {
        let path = &self.path;
        let error = |source| Error::file(ACTION, path, source);
        let mut line = serde_json::to_vec(report).map_err(|source| error(source.into()))?;
        line.push(b'\n');
        match &mut self.sink {
            Sink::Stream(out) => out.write_all(&line).and_then(|()| out.flush()).map_err(error),
            Sink::File { lines, written } => {
                lines.extend_from_slice(&line);
                if written.is_some_and(|written| written.elapsed() < REWRITE) {
                    return Ok(());
                }
                *written = Some(Instant::now());
                write_atomically(ACTION, path, |out| out.write_all(lines))
            }
        }
    }

    /// Writes what is still to be written. A report without a line makes no file.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(self) -> Result<()> {
        match self.sink {
            Sink::File { lines, .. } if !lines.is_empty() => {
                write_atomically(ACTION, &self.path, |out| out.write_all(&lines))
            }
            _ => Ok(()),
        }
    }
}
