//! Finding a device and opening it, and turning what goes wrong on it into errors.

use crate::shader::MemoryAccess;
use crate::{Error, Result};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What a device is made of, from the most to the least preferred.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DeviceKind {
    Discrete,
    Integrated,
    /// A GPU handed to a virtual machine.
    Virtual,
    Unknown,
    /// A driver that computes on the CPU, such as Mesa's lavapipe.
    Software,
}

impl fmt::Display for DeviceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            DeviceKind::Discrete => "discrete GPU",
            DeviceKind::Integrated => "integrated GPU",
            DeviceKind::Virtual => "virtual GPU",
            DeviceKind::Unknown => "GPU",
            DeviceKind::Software => "software",
        })
    }
}

/// What an adapter says about itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Description {
    /// The name that `--device SUBSTRING` is compared with.
    pub name: String,
    pub kind: DeviceKind,
    /// "Vulkan", "Metal" or "Direct3D 12".
    pub backend: &'static str,
    pub driver: String,
    /// The driver's version, in its own words.
    pub driver_version: String,
}

impl fmt::Display for Description {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}, {}", self.name, self.kind, self.backend)?;
        for text in [&self.driver, &self.driver_version] {
            if !text.is_empty() {
                write!(f, ", {text}")?;
            }
        }
        f.write_str(")")
    }
}

impl Description {
    fn of(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        Description {
            name: info.name,
            kind: match info.device_type {
                wgpu::DeviceType::DiscreteGpu => DeviceKind::Discrete,
                wgpu::DeviceType::IntegratedGpu => DeviceKind::Integrated,
                wgpu::DeviceType::VirtualGpu => DeviceKind::Virtual,
                wgpu::DeviceType::Cpu => DeviceKind::Software,
                wgpu::DeviceType::Other => DeviceKind::Unknown,
            },
            backend: match info.backend {
                wgpu::Backend::Vulkan => "Vulkan",
                wgpu::Backend::Metal => "Metal",
                wgpu::Backend::Dx12 => "Direct3D 12",
                other => other.to_str(),
            },
            driver: info.driver,
            driver_version: info.driver_info,
        }
    }
}

/// The limits that bound a scene or a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceLimits {
    /// Bytes that one storage buffer may show a shader; wgpu's `max_storage_buffer_binding_size`.
    pub storage_binding: u64,
    /// Bytes of one buffer; `max_buffer_size`.
    pub buffer: u64,
    /// Storage buffers of one kernel; `max_storage_buffers_per_shader_stage`. The kernel needs 8.
    pub storage_buffers: u32,
    /// Workgroups of one dispatch; `max_compute_workgroups_per_dimension`.
    pub workgroups: u32,
    /// Invocations of one workgroup; `max_compute_invocations_per_workgroup`. The kernel needs 64.
    pub workgroup_invocations: u32,
}

impl From<wgpu::Limits> for DeviceLimits {
    fn from(limits: wgpu::Limits) -> Self {
        DeviceLimits {
            storage_binding: limits.max_storage_buffer_binding_size,
            buffer: limits.max_buffer_size,
            storage_buffers: limits.max_storage_buffers_per_shader_stage,
            workgroups: limits.max_compute_workgroups_per_dimension,
            workgroup_invocations: limits.max_compute_invocations_per_workgroup,
        }
    }
}

/// Which device to open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DeviceSelector {
    /// The best there is: a discrete GPU, an integrated one, a virtual one, else a software device.
    Any,
    /// The best GPU, and no software device.
    Hardware,
    /// A software device, though there may be a GPU.
    Software,
    /// The best whose name contains this, in any case.
    Named(String),
}

impl DeviceSelector {
    fn accepts(&self, description: &Description) -> bool {
        match self {
            DeviceSelector::Any => true,
            DeviceSelector::Hardware => description.kind != DeviceKind::Software,
            DeviceSelector::Software => description.kind == DeviceKind::Software,
            DeviceSelector::Named(part) => description.name.to_lowercase().contains(&part.to_lowercase()),
        }
    }
}

/// All adapters with their limits, the best first; empty where there is no Vulkan, Metal or Direct3D 12.
pub fn list_adapters() -> Vec<(Description, DeviceLimits)> {
    adapters().iter().map(|(description, adapter)| (description.clone(), adapter.limits().into())).collect()
}

