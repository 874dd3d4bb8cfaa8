//! The film: sums of samples in fixed point; twin of `shaders/film.wgsl`.

use crate::layout::{FilmPixel, STATUS_NOT_FINITE, STATUS_SATURATED};
use crate::renderer::Tally;
use glam::Vec4;

/// 2^20 units are 1.
const FILM_SCALE: f32 = 1_048_576.0;
/// What fits a sample, in radiance.
const FILM_RANGE: f32 = 2047.0;

/// A sample's value in film units, with its sign. NaN and infinity count as black and are reported.
pub fn film_units(value: f32, tally: &mut Tally) -> i32 {
    if !value.is_finite() {
        tally.flags |= STATUS_NOT_FINITE;
        return 0;
    }
    if value.abs() > FILM_RANGE {
        tally.flags |= STATUS_SATURATED;
    }
    (value.clamp(-FILM_RANGE, FILM_RANGE) * FILM_SCALE).round_ties_even() as i32
}

/// Adds a sample (radiance and coverage) to a pixel: 64-bit sums in two words.
pub fn film_add(pixel: FilmPixel, sample: Vec4, tally: &mut Tally) -> FilmPixel {
    let mut sum = pixel;
    for (channel, value) in sample.to_array().into_iter().enumerate() {
        let units = film_units(value, tally);
        let (low, carry) = pixel.low[channel].overflowing_add(units as u32);
        sum.low[channel] = low;
        sum.high[channel] = pixel.high[channel].wrapping_add((units >> 31) as u32).wrapping_add(u32::from(carry));
    }
    sum
}
