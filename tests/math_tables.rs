//! Function tables of math/roots, math/offset and geometry/triangle, as in `function_tables.rs`.

use crate::support::function_table::{
    Compare::{Bits, Floats},
    FunctionTable, Lane, Twins, floats, lane_vec3, vec3_lane,
};
use crate::support::rays::{draw, placement, power_of_ten, unit_vector};
use glam::{DVec3, Vec3};
use gpu_trace::cpu::geometry::triangle::*;
use gpu_trace::cpu::math::{offset::*, roots::*};
use gpu_trace::flatten::encode_octahedral;
use proptest::prelude::*;

const UNBOUNDED: f32 = 3.0e38;
const ROWS: usize = 6000;

/// Limits in ulps: the twins agree to the last bit.
const SAME: u32 = 0;

const TRIANGLE_PARTS: [&str; 3] = ["math/roots.wgsl", "geometry/hit.wgsl", "geometry/triangle.wgsl"];

#[test]
fn roots_agree() {
    let magnitude = || (any::<bool>(), power_of_ten(-9.0, 9.0)).prop_map(|(s, x)| if s { x } else { -x } as f32);
    let mut inputs: Vec<[Lane; 1]> = draw((magnitude(), magnitude(), magnitude(), magnitude()), ROWS)
        .into_iter()
        .map(|(a, b, c, d)| [floats([a, b, c, d])])
        .collect();
    for zeros in 1..8u32 {
        for row in 0..40 {
            // Each choice of zeros among b, c and d; a = 0 is outside the domain.
            let [a, b, c, d] = inputs[row][0].map(f32::from_bits);
            let keep = |x: f32, bit: u32| if zeros >> bit & 1 == 1 { 0.0 } else { x };
            inputs.push([floats([a, keep(b, 0), keep(c, 1), keep(d, 2)])]);
        }
    }
    let body = "let x = floats_at(0u);
         let roots = quadratic_roots(x.x, x.y, x.z, x.w);
         results[0] = float_lane(vec4<f32>(roots, cube_root(abs(x.x)), safe_reciprocal(x.w)));";
    let cpu = |row: &[Lane; 1]| {
        let [a, b, c, d] = row[0].map(f32::from_bits);
        let (near, far) = quadratic_roots(a, b, c, d);
        [floats([near, far, cube_root(a.abs()), safe_reciprocal(d)])]
    };
    let twins = Twins::new(inputs, &FunctionTable::new(&["math/roots.wgsl"], body), cpu);
    twins.assert_close("roots", [Floats], SAME);
    let far_first = Twins { cpu: twins.cpu.iter().map(|[r]| [[r[1], r[0], r[2], r[3]]]).collect(), ..twins };
    assert!(far_first.difference([Floats]).ulps > 1000, "the far root passed");
}

#[test]
fn offset_is_bit_exact() {
    let point = || (unit_vector(), power_of_ten(-8.0, 8.0)).prop_map(|(d, r)| (d * r).as_vec3());
    let mut inputs: Vec<[Lane; 2]> = draw((point(), unit_vector()), ROWS)
        .into_iter()
        .map(|(p, n)| [vec3_lane(p, 0.0), vec3_lane(n.as_vec3(), 0.0)])
        .collect();
    for p in [0.0, -0.0, 1.0 / 32.0, -1.0 / 32.0, (1.0f32 / 32.0).next_down(), 1.0, -1.0, 1e30] {
        for n in [Vec3::X, Vec3::NEG_X, Vec3::ONE.normalize(), Vec3::ZERO] {
            inputs.push([vec3_lane(Vec3::splat(p), 0.0), vec3_lane(n, 0.0)]);
        }
    }
    let body = "results[0] = float_lane(vec4<f32>(offset_ray_origin(vec3_at(0u), vec3_at(1u)), 0.0));";
    let towards = |side: f32| {
        move |row: &[Lane; 2]| [vec3_lane(offset_ray_origin(lane_vec3(row[0]), lane_vec3(row[1]) * side), 0.0)]
    };
    let twins = Twins::new(inputs, &FunctionTable::new(&["math/offset.wgsl"], body), towards(1.0));
    twins.assert_close("offset_ray_origin", [Bits], SAME);
    let wrong_side = Twins { cpu: twins.inputs.iter().map(towards(-1.0)).collect(), ..twins };
    assert!(wrong_side.difference([Bits]).rows > ROWS / 2, "the wrong side passed");
}

