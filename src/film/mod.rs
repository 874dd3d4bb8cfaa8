//! From sums of samples to a picture file, and from two picture files to how alike they look.

mod atomic;
pub mod clip;
mod compare;
mod output;
mod png;
mod resolve;
mod transfer;
mod unfinished;

pub use atomic::{AtomicFile, check_writable, write_atomically};
pub use compare::{Comparison, Mask, compare_images, compare_masked, read_picture};
pub use output::{OutputFormat, write_picture};
pub use transfer::{decode_srgb, encode, quantise};
pub use unfinished::discard_unfinished;

use crate::layout::FilmPixel;
use crate::{Error, Result};

/// Units of the fixed-point sums in one unit of radiance.
pub const FILM_SCALE: f64 = (1 << 20) as f64;

/// The most pixels a picture may have (16,384 x 16,384): its film then takes 8 GiB of memory.
pub const MAX_PIXELS: u64 = 1 << 28;

/// Sums of samples for every pixel, rows from the top: (red, green, blue, coverage) in units of 1 / [`FILM_SCALE`].
///
/// The sums are integers in two's complement, so adding is exact and its order does not matter: films of separate
/// sample ranges merge to the very film of the whole range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    pub width: u32,
    pub height: u32,
    /// Camera samples in every pixel's sum.
    pub samples: u32,
    pub pixels: Vec<[i64; 4]>,
}

impl Film {
    /// A film without samples; see [`Film::check_size`] for sizes that come from a user.
    pub fn new(width: u32, height: u32) -> Self {
        Film { width, height, samples: 0, pixels: vec![[0; 4]; width as usize * height as usize] }
    }

    /// # Errors
    /// [`Error::Scene`] where a side is 0 or there are more than [`MAX_PIXELS`] pixels.
    pub fn check_size(width: u32, height: u32) -> Result<()> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 {
            return Err(Error::Scene(format!("a picture of {width}x{height} has no pixels")));
        }
        if pixels > MAX_PIXELS {
            return Err(Error::Scene(format!(
                "a picture of {width}x{height} has {pixels} pixels, more than the {MAX_PIXELS} that a film may hold"
            )));
        }
        Ok(())
    }

    /// Adds the sums of the rows from `first_row` on. What lies below the last row is left out.
    pub fn add_band(&mut self, first_row: u32, band: &[FilmPixel]) {
        let start = first_row as usize * self.width as usize;
        for (sum, pixel) in self.pixels.iter_mut().skip(start).zip(band) {
            for (channel, value) in sum.iter_mut().enumerate() {
                let bits = (u64::from(pixel.high[channel]) << 32) | u64::from(pixel.low[channel]);
                *value = value.wrapping_add(bits as i64);
            }
        }
    }

    /// Adds the samples of another film of the same picture. The two must hold different samples (ranges that do not
    /// overlap); a film does not know which it holds.
    ///
    /// # Errors
    /// [`Error::Scene`] where the sizes differ, or the number of samples passes 32 bits. The film is then unchanged.
    pub fn merge(&mut self, other: &Film) -> Result<()> {
        if (self.width, self.height) != (other.width, other.height) {
            return Err(Error::Scene(format!(
                "cannot merge a film of {}x{} into one of {}x{}",
                other.width, other.height, self.width, self.height
            )));
        }
        let samples = self.samples.checked_add(other.samples).ok_or_else(|| {
            Error::Scene(format!("cannot merge films of {} and {} samples: too many", self.samples, other.samples))
        })?;
        self.samples = samples;
        for (sum, addend) in self.pixels.iter_mut().flatten().zip(other.pixels.iter().flatten()) {
            *sum = sum.wrapping_add(*addend);
        }
        Ok(())
    }
}
