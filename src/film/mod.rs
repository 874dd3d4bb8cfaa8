//! From sums of samples to a picture file.

use crate::layout::FilmPixel;

/// Units of the fixed-point sums in one unit of radiance.
pub const FILM_SCALE: f64 = (1 << 20) as f64;

/// Sums of samples for every pixel, rows from the top: (red, green, blue, coverage) in units of 1 / [`FILM_SCALE`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    pub width: u32,
    pub height: u32,
    /// Camera samples in every pixel's sum.
    pub samples: u32,
    pub pixels: Vec<[i64; 4]>,
}

impl Film {
    pub fn new(width: u32, height: u32) -> Self {
        Film { width, height, samples: 0, pixels: vec![[0; 4]; width as usize * height as usize] }
    }

    /// Adds the sums of the rows from `first_row` on.
    pub fn add_band(&mut self, first_row: u32, band: &[FilmPixel]) {
        let start = first_row as usize * self.width as usize;
        for (sum, pixel) in self.pixels[start..].iter_mut().zip(band) {
            for channel in 0..4 {
                sum[channel] += ((u64::from(pixel.high[channel]) << 32) | u64::from(pixel.low[channel])) as i64;
            }
        }
    }
}
