//! Triangles against f64, their seams, and the packing of normals.
//!
//! Hits are judged by the distance between the point that the barycentrics name and the point that t names; misses by
//! how far inside the triangle the exact ray passes. Both in units of half an ulp of the distance of the
//! farthest corner, times longest edge / height of the triangle as the ray sees it: rounding errors of the areas are
//! larger, relatively, where the area is small. Worst found over 100,000 rays: 2.3.

use crate::support::oracle::exact;
use crate::support::rays::{config, power_of_ten, unit_vector};
use glam::{DVec3, Vec3};
use gpu_trace::cpu::geometry::triangle::*;
use gpu_trace::flatten::encode_octahedral;
use proptest::prelude::*;
use std::cell::Cell;

const UNBOUNDED: f32 = 3.0e38;

#[derive(Clone, Copy, Debug)]
struct Case {
    corners: [Vec3; 3],
    origin: Vec3,
    direction: Vec3,
}

/// Rays towards the plane of a triangle, at its inside, its edges and beyond; slivers and tiny triangles included.
fn case() -> impl Strategy<Value = Case> {
    let corner = || (unit_vector(), 0.0..1.0f64).prop_map(|(d, r)| d * r);
    let weights = (-0.5..1.5f64, -0.5..1.5f64, power_of_ten(-9.0, -1.0), 0..4u32);
    let placing = (power_of_ten(-4.0, 3.0), unit_vector(), power_of_ten(-2.0, 4.0), power_of_ten(-3.0, 3.0));
    (corner(), corner(), corner(), power_of_ten(-4.0, 0.0), weights, placing).prop_map(
        |(p0, p1, p2, sliver, (b1, b2, close, kind), (size, towards, distance, scale))| {
            let p2 = if kind == 3 { p1 + (p2 - p1) * sliver } else { p2 };
            // Anywhere, close to an edge, or inside.
            let (b1, b2) = match kind {
                0 => (b1, b2),
                1 => (b1, close - 0.01),
                _ => (0.5 * b1 + 0.25, (0.5 * b2 + 0.25) * (0.75 - 0.5 * b1)),
            };
            let target = p0 * (1.0 - b1 - b2) + p1 * b1 + p2 * b2;
            let origin = target + towards * distance;
            Case {
                corners: [p0, p1, p2].map(|p| (p * size).as_vec3()),
                origin: (origin * size).as_vec3(),
                direction: ((target - origin).normalize() * scale).as_vec3(),
            }
        },
    )
}

/// Longest edge over height, as seen along the ray. Where the height is but rounding error there are no barycentrics
/// to speak of: slivers and triangles seen edge-on are tested down to a height of 1e-4.
fn slenderness(case: &Case) -> f64 {
    let [p0, p1, p2] = case.corners.map(exact);
    let longest2 = (p1 - p0).length_squared().max((p2 - p1).length_squared()).max((p0 - p2).length_squared());
    longest2 / (p1 - p0).cross(p2 - p0).dot(exact(case.direction).normalize()).abs()
}

fn intersect(case: &Case, t_max: f32) -> TriangleHit {
    let [p0, p1, p2] = case.corners;
    triangle_intersect(&triangle_ray(case.origin, case.direction), p0, p1, p2, t_max)
}

/// How far inside the exact line passes (negative: outside), measured across the line, and its t.
fn exact_crossing(case: &Case) -> (f64, f64) {
    let [p0, p1, p2] = case.corners.map(exact);
    let (o, d) = (exact(case.origin), exact(case.direction));
    let plane = (p1 - p0).cross(p2 - p0);
    let side = -plane.dot(d).signum();
    let inside = [(p0, p1), (p1, p2), (p2, p0)].map(|(a, b)| {
        // Signed distance between the line and the edge's line.
        let across = d.cross(b - a);
        (a - o).dot(across) * side / across.length().max(f64::MIN_POSITIVE)
    });
    (inside.into_iter().fold(f64::INFINITY, f64::min), plane.dot(p0 - o) / plane.dot(d))
}

