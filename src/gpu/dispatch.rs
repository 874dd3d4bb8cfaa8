//! One scene on one device: its buffers, the band in hand, and the passes that run on it.

use super::buffers::{SceneStorage, create, fit};
use super::device::Device;
use super::pipeline::{Pipeline, binding};
use super::readback;
use crate::blocks::BlockOrder;
use crate::film::Film;
use crate::flatten::SceneBuffers;
use crate::layout::{self, Dispatch, FilmPixel, Frame, STATUS_LOOP_BOUND, Status};
use crate::renderer::{PrepareCounts, Tally};
use crate::{Error, Result};
use glam::UVec2;
use std::mem::offset_of;
use std::num::NonZeroU64;
use std::ops::Range;
use std::sync::Arc;

/// Bytes from one `Dispatch` to the next: dynamic offsets are multiples of what WebGPU guarantees to be enough.
const SLOT: u64 = 256;

/// More turns than an invocation gets from a driver that cuts loops short (Mesa before 23: 65,535).
const LONG_LOOP_TURNS: u32 = 100_000;

/// A scene that was uploaded, with the kernel that was specialised to it.
pub(super) struct Session {
    device: Device,
    pipeline: Pipeline,
    scene: SceneStorage,
    counts: Counts,
    frame: wgpu::Buffer,
    written_frame: Option<Frame>,
    /// One `Dispatch` every [`SLOT`] bytes.
    slots: wgpu::Buffer,
    status: wgpu::Buffer,
    status_staging: wgpu::Buffer,
    film: wgpu::Buffer,
    band: Range<u32>,
    bind_group: wgpu::BindGroup,
}

/// Sizes that a `Frame` has to agree with.
struct Counts {
    image_size: UVec2,
    instances: usize,
    lights: usize,
    nodes: usize,
}

impl Session {
    /// Uploads the scene, and takes over from the session before what can be used again.
    pub fn new(
        device: &Device,
        pipeline: Pipeline,
        scene: Arc<SceneBuffers>,
        before: Option<Session>,
        prepared: &mut PrepareCounts,
    ) -> Result<Self> {
        use wgpu::BufferUsages as Usage;
        let counts = Counts {
            image_size: scene.frame.image_size,
            instances: scene.instances.len(),
            lights: scene.lights.len(),
            nodes: scene.nodes.len(),
        };
        let (before, film) = before.map(|session| (session.scene, session.film)).unzip();
        let scene = SceneStorage::upload(device, scene, before, prepared)?;
        let status_size = size_of::<Status>() as u64;
        let frame = create(device, "frame", size_of::<Frame>() as u64, Usage::UNIFORM | Usage::COPY_DST)?;
        let slots = create_slots(device, 1)?;
        let status = create(device, "status", status_size, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC)?;
        let status_staging = create(device, "status readback", status_size, Usage::MAP_READ | Usage::COPY_DST)?;
        let film = film.map_or_else(|| create_film(device, size_of::<FilmPixel>() as u64), Ok)?;
        let bind_group = bind(device, &pipeline, &scene, [&frame, &slots, &film, &status])?;
        Ok(Session {
            device: device.clone(),
            pipeline,
            scene,
            counts,
            frame,
            written_frame: None,
            slots,
            status,
            status_staging,
            film,
            band: 0..0,
            bind_group,
        })
    }

    /// Runs the kernel without work: lavapipe and others compile at the first dispatch, not before. Returns whether the
    /// kernel's loops run to their ends, however long they are.
    pub fn warm_up(&mut self, frame: &Frame) -> Result<bool> {
        let dispatch = Dispatch { portions: 1, canary_turns: LONG_LOOP_TURNS, ..Dispatch::default() };
        Ok(self.run(frame, &[(dispatch, 1)])?.flags & STATUS_LOOP_BOUND == 0)
    }