fn adapters() -> Vec<(Description, wgpu::Adapter)> {
    let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        flags: wgpu::InstanceFlags::from_build_config(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let found = pollster::block_on(instance.enumerate_adapters(backends));
    let mut adapters: Vec<_> = found.into_iter().map(|adapter| (Description::of(&adapter), adapter)).collect();
    // Stable: among equals the system's own order stays, Vulkan before Direct3D.
    adapters.sort_by_key(|(description, _)| description.kind);
    adapters
}

/// An open device. Clones share it.
#[derive(Clone, Debug)]
pub struct Device {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    description: Description,
    limits: DeviceLimits,
    memory_access: MemoryAccess,
    faults: Arc<Mutex<Faults>>,
}

impl Device {
    /// Opens the best device that the selector accepts.
    ///
    /// # Errors
    /// [`Error::Device`] where there is none; it says how to install one, or which there are.
    pub fn open(selector: &DeviceSelector) -> Result<Device> {
        Device::open_limited(selector, u64::MAX)
    }

    /// Opens a device as if no storage buffer of it could be larger than `storage_binding` bytes, for tests of what
    /// a smaller device would do.
    ///
    /// # Errors
    /// As for [`Device::open`].
    pub fn open_limited(selector: &DeviceSelector, storage_binding: u64) -> Result<Device> {
        let adapters = adapters();
        let mut refusal = None;
        for (description, adapter) in adapters.iter().filter(|(description, _)| selector.accepts(description)) {
            match open_adapter(description, adapter, storage_binding) {
                Ok(device) => return Ok(device),
                Err(error) => {
                    log::warn!("{error}");
                    refusal.get_or_insert(error);
                }
            }
        }
        Err(refusal.unwrap_or_else(|| no_device(selector, adapters.iter().map(|(description, _)| description))))
    }

    /// Opens every adapter, the best first, for `gpu-trace doctor`; those that cannot be opened say why.
    pub fn open_each() -> Vec<(Description, DeviceLimits, Result<Device>)> {
        let open = |(description, adapter): &(Description, wgpu::Adapter)| {
            let device = open_adapter(description, adapter, u64::MAX);
            (description.clone(), adapter.limits().into(), device)
        };
        adapters().iter().map(open).collect()
    }

    pub fn description(&self) -> &Description {
        &self.description
    }

    pub fn limits(&self) -> &DeviceLimits {
        &self.limits
    }

    /// How its kernels reach memory fastest.
    pub fn memory_access(&self) -> MemoryAccess {
        self.memory_access
    }

    /// Whether kernels that reach memory in this way run on it.
    pub fn supports(&self, access: MemoryAccess) -> bool {
        self.device.features().contains(features_for(access))
    }

    /// Gives the device's memory back now; whatever is tried on it or its clones afterwards is an error.
    pub fn close(&self) {
        self.device.destroy();
    }

    /// Reports what has gone wrong on the device since the last call, once; a lost device stays lost.
    pub(super) fn check(&self) -> Result<()> {
        let mut faults = lock(&self.faults);
        if let Some(message) = &faults.lost {
            return Err(Error::Device(message.clone()));
        }
        faults.first.take().map_or(Ok(()), Err)
    }

    /// Blocks until everything that was submitted has run and its callbacks were called.
    pub(super) fn wait(&self) -> Result<()> {
        // wgpu panics in `poll` where the driver reports a lost device or no memory; a renderer that has a picture
        // half done, or a CPU to fall back on, needs an error.
        let polled = catch_unwind(AssertUnwindSafe(|| self.device.poll(wgpu::PollType::wait_indefinitely())));
        self.check()?;
        match polled {
            Ok(Ok(_)) => Ok(()),
            Ok(Err(error)) => Err(self.error(&error.to_string())),
            Err(_) => Err(self.error("the device was lost or is out of memory")),
        }
    }

    pub(super) fn error(&self, message: &str) -> Error {
        Error::Device(format!("{}: {message}", self.description.name))
    }
}

/// What wgpu reported outside of a call's return value. Only the first error is kept: others follow from it.
#[derive(Debug, Default)]
struct Faults {
    first: Option<Error>,
    lost: Option<String>,
}

fn lock(faults: &Mutex<Faults>) -> MutexGuard<'_, Faults> {
    // Every state of two options is a good one, whoever panicked while holding them.
    faults.lock().unwrap_or_else(PoisonError::into_inner)
}

