// Roots of quadratics for the shapes, and the small numerical helpers that they share.

// Stands for infinity in intervals along a ray: larger than any distance, and still a number.
const FAR: f32 = 3.0e38;

// Divisors are kept away from zero by this much.
const TINY: f32 = 1.0e-20;

// 1 / x, where an x of (nearly) zero counts as TINY of the same sign.
fn safe_reciprocal(x: f32) -> f32 {
    return 1.0 / select(select(TINY, -TINY, x < 0.0), x, abs(x) > TINY);
}

// The roots, lower first, of a t^2 - 2 b t + c = 0 for a != 0. The caller gives the quarter discriminant
// d = b^2 - a c in a form without cancellation (for quadrics: from the moment origin x direction, which is the closest
// approach times the length of the direction); where d < 0 it counts as 0. Both roots come from the sum of like signs
// (Haines et al., Ray Tracing Gems ch. 7), so neither suffers when b^2 is much larger than a c.
fn quadratic_roots(a: f32, b: f32, c: f32, d: f32) -> vec2<f32> {
    let root = sqrt(max(d, 0.0));
    let q = b + select(root, -root, b < 0.0);
    // q is 0 only where b and d are, and then both roots are.
    let t0 = select(c / q, 0.0, q == 0.0);
    let t1 = q / a;
    return vec2<f32>(min(t0, t1), max(t0, t1));
}

// Cube root of x in [0, 1e37], to a relative error of 3e-5 above 1e-30: a third of the exponent, then one step of
// Halley's method.
fn cube_root(x: f32) -> f32 {
    let v = max(x, 1.0e-30);
    let y = bitcast<f32>(bitcast<u32>(v) / 3u + 709921077u);
    let y3 = y * y * y;
    return y * ((y3 + 2.0 * v) / (2.0 * y3 + v));
}
