//! The native renderer: the kernel's work, block by block, on all cores.

use crate::cpu::bindings::Bindings;
use crate::cpu::camera::camera_ray;
use crate::cpu::film::film_add;
use crate::cpu::path::path_radiance;
use crate::film::Film;
use crate::flatten::SceneBuffers;
use crate::layout::{Dispatch, FilmPixel, Frame, RAY_CAMERA};
use crate::renderer::{Renderer, Tally};
use crate::{Error, Result};
use glam::UVec2;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

const BLOCK_EDGE: u32 = 8;

/// One 8 × 8 block of the film, rows from the top.
#[derive(Clone)]
struct FilmBlock([FilmPixel; (BLOCK_EDGE * BLOCK_EDGE) as usize]);

/// Renders on the CPU with rayon's threads; needs no driver. The reference for the GPU.
#[derive(Default)]
pub struct CpuRenderer {
    scene: Arc<SceneBuffers>,
    rows: Range<u32>,
    blocks: Vec<FilmBlock>,
}

impl CpuRenderer {
    pub fn new() -> Self {
        Self::default()
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

    fn begin_band(&mut self, rows: Range<u32>) -> Result<()> {
        let size = self.scene.frame.image_size;
        let count = size.x.div_ceil(BLOCK_EDGE) as usize * (rows.end - rows.start).div_ceil(BLOCK_EDGE) as usize;
        let empty = FilmBlock([FilmPixel::default(); (BLOCK_EDGE * BLOCK_EDGE) as usize]);
        self.blocks.clear();
        self.blocks.resize(count, empty);
        self.rows = rows;
        Ok(())
    }

    fn submit(&mut self, frame: &Frame, dispatches: &[Dispatch]) -> Result<Tally> {
        let scene = Bindings::new(&self.scene, frame);
        let mut tally = Tally::default();
        for dispatch in dispatches {
            let run = dispatch.first_block as usize..(dispatch.first_block + dispatch.block_count) as usize;
            let Some(blocks) = self.blocks.get_mut(run) else {
                return Err(Error::Kernel(format!("blocks {dispatch:?} lie outside the band")));
            };
            tally += blocks
                .par_iter_mut()
                .enumerate()
                .map(|(offset, block)| render_block(&scene, dispatch, dispatch.first_block + offset as u32, block))
                .reduce(Tally::default, |mut sum, part| {
                    sum += part;
                    sum
                });
        }
        Ok(tally)
    }

    fn end_band(&mut self, film: &mut Film) -> Result<()> {
        let width = self.scene.frame.image_size.x;
        let height = self.rows.end - self.rows.start;
        let blocks_across = width.div_ceil(BLOCK_EDGE);
        let mut band = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let block = &self.blocks[(y / BLOCK_EDGE * blocks_across + x / BLOCK_EDGE) as usize];
                band.push(block.0[(y % BLOCK_EDGE * BLOCK_EDGE + x % BLOCK_EDGE) as usize]);
            }
        }
        film.add_band(self.rows.start, &band);
        Ok(())
    }
}

/// One pass of one camera sample for each pixel of a block; what the kernel in `shaders/kernels/render.wgsl` does.
fn render_block(scene: &Bindings, dispatch: &Dispatch, block: u32, film: &mut FilmBlock) -> Tally {
    let mut tally = Tally::default();
    let blocks_across = scene.frame.image_size.x.div_ceil(BLOCK_EDGE);
    let corner = UVec2::new(block % blocks_across, block / blocks_across) * BLOCK_EDGE;
    for y in 0..BLOCK_EDGE.min(dispatch.band_rows - corner.y) {
        for x in 0..BLOCK_EDGE.min(scene.frame.image_size.x - corner.x) {
            let pixel = corner + UVec2::new(x, y + dispatch.band_row);
            tally.rays[RAY_CAMERA as usize] += 1;
            let camera = camera_ray(scene.frame, pixel, dispatch.sample_index);
            let radiance = path_radiance(scene, camera, dispatch.sample_index, dispatch.pass_index, &mut tally)
                / scene.frame.pass_count as f32;
            let sum = &mut film.0[(y * BLOCK_EDGE + x) as usize];
            *sum = film_add(*sum, radiance, &mut tally);
        }
    }
    tally
}
