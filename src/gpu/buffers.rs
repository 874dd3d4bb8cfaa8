//! The scene's arrays as storage buffers.

use super::device::Device;
use crate::flatten::SceneBuffers;
use crate::renderer::PrepareCounts;
use crate::{Error, Result};
use bytemuck::{NoUninit, Zeroable};
use std::sync::Arc;

/// Bytes that one write hands to the driver. wgpu copies each through memory of its own, which it gives back when
/// the copy has run: pieces keep a large scene from being held three times.
const PIECE: usize = 64 << 20;

/// What the kernel reads of a scene, on the device.
pub(super) struct SceneStorage {
    /// What the buffers hold, to tell what a later scene shares with it.
    contents: Arc<SceneBuffers>,
    pub nodes: wgpu::Buffer,
    pub instances: wgpu::Buffer,
    pub triangles: wgpu::Buffer,
    pub materials: wgpu::Buffer,
    pub lights: wgpu::Buffer,
    pub texels: wgpu::Buffer,
}

impl SceneStorage {
    /// Uploads every array, but for those that the scene before had already: their buffers are taken over, and the
    /// others of that scene freed.
    ///
    /// # Errors
    /// [`Error::Limit`] for an array that the device cannot bind, before anything is uploaded.
    pub fn upload(
        device: &Device,
        scene: Arc<SceneBuffers>,
        before: Option<SceneStorage>,
        counts: &mut PrepareCounts,
    ) -> Result<Self> {
        fit::<crate::layout::Node>(device, "hierarchy nodes", scene.nodes.len())?;
        fit::<crate::layout::Instance>(device, "instances", scene.instances.len())?;
        fit::<crate::layout::Triangle>(device, "triangles", scene.triangles.len())?;
        fit::<crate::layout::Material>(device, "materials", scene.materials.len())?;
        fit::<crate::layout::Light>(device, "lights", scene.lights.len())?;
        fit::<u32>(device, "texels", scene.texels.len())?;
        let kept = before.map_or_else(Kept::default, |before| before.shared_with(&scene));
        let mut place = |kept: Option<wgpu::Buffer>, upload: &dyn Fn() -> Result<wgpu::Buffer>| match kept {
            Some(buffer) => {
                counts.buffers_reused += 1;
                Ok(buffer)
            }
            None => {
                counts.buffers_uploaded += 1;
                upload()
            }
        };
        Ok(SceneStorage {
            nodes: place(kept.nodes, &|| upload(device, "nodes", &scene.nodes))?,
            instances: place(kept.instances, &|| upload(device, "instances", &scene.instances))?,
            triangles: place(kept.triangles, &|| upload(device, "triangles", &scene.triangles))?,
            materials: place(kept.materials, &|| upload(device, "materials", &scene.materials))?,
            lights: place(kept.lights, &|| upload(device, "lights", &scene.lights))?,
            texels: place(kept.texels, &|| upload(device, "texels", &scene.texels))?,
            contents: scene,
        })
    }

    /// The buffers whose contents are those of the scene, bit for bit.
    fn shared_with(self, scene: &SceneBuffers) -> Kept {
        let old = &self.contents;
        Kept {
            nodes: same(&old.nodes, &scene.nodes).then_some(self.nodes),
            instances: same(&old.instances, &scene.instances).then_some(self.instances),
            triangles: same(&old.triangles, &scene.triangles).then_some(self.triangles),
            materials: same(&old.materials, &scene.materials).then_some(self.materials),
            lights: same(&old.lights, &scene.lights).then_some(self.lights),
            texels: same(&old.texels, &scene.texels).then_some(self.texels),
        }
    }
}

/// Buffers of the scene before that the next one can use as they are.
#[derive(Default)]
struct Kept {
    nodes: Option<wgpu::Buffer>,
    instances: Option<wgpu::Buffer>,
    triangles: Option<wgpu::Buffer>,
    materials: Option<wgpu::Buffer>,
    lights: Option<wgpu::Buffer>,
    texels: Option<wgpu::Buffer>,
}

fn same<T: NoUninit>(a: &[T], b: &[T]) -> bool {
    bytemuck::cast_slice::<T, u8>(a) == bytemuck::cast_slice::<T, u8>(b)
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
