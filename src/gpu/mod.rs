//! The GPU renderer, on Vulkan, Metal or Direct3D 12 through wgpu; the only module that names wgpu.
//!
//! [`device`] finds and opens a device, `pipeline` compiles the kernel for it, `buffers` uploads a scene,
//! `dispatch` runs passes, `readback` brings the film home; [`renderer`] puts them together, and [`probe`] tells
//! `gpu-trace doctor` what there is.

mod buffers;
pub mod device;
mod dispatch;
mod pipeline;
pub mod probe;
mod readback;
pub mod renderer;

pub use device::{Description, Device, DeviceKind, DeviceLimits, DeviceSelector, list_adapters};
pub use renderer::{GpuOptions, GpuRenderer};
