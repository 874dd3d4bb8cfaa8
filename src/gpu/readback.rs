//! From the device's memory to the host's.

use super::buffers::create;
use super::device::Device;
use crate::Result;
use crate::film::Film;
use crate::layout::FilmPixel;
use std::ops::Range;
use std::sync::mpsc;

/// Bytes of film that are copied at a time: few enough to leave memory to the scene, enough to be at full speed.
const CHUNK: u64 = 16 << 20;

/// Calls `read` with the first `size` bytes of a buffer that was made for mapping and that earlier submissions fill.
pub(super) fn map<R>(device: &Device, staging: &wgpu::Buffer, size: u64, read: impl FnOnce(&[u8]) -> R) -> Result<R> {
    let (sender, receiver) = mpsc::channel();
    let slice = staging.slice(..size);
    slice.map_async(wgpu::MapMode::Read, move |result| {
        // The receiver is only gone where waiting failed, and then nobody wants to know.
        let _ = sender.send(result);
    });
    device.wait()?;
    match receiver.try_recv() {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(device.error(&format!("a result could not be read: {error}"))),
        Err(_) => return Err(device.error("a result did not arrive")),
    }
    let result = match slice.get_mapped_range() {
        Ok(bytes) => read(&bytes),
        Err(error) => return Err(device.error(&format!("a result could not be read: {error}"))),
    };
    staging.unmap();
    device.check()?;
    Ok(result)
}

/// Adds the sums of a band, whose first pixel is the buffer's first, to the film, some rows at a time.
pub(super) fn read_film(device: &Device, buffer: &wgpu::Buffer, band: Range<u32>, film: &mut Film) -> Result<()> {
    let row_size = u64::from(film.width) * size_of::<FilmPixel>() as u64;
    if row_size == 0 || band.is_empty() {
        return Ok(());
    }
    let rows_at_once = u32::try_from(CHUNK / row_size).unwrap_or(u32::MAX).clamp(1, band.end - band.start);
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    let staging = create(device, "film readback", row_size * u64::from(rows_at_once), usage)?;
    let mut row = band.start;
    while row < band.end {
        let rows = rows_at_once.min(band.end - row);
        let size = row_size * u64::from(rows);
        let mut encoder = device.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, row_size * u64::from(row - band.start), &staging, 0, size);
        device.queue.submit([encoder.finish()]);
        let pixels = map(device, &staging, size, bytemuck::pod_collect_to_vec::<u8, FilmPixel>)?;
        film.add_band(row, &pixels);
        row += rows;
    }
    Ok(())
}
