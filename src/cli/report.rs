//! `--json`: what was rendered, with what and how fast, one object a picture and line.

use super::scene_figures::SceneFigures;
use gpu_trace::device::DeviceInfo;
use gpu_trace::film::{check_writable, write_atomically};
use gpu_trace::layout::{RAY_CAMERA, RAY_REFLECTED, RAY_REFRACTED, RAY_SHADOW};
use gpu_trace::renderer::Tally;
use gpu_trace::{Error, Result};
use serde::Serialize;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

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
    #[serde(flatten)]
    pub figures: SceneFigures,
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

const ACTION: &str = "write the report";

/// Where reports go.
pub struct ReportWriter {
    path: PathBuf,
    sink: Sink,
}

enum Sink {
    /// Standard output, a pipe, a device.
    Stream(Box<dyn Write>),
    /// A file that is replaced with each picture, so that it is whole at any time.
    File { lines: Vec<u8> },
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
            Sink::File { lines: Vec::new() }
        };
        Ok(ReportWriter { path: path.to_owned(), sink })
    }

    /// # Errors
    /// [`Error::File`].
    pub fn write(&mut self, report: &Report) -> Result<()> {
        let path = &self.path;
        let error = |source| Error::file(ACTION, path, source);
        let mut line = serde_json::to_vec(report).map_err(|source| error(source.into()))?;
        line.push(b'\n');
        match &mut self.sink {
            Sink::Stream(out) => out.write_all(&line).and_then(|()| out.flush()).map_err(error),
            Sink::File { lines } => {
                lines.extend_from_slice(&line);
                write_atomically(ACTION, path, |out| out.write_all(lines))
            }
        }
    }
}
