//! What `gpu-trace doctor` finds out about devices.

use super::buffers::create;
use super::device::{Description, Device, DeviceSelector};
use super::{pipeline, readback};
use crate::Result;
use crate::shader::{Part, Program};
use bytemuck::{Pod, Zeroable};

/// How many turns of a loop a device makes, of those it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopTurns {
    pub expected: u32,
    pub made: u32,
}

/// Whether a device ends long loops early. Mesa's llvmpipe before version 23 leaves every loop, without a sign, when
/// one invocation has made 65,535 turns in all its loops together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopCap {
    /// One loop of 100,000 turns.
    pub single: LoopTurns,
    /// 60,000 turns of a loop of 10.
    pub nested: LoopTurns,
}

impl LoopCap {
    /// Turns that a loop made before the device ended it early, if it did.
    pub fn turns(&self) -> Option<u32> {
        [self.single, self.nested].into_iter().find(|turns| turns.made != turns.expected).map(|turns| turns.made)
    }
}

/// The probe's program, which is no part of the renderer's.
pub const LOOP_PROBE: Part<'static> =
    Part { path: "shaders/kernels/loop_probe.wgsl", text: include_str!("../../shaders/kernels/loop_probe.wgsl") };

/// Twin of `Probe` in `shaders/kernels/loop_probe.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Probe {
    single: u32,
    outer: u32,
    inner: u32,
    made: u32,
    mixed: u32,
}

/// [`loop_cap`] of every device.
///
/// # Errors
/// [`crate::Error::Device`] where there is no device, or the first that fails.
pub fn loop_caps() -> Result<Vec<(Description, LoopCap)>> {
    let devices = Device::open_each();
    if devices.is_empty() {
        // Says how to install one.
        Device::open(&DeviceSelector::Any)?;
    }
    devices.into_iter().map(|(description, _, device)| Ok((description, loop_cap(&device?)?))).collect()
}

/// Counts the turns that the device makes of long loops.
///
/// # Errors
/// [`crate::Error::Device`] where the device fails.
pub fn loop_cap(device: &Device) -> Result<LoopCap> {
    let probe = Probe { single: 100_000, outer: 60_000, inner: 10, made: 0, mixed: 0 };
    let program = Program::link(&[LOOP_PROBE])?;
    let turns = |entry_point, expected| -> Result<LoopTurns> {
        Ok(LoopTurns { expected, made: run(device, &program, entry_point, probe)?.made })
    };
    Ok(LoopCap {
        single: turns("single_loop", probe.single)?,
        nested: turns("nested_loops", probe.outer * probe.inner)?,
    })
}

fn run(device: &Device, program: &Program, entry_point: &str, probe: Probe) -> Result<Probe> {
    use wgpu::BufferUsages as Usage;
    // Unchecked: naga's own loop bound would be one more counter in each loop.
    let pipeline = pipeline::compile(device, program.source(), entry_point, None, &[], false)?;
    let size = size_of::<Probe>() as u64;
    let buffer = create(device, "probe", size, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC)?;
    let staging = create(device, "probe readback", size, Usage::MAP_READ | Usage::COPY_DST)?;
    device.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&probe));
    let bind_group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("probe"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    });
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bind_group, &[]);
    pass.dispatch_workgroups(1, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&buffer, 0, &staging, 0, size);
    device.queue.submit([encoder.finish()]);
    readback::map(device, &staging, size, bytemuck::pod_read_unaligned)
}
