//! Elementary functions of our own, since those of drivers differ; twin of `shaders/math/elementary.wgsl`.

use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// The vector's direction. `normalize` may multiply by a reciprocal root instead, which is another number.
pub fn unit_vector(v: Vec3) -> Vec3 {
    v / v.dot(v).sqrt()
}

/// Base-2 logarithm of a positive normal number, from log2(m) = 2/ln2 artanh((m - 1) / (m + 1)) with m in
/// [1/√2, √2); absolute error below 2e-7 beside the integer part.
pub fn log2_poly(x: f32) -> f32 {
    let bits = x.to_bits();
    // 0x3f3504f3 is 1/√2: the exponent counts from there.
    let shifted = bits.wrapping_sub(0x3f35_04f3);
    let exponent = (shifted as i32) >> 23;
    let m = f32::from_bits((shifted & 0x007f_ffff) + 0x3f35_04f3);
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let mut series = 0.111_111_11 * q + 0.142_857_15;
    series = series * q + 0.2;
    series = series * q + 0.333_333_34;
    series *= q;
    exponent as f32 + 2.885_39 * (s + s * series)
}

/// 2^x, 0 below -126 and 2^127 above 127; relative error below 3e-7.
pub fn exp2_poly(x: f32) -> f32 {
    let clamped = x.clamp(-126.0, 127.0);
    let whole = (clamped + 0.5).floor();
    let t = (clamped - whole) * std::f32::consts::LN_2;
    let mut series = t * 0.000_198_412_7 + 0.001_388_888_9;
    series = series * t + 0.008_333_334;
    series = series * t + 0.041_666_668;
    series = series * t + 0.166_666_67;
    series = series * t + 0.5;
    series = series * t + 1.0;
    series = series * t + 1.0;
    let scale = f32::from_bits((whole + (8_388_608.0 + 127.0)).to_bits() << 23);
    if x < -126.0 { 0.0 } else { series * scale }
}

/// base^exponent for base and exponent >= 0; 0^0 is 1.
pub fn power(base: f32, exponent: f32) -> f32 {
    let safe = base.max(f32::MIN_POSITIVE);
    let result = exp2_poly(exponent * log2_poly(safe));
    if base < f32::MIN_POSITIVE { if exponent == 0.0 { 1.0 } else { 0.0 } } else { result }
}

/// The angle from the x axis to (x, y), in [-π, π]; 0 for (0, 0). The smaller component over the larger is brought
/// below tan(π/8) by atan(t) = π/4 + atan((t - 1) / (t + 1)); the polynomial there is a minimax fit of atan(t) / t in
/// t², off by 2e-8 of itself. Absolute error below 3e-7.
pub fn atan2_poly(y: f32, x: f32) -> f32 {
    let low = x.abs().min(y.abs());
    let high = x.abs().max(y.abs());
    let ratio = low / high.max(f32::MIN_POSITIVE);
    let steep = ratio > 0.414_213_57;
    let t = if steep { (ratio - 1.0) / (ratio + 1.0) } else { ratio };
    let q = t * t;
    let mut series = q * 0.080_600_66 - 0.138_797_8;
    series = series * q + 0.199_779_2;
    series = series * q - 0.333_329_56;
    let arc = t + t * (series * q);
    let eighth = if steep { arc + FRAC_PI_4 } else { arc };
    let quarter = if y.abs() > x.abs() { FRAC_PI_2 - eighth } else { eighth };
    let half = if x < 0.0 { PI - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

/// Arc sine of x, which counts as 1 or -1 beyond them; absolute error below 4e-7.
pub fn asin_poly(x: f32) -> f32 {
    let sine = x.clamp(-1.0, 1.0);
    atan2_poly(sine, ((1.0 - sine) * (1.0 + sine)).sqrt())
}

/// Arc cosine of x, which counts as 1 or -1 beyond them; absolute error below 4e-7.
pub fn acos_poly(x: f32) -> f32 {
    let cosine = x.clamp(-1.0, 1.0);
    atan2_poly(((1.0 - cosine) * (1.0 + cosine)).sqrt(), cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elementary_functions_match_f64() {
        let mut worst = [0.0_f64; 3];
        for step in 1..200_000 {
            let x = step as f32 * 1e-4;
            worst[0] = worst[0].max((f64::from(log2_poly(x)) - f64::from(x).log2()).abs());
            let e = x - 10.0;
            worst[1] = worst[1].max((f64::from(exp2_poly(e)) / f64::from(e).exp2() - 1.0).abs());
            let (base, exponent) = ((step % 1000) as f32 / 1000.0 + 1e-3, (step / 1000) as f32);
            let expected = f64::from(base).powf(f64::from(exponent));
            worst[2] = worst[2].max((f64::from(power(base, exponent)) - expected).abs());
        }
        assert!(worst[0] < 6e-7 && worst[1] < 3e-7 && worst[2] < 2e-5, "{worst:?}");
        assert_eq!((power(0.0, 0.0), power(0.0, 2.0), power(1.0, 5000.0)), (1.0, 0.0, 1.0));
        assert_eq!(exp2_poly(-1000.0), 0.0);
    }
}
