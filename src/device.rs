//! Which renderer a picture is made with, and why that one.

use crate::Result;
use crate::cpu::CpuRenderer;
use crate::gpu::{Description, Device, DeviceKind, DeviceSelector, GpuOptions, GpuRenderer};
use crate::renderer::Renderer;
use std::convert::Infallible;
use std::fmt;
use std::str::FromStr;

/// What the user asked to render with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// A hardware GPU, else a software Vulkan device, else the native CPU renderer.
    #[default]
    Auto,
    /// The GPU renderer, on hardware or else on a software Vulkan device.
    Gpu,
    /// The native CPU renderer.
    Cpu,
    /// The GPU renderer on the best device whose name contains this, in either case.
    Named(String),
}

impl FromStr for DeviceChoice {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(match text.to_lowercase().as_str() {
            "auto" => DeviceChoice::Auto,
            "gpu" => DeviceChoice::Gpu,
            "cpu" => DeviceChoice::Cpu,
            _ => DeviceChoice::Named(text.to_owned()),
        })
    }
}

/// The device that was chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceInfo {
    /// The driver's name for it.
    pub name: String,
    /// "discrete GPU", "integrated GPU", "virtual GPU", "GPU" (not known which), "software Vulkan" or "native CPU".
    pub kind: &'static str,
    /// The driver with its version; for the native CPU renderer, the number of its threads.
    pub driver: String,
    /// Why this one: half a sentence.
    pub why: String,
}

impl DeviceInfo {
    /// A device of the GPU renderer.
    pub fn new(description: &Description, why: String) -> Self {
        let kind = match description.kind {
            DeviceKind::Discrete => "discrete GPU",
            DeviceKind::Integrated => "integrated GPU",
            DeviceKind::Virtual => "virtual GPU",
            DeviceKind::Unknown => "GPU",
            DeviceKind::Software => "software Vulkan",
        };
        let driver = [description.backend, &description.driver, &description.driver_version];
        DeviceInfo {
            name: description.name.clone(),
            kind,
            driver: driver.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" "),
            why,
        }
    }
}

impl fmt::Display for DeviceInfo {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} ({}, {})", self.name, self.kind, self.driver)
    }
}

/// Opens the device that was asked for. `checked` keeps bounds checks in the GPU's kernel; see [`GpuOptions`].
///
/// # Errors
/// [`Error::Device`](crate::Error::Device) where no such device can be opened; with [`DeviceChoice::Auto`] never.
pub fn open_renderer(choice: &DeviceChoice, checked: bool) -> Result<(Box<dyn Renderer>, DeviceInfo)> {
    let (selector, why) = match choice {
        DeviceChoice::Auto => {
            return open_gpu(&DeviceSelector::Any, checked, None)
                .or_else(|error| Ok(open_cpu(no_gpu(&error.to_string()))));
        }
        DeviceChoice::Cpu => return Ok(open_cpu("as asked for".to_owned())),
        DeviceChoice::Gpu => (DeviceSelector::Any, None),
        DeviceChoice::Named(name) => (DeviceSelector::Named(name.clone()), Some(format!("its name contains '{name}'"))),
    };
    open_gpu(&selector, checked, why)
}

fn open_gpu(selector: &DeviceSelector, checked: bool, why: Option<String>) -> Result<(Box<dyn Renderer>, DeviceInfo)> {
    let device = Device::open(selector)?;
    let description = device.description();
    let why = why.unwrap_or_else(|| match description.kind {
        DeviceKind::Software => "no hardware GPU was found".to_owned(),
        _ => "the best GPU found".to_owned(),
    });
    let info = DeviceInfo::new(description, why);
    Ok((Box::new(GpuRenderer::new(device, GpuOptions { checked })?), info))
}

/// The native CPU renderer, which needs no driver.
pub fn open_cpu(why: String) -> (Box<dyn Renderer>, DeviceInfo) {
    let threads = rayon::current_num_threads();
    let info = DeviceInfo {
        name: "CPU".to_owned(),
        kind: "native CPU",
        driver: format!("{threads} {}", if threads == 1 { "thread" } else { "threads" }),
        why,
    };
    (Box::new(CpuRenderer::new()), info)
}

/// The first part of a device error: what follows the semicolon is advice for those who insist on a GPU.
fn no_gpu(error: &str) -> String {
    error.split(';').next().unwrap_or(error).to_owned()
}
