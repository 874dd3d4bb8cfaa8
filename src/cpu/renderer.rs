//! The native renderer: the kernel's work, block by block, on all cores.

use crate::blocks::{BLOCK_EDGE, BlockOrder};
use crate::cpu::bindings::Bindings;
use crate::cpu::camera::camera_ray;
use crate::cpu::film::film_add;
use crate::cpu::path::path_radiance;
use crate::film::Film;
use crate::flatten::SceneBuffers;
use crate::layout::{Dispatch, FilmPixel, Frame, RAY_CAMERA};
use crate::renderer::{BLOCKS_A_THREAD, Renderer, Tally};
use crate::{Error, Result};
use glam::UVec2;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// One 8 × 8 block of the film, rows from the top.
#[derive(Clone)]
struct FilmBlock([FilmPixel; (BLOCK_EDGE * BLOCK_EDGE) as usize]);

fn lock(block: &Mutex<FilmBlock>) -> MutexGuard<'_, FilmBlock> {
    // Sums are whole at any time, whatever may have panicked.
    block.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Renders on the CPU with rayon's threads; needs no driver. The reference for the GPU.
#[derive(Default)]
pub struct CpuRenderer {
    scene: Arc<SceneBuffers>,
    rows: Range<u32>,
    /// Along the rows of the band. A dispatch takes each once, so that no lock is waited for.
    blocks: Vec<Mutex<FilmBlock>>,
}

impl CpuRenderer {
    pub fn new() -> Self {
        Self::default()
    }

    /// The block in a column and row of blocks of the band, if it lies in it.
    fn block(&self, block: UVec2) -> Option<&Mutex<FilmBlock>> {
        let across = self.scene.frame.image_size.x.div_ceil(BLOCK_EDGE);
        if block.x >= across { None } else { self.blocks.get((block.y * across + block.x) as usize) }
    }
}

impl Renderer for CpuRenderer {
    fn prepare(&mut self, scene: Arc<SceneBuffers>) -> Result<()> {
        self.scene = scene;
        Ok(())
    }

    fn max_band_pixels(&self) -> u64 {
        1 << 28
    }

    fn busy_blocks(&self) -> u32 {
        BLOCKS_A_THREAD * rayon::current_num_threads() as u32
    }

    fn begin_band(&mut self, rows: Range<u32>) -> Result<()> {
        let size = self.scene.frame.image_size;
        let count = size.x.div_ceil(BLOCK_EDGE) as usize * (rows.end - rows.start).div_ceil(BLOCK_EDGE) as usize;
        let empty = FilmBlock([FilmPixel::default(); (BLOCK_EDGE * BLOCK_EDGE) as usize]);
        self.blocks.clear();
        self.blocks.resize_with(count, || Mutex::new(empty.clone()));
        self.rows = rows;
        Ok(())
    }

    fn submit(&mut self, frame: &Frame, dispatches: &[Dispatch]) -> Result<Tally> {
        let scene = Bindings::new(&self.scene, frame);
        let mut tally = Tally::default();
        for dispatch in dispatches {
            let run = dispatch.first_block..dispatch.first_block.saturating_add(dispatch.block_count);
            let order = BlockOrder::new(frame.image_size.x, dispatch.band_rows);
            if run.end > order.places() || dispatch.band_rows != self.rows.end - self.rows.start {
                return Err(Error::Kernel(format!("blocks {dispatch:?} lie outside the band")));
            }
            let sum = |mut sum: Tally, part: Tally| {
                sum += part;
                sum
            };
            tally += run
                .into_par_iter()
                .map(|place| {
                    let block = order.block_at(place, dispatch.tile_stride);
                    self.block(block).map_or_else(Tally::default, |film| render_block(&scene, dispatch, block, film))
                })
                .reduce(Tally::default, sum);
        }
        Ok(tally)
    }

    fn end_band(&mut self, film: &mut Film) -> Result<()> {
        let width = self.scene.frame.image_size.x;
        let height = self.rows.end - self.rows.start;
        let mut band = vec![FilmPixel::default(); width as usize * height as usize];
        for (y, row) in (0..height).zip(band.chunks_exact_mut(width as usize)) {
            for (x, pixels) in (0..width).step_by(BLOCK_EDGE as usize).zip(row.chunks_mut(BLOCK_EDGE as usize)) {
                let Some(block) = self.block(UVec2::new(x, y) / BLOCK_EDGE) else { continue };
                let first = (y % BLOCK_EDGE * BLOCK_EDGE) as usize;
                pixels.copy_from_slice(&lock(block).0[first..first + pixels.len()]);
            }
        }
        film.add_band(self.rows.start, &band);
        Ok(())
    }
}

/// One pass of some camera samples for each pixel of a block; what the kernel in `shaders/kernels/render.wgsl` does.
fn render_block(scene: &Bindings, dispatch: &Dispatch, block: UVec2, film: &Mutex<FilmBlock>) -> Tally {
    let mut tally = Tally::default();
    let mut film = lock(film);
    let corner = block * BLOCK_EDGE;
    for y in 0..BLOCK_EDGE.min(dispatch.band_rows - corner.y) {
        for x in 0..BLOCK_EDGE.min(scene.frame.image_size.x - corner.x) {
            let pixel = corner + UVec2::new(x, y + dispatch.band_row);
            let sum = &mut film.0[(y * BLOCK_EDGE + x) as usize];
            let first = dispatch.sample_index;
            for sample_index in first..first.saturating_add(dispatch.sample_count) {
                tally.rays[RAY_CAMERA as usize] += 1;
                let camera = camera_ray(scene.frame, pixel, sample_index);
                let radiance = path_radiance(scene, camera, sample_index, dispatch.pass_index, &mut tally)
                    / scene.frame.pass_count as f32;
                *sum = film_add(*sum, radiance, &mut tally);
            }
        }
    }
    tally
}