/// Backward error of a result, in units.
fn error(case: &Case, hit: TriangleHit) -> f64 {
    let [p0, p1, p2] = case.corners.map(exact);
    let (o, d) = (exact(case.origin), exact(case.direction));
    let size = case.corners.iter().map(|p| exact(*p).distance(o)).fold(0.0, f64::max);
    let unit = 2f64.powi(-24) * size * slenderness(case);
    if hit.t > 0.0 {
        let (b1, b2) = (f64::from(hit.b1), f64::from(hit.b2));
        let named = p0 * (1.0 - b1 - b2) + p1 * b1 + p2 * b2;
        let weights = [1.0 - b1 - b2, b1, b2].into_iter().fold(1.0, f64::min);
        ((o + d * f64::from(hit.t)).distance(named) / unit).max(-weights * 2f64.powi(22))
    } else {
        let (inside, t) = exact_crossing(case);
        if t > 0.0 { (inside / unit).max(0.0) } else { 0.0 }
    }
}

#[test]
fn triangle_matches_exact_line() {
    let (worst, hits, misses) = (Cell::new(0f64), Cell::new(0), Cell::new(0));
    let mut runner = proptest::test_runner::TestRunner::new(config(8000));
    let outcome = runner.run(&case(), |case| {
        prop_assume!(slenderness(&case) <= 1e4);
        let hit = intersect(&case, UNBOUNDED);
        let count = if hit.t > 0.0 { &hits } else { &misses };
        count.set(count.get() + 1);
        let error = error(&case, hit);
        worst.set(worst.get().max(error));
        prop_assert!(error <= 8.0, "{error} units: {hit:?} {:?}", exact_crossing(&case));
        if hit.t > 0.0 {
            prop_assert_eq!(intersect(&case, hit.t).t, -1.0);
            prop_assert_eq!(intersect(&case, hit.t.next_up()), hit);
            // From the other side, the same.
            let [p0, p1, p2] = case.corners;
            let turned = intersect(&Case { corners: [p0, p2, p1], ..case }, UNBOUNDED);
            prop_assert!((turned.b1 - hit.b2).abs().max((turned.b2 - hit.b1).abs()) <= 2e-7);
        }
        Ok(())
    });
    println!("triangle: {} hits, {} misses; worst {:.2} units", hits.get(), misses.get(), worst.get());
    outcome.unwrap_or_else(|failure| panic!("triangle: {failure}"));
    assert!(hits.get() > 1000 && misses.get() > 1000);
}

#[test]
fn wrong_triangles_are_found_out() {
    let mut runner = proptest::test_runner::TestRunner::new(config(8000));
    let outcome = runner.run(&case(), |case| {
        prop_assume!(slenderness(&case) <= 1e4);
        let hit = intersect(&case, UNBOUNDED);
        let wrong = TriangleHit { b1: hit.b2, b2: hit.b1, ..hit };
        prop_assert!(error(&case, wrong) <= 8.0);
        Ok(())
    });
    assert!(outcome.is_err(), "exchanged barycentrics passed");
    let outcome = runner.run(&case(), |case| {
        let hit = intersect(&case, UNBOUNDED);
        let strict = hit.b1 > 1e-3 && hit.b2 > 1e-3 && hit.b1 + hit.b2 < 0.999;
        let wrong = TriangleHit { t: if strict { hit.t } else { -1.0 }, ..hit };
        prop_assert!(error(&case, wrong) <= 8.0);
        Ok(())
    });
    assert!(outcome.is_err(), "a narrower triangle passed");
}

