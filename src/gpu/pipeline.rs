//! The kernel, compiled for one device and one set of features.

use super::device::Device;
use crate::layout::{self, Dispatch, Frame};
use crate::{Error, Result};
use std::num::NonZeroU64;

/// Bindings of group 0, as `shaders/bindings.wgsl` numbers them.
pub(super) mod binding {
    pub const FRAME: u32 = 0;
    pub const DISPATCH: u32 = 1;
    pub const NODES: u32 = 2;
    pub const INSTANCES: u32 = 3;
    pub const TRIANGLES: u32 = 4;
    pub const MATERIALS: u32 = 5;
    pub const LIGHTS: u32 = 6;
    pub const TEXELS: u32 = 7;
    pub const FILM: u32 = 8;
    pub const STATUS: u32 = 9;
}

/// A compiled kernel and the layout of its bindings; clones are the same kernel.
#[derive(Clone)]
pub(super) struct Pipeline {
    pub pipeline: wgpu::ComputePipeline,
    pub bind_group_layout: wgpu::BindGroupLayout,
}

impl Pipeline {
    /// Compiles `entry_point` of the WGSL program with the given `override` constants. `source` has to be valid.
    pub fn new(
        device: &Device,
        source: &str,
        entry_point: &str,
        overrides: &[(&str, bool)],
        checked: bool,
    ) -> Result<Self> {
        let bind_group_layout = device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("scene and film"),
            entries: &layout_entries(),
        });
        let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("scene and film"),
            bind_group_layouts: &[Some(&bind_group_layout)],
            immediate_size: 0,
        });
        let constants: Vec<(&str, f64)> =
            overrides.iter().map(|&(name, value)| (name, f64::from(u8::from(value)))).collect();
        let pipeline = compile(device, source, entry_point, Some(&layout), &constants, checked)?;
        Ok(Pipeline { pipeline, bind_group_layout })
    }
}

/// Compiles a compute pipeline; without a layout, its own is taken from the source.
pub(super) fn compile(
    device: &Device,
    source: &str,
    entry_point: &str,
    layout: Option<&wgpu::PipelineLayout>,
    constants: &[(&str, f64)],
    checked: bool,
) -> Result<wgpu::ComputePipeline> {
    let descriptor =
        wgpu::ShaderModuleDescriptor { label: Some(entry_point), source: wgpu::ShaderSource::Wgsl(source.into()) };
    let module = if checked {
        device.device.create_shader_module(descriptor)
    } else {
        // SAFETY: the checks left out are the bounds of array indices and of loops and the guards of integer
        // division. The kernels keep to them themselves: every loop in shaders/ has a bound of its own, divisors are
        // counts that the host never sends as 0 (`check` in dispatch.rs), and indices come from buffers
        // that `flatten` wrote or are compared with counts in `Frame` and `Dispatch`, which `check` compares with
        // the sizes of the buffers. On GPUs the checks cost speed; `GpuOptions::checked` keeps them.
        #[allow(unsafe_code)]
        unsafe {
            device.device.create_shader_module_trusted(descriptor, wgpu::ShaderRuntimeChecks::unchecked())
        }
    };
    let pipeline = device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry_point),
        layout,
        module: &module,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants,
            // The kernels write workgroup memory before they read it, and zeroing costs lavapipe a minute of compiling.
            zero_initialize_workgroup_memory: false,
        },
        cache: None,
    });
    device.check().map_err(|error| match error {
        Error::Kernel(message) => Error::Shader(message),
        other => other,
    })?;
    Ok(pipeline)
}

fn layout_entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    use wgpu::BufferBindingType::{Storage, Uniform};
    let read_only = Storage { read_only: true };
    let written = Storage { read_only: false };
    let buffers = [
        (binding::FRAME, Uniform, size_of::<Frame>()),
        (binding::DISPATCH, Uniform, size_of::<Dispatch>()),
        (binding::NODES, read_only, size_of::<layout::Node>()),
        (binding::INSTANCES, read_only, size_of::<layout::Instance>()),
        (binding::TRIANGLES, read_only, size_of::<layout::Triangle>()),
        (binding::MATERIALS, read_only, size_of::<layout::Material>()),
        (binding::LIGHTS, read_only, size_of::<layout::Light>()),
        (binding::TEXELS, read_only, size_of::<u32>()),
        (binding::FILM, written, size_of::<layout::FilmPixel>()),
        (binding::STATUS, written, size_of::<layout::Status>()),
    ];
    let entry = |(binding, ty, least)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: binding == binding::DISPATCH,
            min_binding_size: NonZeroU64::new(least as u64),
        },
        count: None,
    };
    buffers.into_iter().map(entry).collect()
}