    /// Takes these rows of the picture in hand, with every sum 0.
    pub fn begin_band(&mut self, rows: Range<u32>) -> Result<()> {
        if rows.start >= rows.end || rows.end > self.counts.image_size.y {
            return Err(Error::Kernel(format!(
                "rows {rows:?} are not in a picture of {} rows",
                self.counts.image_size.y
            )));
        }
        let pixels = u64::from(self.counts.image_size.x) * u64::from(rows.end - rows.start);
        let count = usize::try_from(pixels).unwrap_or(usize::MAX);
        let size = fit::<FilmPixel>(&self.device, "pixels in one band of rows", count)?;
        if size > self.film.size() {
            self.film = create_film(&self.device, size)?;
            self.rebind()?;
        }
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        encoder.clear_buffer(&self.film, 0, Some(size));
        self.device.queue.submit([encoder.finish()]);
        self.device.check()?;
        self.band = rows;
        Ok(())
    }

    /// Runs the dispatches one after another and waits for them.
    pub fn submit(&mut self, frame: &Frame, dispatches: &[Dispatch]) -> Result<Tally> {
        if dispatches.is_empty() {
            return Ok(Tally::default());
        }
        self.check(frame, dispatches)
            .map_err(|fault| Error::Kernel(format!("a dispatch that the kernel cannot run: {fault}")))?;
        let runs: Vec<_> = dispatches.iter().map(|dispatch| (*dispatch, workgroups(dispatch) as u32)).collect();
        self.run(frame, &runs)
    }

    /// Adds the sums of the band to the film.
    pub fn end_band(&mut self, film: &mut Film) -> Result<()> {
        let (width, height) = (self.counts.image_size.x, self.counts.image_size.y);
        if (film.width, film.height) != (width, height) {
            return Err(Error::Kernel(format!(
                "a film of {} x {} pixels cannot take a picture of {width} x {height}",
                film.width, film.height
            )));
        }
        let band = std::mem::replace(&mut self.band, 0..0);
        readback::read_film(&self.device, &self.film, band, film)
    }

    /// What the kernel relies on without looking: it runs without bounds checks, see `pipeline.rs`.
    fn check(&self, frame: &Frame, dispatches: &[Dispatch]) -> Result<(), String> {
        let Counts { image_size, instances, lights, nodes } = self.counts;
        if frame.image_size != image_size {
            return Err(format!("the picture was {image_size} and became {}", frame.image_size));
        }
        let counts = [frame.plane_count, frame.bounded_count, frame.mist_count];
        let counted: u64 = counts.into_iter().map(u64::from).sum();
        if counted > instances as u64 || frame.light_count as usize > lights {
            return Err(format!("{counted} instances, {} lights", frame.light_count));
        }
        let has_roots =
            (frame.bounded_count == 0 || nodes > 0) && (frame.mist_count == 0 || nodes > frame.mist_root as usize);
        if !has_roots || frame.pass_count == 0 {
            let Frame { pass_count, mist_root, .. } = frame;
            return Err(format!("{counted} instances, {nodes} nodes, mist from {mist_root}, {pass_count} passes"));
        }
        let rows = self.band.end - self.band.start;
        let order = BlockOrder::new(image_size.x, rows);
        let blocks = order.places();
        for dispatch in dispatches {
            let Dispatch { first_block, block_count, tile_stride, portions, .. } = *dispatch;
            if (dispatch.band_row, dispatch.band_rows) != (self.band.start, rows) {
                let end = u64::from(dispatch.band_row) + u64::from(dispatch.band_rows);
                return Err(format!("rows {}..{end} where {:?} are in hand", dispatch.band_row, self.band));
            }
            let end = u64::from(first_block) + u64::from(block_count);
            let workgroups = workgroups(dispatch);
            if end > u64::from(blocks) || workgroups > u64::from(self.device.limits().workgroups) || portions == 0 {
                return Err(format!("blocks {first_block}..{end} of {blocks} in {portions} portions"));
            }
            // Otherwise two workgroups would render one block at the same time.
            if !order.visits_all(tile_stride) {
                return Err(format!("a stride of {tile_stride} tiles over {blocks} blocks"));
            }
        }
        Ok(())
    }

