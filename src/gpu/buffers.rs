//! The scene's arrays as storage buffers.

use super::device::Device;
use crate::flatten::SceneBuffers;
use crate::{Error, Result};
use bytemuck::{NoUninit, Zeroable};

/// Bytes that one write hands to the driver. wgpu copies each through memory of its own, which it gives back when
/// the copy has run: pieces keep a large scene from being held three times.
const PIECE: usize = 64 << 20;

/// What the kernel reads of a scene, on the device.
pub(super) struct SceneStorage {
    pub nodes: wgpu::Buffer,
    pub instances: wgpu::Buffer,
    pub triangles: wgpu::Buffer,
    pub materials: wgpu::Buffer,
    pub lights: wgpu::Buffer,
    pub texels: wgpu::Buffer,
}

impl SceneStorage {
    /// Uploads every array.
    ///
    /// # Errors
    /// [`Error::Limit`] for an array that the device cannot bind, before anything is uploaded.
    pub fn upload(device: &Device, scene: &SceneBuffers) -> Result<Self> {
        fit::<crate::layout::Node>(device, "hierarchy nodes", scene.nodes.len())?;
        fit::<crate::layout::Instance>(device, "instances", scene.instances.len())?;
        fit::<crate::layout::Triangle>(device, "triangles", scene.triangles.len())?;
        fit::<crate::layout::Material>(device, "materials", scene.materials.len())?;
        fit::<crate::layout::Light>(device, "lights", scene.lights.len())?;
        fit::<u32>(device, "texels", scene.texels.len())?;
        Ok(SceneStorage {
            nodes: upload(device, "nodes", &scene.nodes)?,
            instances: upload(device, "instances", &scene.instances)?,
            triangles: upload(device, "triangles", &scene.triangles)?,
            materials: upload(device, "materials", &scene.materials)?,
            lights: upload(device, "lights", &scene.lights)?,
            texels: upload(device, "texels", &scene.texels)?,
        })
    }
}

/// Whether `count` elements can be bound as one storage buffer; returns their size in bytes, that of one at least.
pub(super) fn fit<T>(device: &Device, buffer: &'static str, count: usize) -> Result<u64> {
    let needed = (count.max(1) as u64).saturating_mul(size_of::<T>() as u64);
    let limits = device.limits();
    let bounds = [("max_storage_buffer_binding_size", limits.storage_binding), ("max_buffer_size", limits.buffer)];
    for (limit_name, limit) in bounds {
        if needed > limit {
            let device = device.description().name.clone();
            return Err(Error::Limit { buffer, needed, limit_name, limit, device });
        }
    }
    Ok(needed)
}

fn upload<T: NoUninit + Zeroable>(device: &Device, label: &'static str, items: &[T]) -> Result<wgpu::Buffer> {
    // WebGPU binds no empty array; the counts in `Frame` keep the kernel from reading the element that stands in.
    let one = [T::zeroed()];
    let items = if items.is_empty() { &one } else { items };
    let bytes: &[u8] = bytemuck::cast_slice(items);
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    let buffer = create(device, label, bytes.len() as u64, usage)?;
    for (index, piece) in bytes.chunks(PIECE).enumerate() {
        device.queue.write_buffer(&buffer, (index * PIECE) as u64, piece);
        if bytes.len() > PIECE {
            device.queue.submit([]);
            device.wait()?;
        }
    }
    device.check()?;
    Ok(buffer)
}

/// A new buffer, zeroed.
pub(super) fn create(device: &Device, label: &str, size: u64, usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
    let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
    let buffer = device.device.create_buffer(&descriptor);
    device.check()?;
    Ok(buffer)
}