/// Rows of (origin, t_max), (direction, -) and three corners: rays through the inside, an edge or a corner, from far
/// and near, at triangles of all sizes.
fn triangle_rows() -> Vec<[Lane; 5]> {
    let corner = || (unit_vector(), 0.0..1.0f64).prop_map(|(d, r)| d * r);
    let aim = (-0.3..1.0f64, -0.3..1.0f64, 0..4usize, unit_vector(), power_of_ten(-2.0, 4.0), power_of_ten(-3.0, 3.0));
    let row =
        |(p0, p1, p2, (b1, b2, kind, towards, distance, scale), place): (DVec3, DVec3, DVec3, _, glam::DAffine3)| {
            let (b1, b2): (f64, f64) = [(b1, b2), (b1, 0.0), (b1, 1.0 - b1), (0.0, 0.0)][kind];
            let target = p0 * (1.0 - b1 - b2) + p1 * b1 + p2 * b2;
            let towards: DVec3 = if b1 < 0.0 { DVec3::Z } else { towards };
            let origin = target + towards * distance;
            let t_max = if kind == 0 && b2 > 0.5 { 1.0 / scale as f32 } else { UNBOUNDED };
            let [origin, p0, p1, p2] = [origin, p0, p1, p2].map(|p| place.transform_point3(p).as_vec3());
            let direction: DVec3 = (place.transform_point3(target) - origin.as_dvec3()) * scale;
            [
                vec3_lane(origin, t_max),
                vec3_lane(direction.as_vec3(), 0.0),
                vec3_lane(p0, 0.0),
                vec3_lane(p1, 0.0),
                vec3_lane(p2, 0.0),
            ]
        };
    draw((corner(), corner(), corner(), aim, placement()), ROWS).into_iter().map(row).collect()
}

#[test]
fn triangles_agree() {
    let body = "let ray = triangle_ray(vec3_at(0u), vec3_at(1u));
         let hit = triangle_intersect(ray, vec3_at(2u), vec3_at(3u), vec3_at(4u), f32_at(0u, 3u));
         let normal = triangle_geometric_normal(vec3_at(2u), vec3_at(3u), vec3_at(4u));
         results[0] = float_lane(vec4<f32>(hit.t, hit.b1, hit.b2, f32(hit.is_hit)));
         results[1] = float_lane(vec4<f32>(normal, 0.0));";
    let cpu = |row: &[Lane; 5]| {
        let [o, d, p0, p1, p2] = row.map(lane_vec3);
        let hit = triangle_intersect(&triangle_ray(o, d), p0, p1, p2, f32::from_bits(row[0][3]));
        [
            floats([hit.t, hit.b1, hit.b2, f32::from(u8::from(hit.is_hit))]),
            vec3_lane(triangle_geometric_normal(p0, p1, p2), 0.0),
        ]
    };
    let twins = Twins::new(triangle_rows(), &FunctionTable::new(&TRIANGLE_PARTS, body), cpu);
    let hits = twins.cpu.iter().filter(|row| f32::from_bits(row[0][0]) > 0.0).count();
    assert!(hits > 1000 && ROWS - hits > 1000, "{hits} hits");
    twins.assert_close("triangle_intersect and _geometric_normal", [Floats, Floats], SAME);

    let exchanged = FunctionTable::new(&TRIANGLE_PARTS, &body.replace("hit.b1, hit.b2", "hit.b2, hit.b1"));
    let wrong = Twins::new(twins.inputs, &exchanged, cpu);
    assert!(wrong.difference([Floats, Floats]).ulps > 1000, "exchanged barycentrics passed");
}

#[test]
fn octahedral_normals_agree() {
    let normal = || unit_vector().prop_map(|n| encode_octahedral(n.as_vec3()));
    let mut inputs: Vec<[Lane; 2]> = draw((normal(), normal(), normal(), 0.0..1.0f32, 0.0..1.0f32), ROWS)
        .into_iter()
        .map(|(n0, n1, n2, b1, b2)| [[n0, n1, n2, 0], floats([b1, b2 * (1.0 - b1), 0.0, 0.0])])
        .collect();
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].map(encode_octahedral);
    for n in axes {
        inputs.push([[n, axes[0], axes[1], 0], floats([0.5, 0.5, 0.0, 0.0])]);
    }
    let body = "let n = inputs[0];
         let b = floats_at(1u);
         results[0] = float_lane(vec4<f32>(decode_octahedral(n.x), 0.0));
         results[1] = float_lane(vec4<f32>(triangle_shading_normal(n.x, n.y, n.z, b.x, b.y), 0.0));";
    let cpu = |[n, b]: &[Lane; 2]| {
        let shading = triangle_shading_normal(n[0], n[1], n[2], f32::from_bits(b[0]), f32::from_bits(b[1]));
        [vec3_lane(decode_octahedral(n[0]), 0.0), vec3_lane(shading, 0.0)]
    };
    let twins = Twins::new(inputs, &FunctionTable::new(&TRIANGLE_PARTS, body), cpu);
    twins.assert_close("decode_octahedral and triangle_shading_normal", [Bits, Floats], SAME);

    let halves = body.replace("decode_octahedral(n.x)", "decode_octahedral(n.x >> 16u | n.x << 16u)");
    let wrong = Twins::new(twins.inputs, &FunctionTable::new(&TRIANGLE_PARTS, &halves), cpu);
    assert!(wrong.difference([Bits, Floats]).rows > ROWS / 2, "exchanged halves passed");
}