proptest! {
    #![proptest_config(config(8000))]

    /// A fan of triangles closes the ring about its hub: rays at the hub, at the spokes and at their midpoints, exact
    /// to the bit or not, meet at least one of them.
    #[test]
    fn seams_are_watertight(
        hub in (unit_vector(), power_of_ten(-2.0, 2.0)),
        ring in prop::collection::vec((0.5..2.0f64, -0.4..0.4f64), 5..9),
        origin in (unit_vector(), power_of_ten(-1.0, 3.0)),
        along in (0.0..0.9f64, 0..9usize, 0..3u32),
    ) {
        let hub = (hub.0 * hub.1).as_vec3();
        let away = if origin.0.y.abs() < 0.8 { DVec3::new(origin.0.x, 0.8f64.copysign(origin.0.y), origin.0.z) }
            else { origin.0 };
        let origin = (exact(hub) + away * origin.1).as_vec3();
        let count = ring.len();
        let rim: Vec<Vec3> = ring.iter().enumerate().map(|(i, (radius, lift))| {
            let angle = std::f64::consts::TAU * i as f64 / count as f64;
            let radius = radius * 0.1;
            (exact(hub) + DVec3::new(radius * angle.cos(), 0.02 * lift, radius * angle.sin())).as_vec3()
        }).collect();
        let (part, spoke, kind) = along;
        let end = rim[spoke % count];
        let target = match kind { 0 => hub, 1 => (hub + end) * 0.5, _ => hub + (end - hub) * part as f32 };
        let ray = triangle_ray(origin, target - origin);
        let met = (0..count).any(|i| {
            triangle_intersect(&ray, hub, rim[i], rim[(i + 1) % count], UNBOUNDED).t > 0.0
        });
        prop_assert!(met, "a ray slipped through");
    }

    #[test]
    fn octahedral_packing_round_trips(n in unit_vector(), size in power_of_ten(-3.0, 3.0)) {
        let unpacked = exact(decode_octahedral(encode_octahedral((n * size).as_vec3())));
        prop_assert!(unpacked.distance(n) <= 7e-5, "{} off", unpacked.distance(n));
        prop_assert!((unpacked.length() - 1.0).abs() <= 2e-7);
    }

    #[test]
    fn geometric_normal_matches_f64(case in case()) {
        let [p0, p1, p2] = case.corners.map(exact);
        let (e1, e2) = (p1 - p0, p2 - p0);
        let plane = e1.cross(e2);
        // Slivers: the relative rounding error of the cross product.
        let condition = e1.length() * e2.length() / plane.length();
        prop_assume!(condition < 1e5);
        let reach = case.corners.iter().map(|p| p.length()).fold(0.0, f32::max) as f64;
        let spread = reach / e1.length().min(e2.length());
        let n = exact(triangle_geometric_normal(case.corners[0], case.corners[1], case.corners[2]));
        let off = n.distance(plane.normalize());
        prop_assert!(off <= 2f64.powi(-22) * condition * spread.max(1.0), "{off} off");
    }

    #[test]
    fn shading_normal_is_between(a in unit_vector(), b in unit_vector(), c in unit_vector(),
                                 b1 in 0.0..1.0f64, b2 in 0.0..1.0f64) {
        let (b1, b2) = if b1 + b2 > 1.0 { (1.0 - b1, 1.0 - b2) } else { (b1, b2) };
        let sum = a * (1.0 - b1 - b2) + b * b1 + c * b2;
        prop_assume!(sum.length() > 0.01);
        let packed = [a, b, c].map(|n| encode_octahedral(n.as_vec3()));
        let n = exact(triangle_shading_normal(packed[0], packed[1], packed[2], b1 as f32, b2 as f32));
        prop_assert!(n.distance(sum.normalize()) <= 1.5e-4 / sum.length());
    }
}

#[test]
fn degenerate_triangles_have_answers() {
    let p = Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(triangle_geometric_normal(p, p, p), Vec3::Y);
    assert_eq!(triangle_geometric_normal(p, p * 2.0, p * 3.0), Vec3::Y);
    let ray = triangle_ray(Vec3::ZERO, p);
    assert_eq!(triangle_intersect(&ray, p, p, p, UNBOUNDED).t, -1.0);
    let (up, down) = (encode_octahedral(Vec3::Y), encode_octahedral(Vec3::NEG_Y));
    assert_eq!(triangle_shading_normal(up, down, down, 0.5, 0.0), Vec3::Y);
    for n in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        assert_eq!(decode_octahedral(encode_octahedral(n)), n);
    }
}