    /// One command buffer: status cleared, each dispatch with its number of workgroups, status copied out.
    fn run(&mut self, frame: &Frame, dispatches: &[(Dispatch, u32)]) -> Result<Tally> {
        if self.written_frame.as_ref() != Some(frame) {
            self.device.queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(frame));
            self.written_frame = Some(*frame);
        }
        let bytes = dispatches.len() as u64 * SLOT;
        if bytes > self.slots.size() {
            self.slots = create_slots(&self.device, dispatches.len().next_power_of_two() as u64)?;
            self.rebind()?;
        }
        let mut slots = vec![0; dispatches.len() * SLOT as usize];
        for (slot, (dispatch, _)) in slots.chunks_exact_mut(SLOT as usize).zip(dispatches) {
            let bytes = bytemuck::bytes_of(dispatch);
            slot[..bytes.len()].copy_from_slice(bytes);
        }
        self.device.queue.write_buffer(&self.slots, 0, &slots);

        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        encoder.clear_buffer(&self.status, 0, None);
        for (index, (_, workgroups)) in dispatches.iter().enumerate() {
            // Each dispatch is taken from its beginning.
            encoder.clear_buffer(&self.status, offset_of!(Status, taken) as u64, Some(size_of::<u32>() as u64));
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline.pipeline);
            pass.set_bind_group(0, &self.bind_group, &[index as u32 * SLOT as u32]);
            pass.dispatch_workgroups(*workgroups, 1, 1);
        }
        let status_size = self.status.size();
        encoder.copy_buffer_to_buffer(&self.status, 0, &self.status_staging, 0, status_size);
        self.device.queue.submit([encoder.finish()]);
        let status = readback::map(&self.device, &self.status_staging, status_size, |bytes| {
            bytemuck::pod_read_unaligned::<Status>(bytes)
        })?;
        Ok(tally_of(&status))
    }

    fn rebind(&mut self) -> Result<()> {
        let others = [&self.frame, &self.slots, &self.film, &self.status];
        self.bind_group = bind(&self.device, &self.pipeline, &self.scene, others)?;
        Ok(())
    }
}

/// Workgroups of a dispatch: so many that each portion of them has the same number.
fn workgroups(dispatch: &Dispatch) -> u64 {
    u64::from(dispatch.block_count).next_multiple_of(u64::from(dispatch.portions.max(1)))
}

/// Sums the counters of each kind; the kernel spreads them over slots so that invocations seldom meet at one.
fn tally_of(status: &Status) -> Tally {
    let mut tally = Tally { flags: status.flags, ..Tally::default() };
    for (sum, slots) in tally.rays.iter_mut().zip(status.rays.chunks_exact(layout::RAY_SLOTS as usize)) {
        *sum = slots.iter().copied().map(u64::from).sum();
    }
    tally
}

fn create_slots(device: &Device, count: u64) -> Result<wgpu::Buffer> {
    create(device, "dispatches", count * SLOT, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST)
}

fn create_film(device: &Device, size: u64) -> Result<wgpu::Buffer> {
    use wgpu::BufferUsages as Usage;
    create(device, "film", size, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC)
}

fn bind(
    device: &Device,
    pipeline: &Pipeline,
    scene: &SceneStorage,
    [frame, slots, film, status]: [&wgpu::Buffer; 4],
) -> Result<wgpu::BindGroup> {
    let one_slot =
        wgpu::BufferBinding { buffer: slots, offset: 0, size: NonZeroU64::new(size_of::<Dispatch>() as u64) };
    fn whole(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
        wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
    }
    let bind_group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("scene and film"),
        layout: &pipeline.bind_group_layout,
        entries: &[
            whole(binding::FRAME, frame),
            wgpu::BindGroupEntry { binding: binding::DISPATCH, resource: wgpu::BindingResource::Buffer(one_slot) },
            whole(binding::NODES, &scene.nodes),
            whole(binding::INSTANCES, &scene.instances),
            whole(binding::TRIANGLES, &scene.triangles),
            whole(binding::MATERIALS, &scene.materials),
            whole(binding::LIGHTS, &scene.lights),
            whole(binding::TEXELS, &scene.texels),
            whole(binding::FILM, film),
            whole(binding::STATUS, status),
        ],
    });
    device.check()?;
    Ok(bind_group)
}
