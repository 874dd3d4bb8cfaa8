//! From linear radiance to the values that a picture file holds.

use crate::scene::Transfer;

/// The written value of a linear one, both nominally in [0, 1]: as it is, or by the curve of IEC 61966-2-1.
pub fn encode(transfer: Transfer, linear: f64) -> f64 {
    match transfer {
        Transfer::Linear => linear,
        Transfer::Srgb if linear <= 0.003_130_8 => 12.92 * linear,
        Transfer::Srgb => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
    }
}

/// The linear value of an sRGB one in [0, 1]; the inverse of [`encode`] with [`Transfer::Srgb`].
pub fn decode_srgb(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The nearest of 256 steps, halves upwards; what lies outside [0, 1] is clamped, and NaN is 0.
pub fn quantise(value: f64) -> u8 {
    // The cast saturates, and takes NaN to 0.
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}
