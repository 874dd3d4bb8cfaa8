//! The root finders alone, against f64.

use gpu_trace::cpu::math::roots::{TINY, cube_root, quadratic_roots, safe_reciprocal};
use proptest::prelude::*;

/// Relative error of a root in units of half an ulp.
fn root_error(root: f32, exact: f64) -> f64 {
    (f64::from(root) - exact).abs() / (2f64.powi(-24) * exact.abs())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(4000) })]

    /// Coefficients from chosen roots, from far apart to nearly equal, so that the discriminant is known.
    #[test]
    fn quadratic_roots_have_all_their_digits(
        root in -3.0..3.0f64,
        ratio in -8.0..0.0f64,
        signs in (any::<bool>(), any::<bool>(), any::<bool>()),
        leading in -6.0..6.0f64,
    ) {
        let sign = |s: bool, x: f64| if s { x } else { -x };
        let low = sign(signs.0, 10f64.powf(root));
        let high = sign(signs.1, 10f64.powf(root + ratio));
        let a = sign(signs.2, 10f64.powf(leading)) as f32;
        let (b, c) = ((f64::from(a) * 0.5 * (low + high)) as f32, (f64::from(a) * low * high) as f32);
        // The roots of the rounded coefficients, and their exact discriminant.
        let (a64, b64, c64) = (f64::from(a), f64::from(b), f64::from(c));
        let d = b64 * b64 - a64 * c64;
        prop_assume!(d >= 0.0);
        let q = b64 + d.sqrt().copysign(b64);
        let (x, y) = (c64 / q, q / a64);
        let (near, far) = quadratic_roots(a, b, c, d as f32);
        prop_assert!(root_error(near, x.min(y)) <= 6.0 && root_error(far, x.max(y)) <= 6.0);
    }

    #[test]
    fn cube_root_is_close(exponent in -29.0..37.0f64) {
        let x = 10f64.powf(exponent) as f32;
        prop_assert!((f64::from(cube_root(x)) / f64::from(x).cbrt() - 1.0).abs() <= 3e-5);
    }

    #[test]
    fn reciprocal_is_the_division(x in prop_oneof![-1e6..1e6f32, -1e-18..1e-18f32]) {
        prop_assume!(x.abs() > TINY);
        prop_assert_eq!(safe_reciprocal(x), 1.0 / x);
    }
}

#[test]
fn quadratic_roots_at_the_edges() {
    // A double root, a root of zero, a negative discriminant (as if it were zero), and both roots zero.
    assert_eq!(quadratic_roots(1.0, 3.0, 9.0, 0.0), (3.0, 3.0));
    assert_eq!(quadratic_roots(2.0, 1.0, 0.0, 1.0), (0.0, 1.0));
    assert_eq!(quadratic_roots(1.0, -3.0, 9.0, -1e-9), (-3.0, -3.0));
    assert_eq!(quadratic_roots(5.0, 0.0, 0.0, 0.0), (0.0, 0.0));
    // Roots of 1e-10 and 1e10, where b² - a c swallows the small one.
    let (near, far) = quadratic_roots(1.0, 5e9, 1.0, 2.5e19);
    assert!((near - 1e-10).abs() < 1e-16 && (far - 1e10).abs() < 2e3);
}

#[test]
fn reciprocals_of_nothing_are_finite() {
    for x in [0.0, -0.0, 1e-30, -1e-30, TINY, -TINY] {
        assert_eq!(safe_reciprocal(x), if x < 0.0 { -1.0 / TINY } else { 1.0 / TINY });
    }
    assert!(cube_root(0.0) < 2e-10);
}

/// The textbook formula must fail the test that ours passes.
#[test]
fn cancellation_is_found_out() {
    let (a, b, c, d) = (1.0f32, 5e3f32, 1.0f32, 2.5e7f32 - 1.0);
    let exact = 1.0 / (5e3f64 + (2.5e7f64 - 1.0).sqrt());
    let textbook = (b - d.sqrt()) / a;
    assert!(root_error(textbook, exact) > 1000.0);
    assert!(root_error(quadratic_roots(a, b, c, d).0, exact) <= 6.0);
}
