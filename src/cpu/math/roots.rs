//! Roots of quadratics for the shapes, and small numerical helpers; twin of `shaders/math/roots.wgsl`.

/// Stands for infinity in intervals along a ray: larger than any distance, and still a number.
pub const FAR: f32 = 3.0e38;

/// Divisors are kept away from zero by this much.
pub const TINY: f32 = 1.0e-20;

/// 1 / x, where an x of (nearly) zero counts as [`TINY`] of the same sign.
#[inline]
pub fn safe_reciprocal(x: f32) -> f32 {
    let tiny = if x < 0.0 { -TINY } else { TINY };
    1.0 / if x.abs() > TINY { x } else { tiny }
}

/// The roots, lower first, of a t² − 2 b t + c = 0 for a ≠ 0, given the quarter discriminant d = b² − a c in a form
/// without cancellation; a negative d counts as 0. Haines et al., Ray Tracing Gems ch. 7.
#[inline]
pub fn quadratic_roots(a: f32, b: f32, c: f32, d: f32) -> (f32, f32) {
    let root = d.max(0.0).sqrt();
    let q = b + if b < 0.0 { -root } else { root };
    // q is 0 only where b and d are, and then both roots are.
    let t0 = if q == 0.0 { 0.0 } else { c / q };
    let t1 = q / a;
    (t0.min(t1), t0.max(t1))
}

/// Cube root of x in [0, 1e37], to a relative error of 3e-5 above 1e-30: a third of the exponent, then one step of
/// Halley's method.
#[inline]
pub fn cube_root(x: f32) -> f32 {
    let v = x.max(1.0e-30);
    let y = f32::from_bits(v.to_bits() / 3 + 709_921_077);
    let y3 = y * y * y;
    y * ((y3 + 2.0 * v) / (2.0 * y3 + v))
}