fn open_adapter(description: &Description, adapter: &wgpu::Adapter, storage_binding: u64) -> Result<Device> {
    let name = &description.name;
    let offered = adapter.limits();
    // The kernel asks no more than what WebGPU guarantees, save for large buffers; an adapter that offers less of
    // something (textures, vertex buffers) is as good as any.
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size.min(storage_binding),
        max_buffer_size: offered.max_buffer_size,
        ..wgpu::Limits::default().or_worse_values_from(&offered)
    };
    let (needed, given) = (8, limits.max_storage_buffers_per_shader_stage);
    if given < needed {
        return Err(Error::Device(format!("{name} gives a kernel {given} storage buffers; {needed} are needed")));
    }
    let supported =
        MemoryAccess::ALL.into_iter().rev().find(|&access| adapter.features().contains(features_for(access)));
    let best_access = supported.unwrap_or(MemoryAccess::Words);
    let memory_access = match description.kind {
        DeviceKind::Software => best_access,
        // A GPU loads 16 bytes at once as it is, and once for all lanes that read the same.
        _ => MemoryAccess::Words,
    };
    let request = adapter.request_device(&wgpu::DeviceDescriptor {
        label: Some("gpu-trace"),
        required_limits: limits,
        required_features: features_for(best_access),
        // A renderer makes few and large buffers.
        memory_hints: wgpu::MemoryHints::MemoryUsage,
        ..Default::default()
    });
    let (device, queue) =
        pollster::block_on(request).map_err(|error| Error::Device(format!("{name} could not be opened: {error}")))?;

    let faults = Arc::new(Mutex::new(Faults::default()));
    let (sink, prefix) = (faults.clone(), name.clone());
    device.on_uncaptured_error(Arc::new(move |error| {
        lock(&sink).first.get_or_insert_with(|| match error {
            wgpu::Error::OutOfMemory { .. } => Error::Device(format!("{prefix} is out of memory")),
            wgpu::Error::Validation { description, .. } => Error::Kernel(format!("{prefix}: {description}")),
            wgpu::Error::Internal { description, .. } => Error::Device(format!("{prefix}: {description}")),
        });
    }));
    let (sink, prefix) = (faults.clone(), name.clone());
    device.set_device_lost_callback(move |reason, message| {
        lock(&sink).lost.get_or_insert_with(|| match reason {
            wgpu::DeviceLostReason::Destroyed => format!("{prefix} was closed"),
            wgpu::DeviceLostReason::Unknown => format!("{prefix} was lost: {message}"),
        });
    });
    let limits = device.limits().into();
    Ok(Device { device, queue, description: description.clone(), limits, memory_access, faults })
}

fn features_for(access: MemoryAccess) -> wgpu::Features {
    match access {
        MemoryAccess::Words => wgpu::Features::empty(),
        MemoryAccess::Pairs => wgpu::Features::SHADER_INT64,
        MemoryAccess::SharedPairs => wgpu::Features::SHADER_INT64 | wgpu::Features::SUBGROUP,
    }
}

fn no_device<'a>(selector: &DeviceSelector, found: impl Iterator<Item = &'a Description>) -> Error {
    let names: Vec<String> = found.map(|description| format!("'{}'", description.name)).collect();
    let wanted = match selector {
        _ if names.is_empty() => "no Vulkan, Metal or Direct3D 12 device was found".to_owned(),
        DeviceSelector::Any => "no device was found".to_owned(),
        DeviceSelector::Hardware => format!("no hardware GPU was found, only {}", names.join(", ")),
        DeviceSelector::Software => format!("no software device was found, only {}", names.join(", ")),
        DeviceSelector::Named(part) => {
            return Error::Device(format!("no device's name contains '{part}'; there are {}", names.join(", ")));
        }
    };
    Error::Device(format!("{wanted}; {INSTALL_HINT}"))
}

/// How to get a device, for messages.
pub const INSTALL_HINT: &str = "for a graphics card, install its vendor's driver; a software device needs none and \
     comes on Debian and Ubuntu with `apt-get install mesa-vulkan-drivers libvulkan1`; \
     or render with --device cpu";
