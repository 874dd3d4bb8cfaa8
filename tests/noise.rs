//! Perlin noise: both renderers to the last bit, and what the noise is known for: zero at the lattice, its gradients
//! there, two continuous derivatives, no repetition.

use crate::support::chi_square_deviate;
use crate::support::function_table::{Compare::Floats, FunctionTable, Lane, Twins, floats, lane_vec3, vec3_lane};
use crate::support::placed::Random;
use glam::{DVec3, IVec3, Vec3};
use gpu_trace::cpu::math::noise::{noise_gradient, perlin_noise, perlin_octaves};
use gpu_trace::cpu::math::rng::hash_u32;

const PARTS: [&str; 2] = ["math/rng.wgsl", "math/noise.wgsl"];

/// The twins agree to the last bit.
const SAME: u32 = 0;

/// Points of all sizes, of the lattice and next to it, on its edges and faces, and beyond what floats resolve.
fn points() -> Vec<Vec3> {
    let mut random = Random(31);
    let mut points = Vec::new();
    for reach in [1e-6, 0.5, 3.0, 40.0, 1e3, 1e5, 1e6, 1e7] {
        points.extend((0..1500).map(|_| random.point(reach).as_vec3()));
        points.extend((0..200).map(|_| random.point(reach).as_vec3().round()));
        for _ in 0..200 {
            let near = random.point(reach).as_vec3().round();
            points.extend([near.map(f32::next_up), near.map(f32::next_down), near + Vec3::splat(0.5)]);
            points.push(Vec3::new(near.x, random.between(-reach, reach) as f32, near.z));
        }
    }
    for extreme in [0.0, -0.0, 1e-40, -1e-40, -1e-20, 8_388_607.5, -8_388_607.5, 16_777_216.0, 3e9, -3e9, 1e30, -1e30] {
        points.extend([Vec3::splat(extreme), Vec3::new(0.3, extreme, -0.7)]);
    }
    points
}

#[test]
fn noise_agrees_on_both_devices() {
    let inputs: Vec<[Lane; 1]> = points().into_iter().map(|point| [vec3_lane(point, 0.0)]).collect();
    let table = FunctionTable::new(
        &PARTS,
        "let p = vec3_at(0u);
         results[0] = float_lane(vec4<f32>(perlin_noise(p), perlin_octaves(p.x, p.y, p.z), 0.0, 0.0));",
    );
    let cpu = |&[point]: &[Lane; 1]| {
        let p = lane_vec3(point);
        [floats([perlin_noise(p), perlin_octaves(p.x, p.y, p.z), 0.0, 0.0])]
    };
    let twins = Twins::new(inputs, &table, cpu);
    twins.assert_close("perlin_noise and perlin_octaves", [Floats], SAME);
    assert!(twins.cpu.iter().flatten().flatten().all(|bits| f32::from_bits(*bits).is_finite()));
    // A twin whose cells are one apart is noticed wherever the noise is not zero.
    let moved = |row: &[Lane; 1]| cpu(&[vec3_lane(lane_vec3(row[0]) + Vec3::Z, 0.0)]);
    let wrong = Twins { cpu: twins.inputs.iter().map(moved).collect(), ..twins };
    assert!(wrong.difference([Floats]).rows * 2 > wrong.inputs.len(), "noise of other cells passed");
}

/// The noise in double precision, in Perlin's own form: a blend over the eight corners.
fn noise_in_double(p: DVec3, fade: impl Fn(f64) -> f64) -> f64 {
    let cell = p.floor();
    let mut sum = 0.0;
    for corner in 0..8 {
        let step = IVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
        let at = cell.as_ivec3() + step;
        let code = [at.x, at.y, at.z].iter().fold(0, |hash: u32, &i| hash_u32(hash.wrapping_add(i as u32)));
        let offset = p - at.as_dvec3();
        let share = |axis: usize| {
            let t = fade((p - cell)[axis]);
            if step[axis] == 1 { t } else { 1.0 - t }
        };
        sum += share(0) * share(1) * share(2) * gradient(code).dot(offset);
    }
    sum
}

/// The gradient behind the four low bits, read off its products with the axes.
fn gradient(code: u32) -> DVec3 {
    let along = |axis: Vec3| f64::from(noise_gradient(code, axis.x, axis.y, axis.z));
    DVec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z))
}

fn quintic(t: f64) -> f64 {
    t.powi(3) * (t * (t * 6.0 - 15.0) + 10.0)
}

#[test]
fn noise_is_the_blend_of_its_corners_gradients() {
    let mut random = Random(32);
    let points: Vec<Vec3> = (0..20_000).map(|_| random.point(30.0).as_vec3()).collect();
    let worst = |fade: fn(f64) -> f64| {
        let error = |p: &Vec3| (f64::from(perlin_noise(*p)) - noise_in_double(p.as_dvec3(), fade)).abs();
        points.iter().map(error).fold(0.0, f64::max)
    };
    println!("worst error against double precision {:.2e}", worst(quintic));
    assert!(worst(quintic) < 2e-6);
    // The cubic fade of Perlin's first paper is another noise.
    assert!(worst(|t| t * t * (3.0 - 2.0 * t)) > 0.01);
}

#[test]
fn noise_is_zero_at_the_lattice_and_rises_there_by_its_gradient() {
    let mut random = Random(33);
    let mut counts = [0; 12];
    let mut kinds: Vec<DVec3> = Vec::new();
    for _ in 0..8000 {
        let point = random.point(5000.0).round();
        assert_eq!(perlin_noise(point.as_vec3()), 0.0);
        const STEP: f64 = 1.0 / 1024.0;
        let slope = |axis: DVec3| {
            let at = |side: f64| f64::from(perlin_noise((point + axis * STEP * side).as_vec3()));
            (at(1.0) - at(-1.0)) / (2.0 * STEP)
        };
        let slopes = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
        assert!((slopes - slopes.round()).length() < 1e-3, "{slopes} at {point}");
        assert_eq!(slopes.round().length_squared(), 2.0, "the gradients go to the middles of edges");
        let kind = kinds.iter().position(|kind| *kind == slopes.round()).unwrap_or_else(|| {
            kinds.push(slopes.round());
            kinds.len() - 1
        });
        counts[kind] += 1;
    }
    // Twelve gradients, of which Perlin's 16 codes hold four twice.
    let codes: Vec<DVec3> = (0..16).map(gradient).collect();
    let share = |kind: &DVec3| codes.iter().filter(|code| *code == kind).count() as f64;
    let expected: Vec<f64> = kinds.iter().map(|kind| 500.0 * share(kind)).collect();
    assert_eq!((kinds.len(), expected.iter().sum::<f64>()), (12, 8000.0));
    assert!(chi_square_deviate(&counts, &expected).abs() < 4.0, "{counts:?} of {expected:?}");
    assert!(chi_square_deviate(&counts, &[8000.0 / 12.0; 12]) > 4.0, "an even choice of the twelve passed");
}

#[test]
fn noise_has_zero_mean_and_a_range_of_about_one() {
    let mut random = Random(34);
    const COUNT: usize = 400_000;
    let values: Vec<f64> = (0..COUNT).map(|_| f64::from(perlin_noise(random.point(2000.0).as_vec3()))).collect();
    let mean = values.iter().sum::<f64>() / COUNT as f64;
    let deviation = (values.iter().map(|value| value * value).sum::<f64>() / COUNT as f64).sqrt();
    let (least, greatest) = values.iter().fold((0.0, 0.0), |(low, high), &v| (v.min(low), v.max(high)));
    println!("mean {mean:.5}, standard deviation {deviation:.4}, range {least:.3} to {greatest:.3}");
    // Five standard errors.
    let bound = 5.0 * deviation / (COUNT as f64).sqrt();
    assert!(mean.abs() < bound, "mean {mean}");
    assert!((0.2..0.35).contains(&deviation), "standard deviation {deviation}");
    assert!(least < -0.75 && least > -1.05 && greatest > 0.75 && greatest < 1.05, "{least} to {greatest}");
    let lifted = values.iter().map(|value| value.max(-0.5)).sum::<f64>() / COUNT as f64;
    assert!(lifted.abs() > bound, "a mean of {lifted} would not be noticed");
}

/// Slopes and curvatures from both sides of the faces between cells.
#[test]
fn derivatives_are_continuous_across_cells() {
    const STEP: f64 = 1e-4;
    let worst_jumps = |fade: fn(f64) -> f64| {
        let mut random = Random(35);
        let mut worst = [0.0_f64; 2];
        for round in 0..3000 {
            let mut face = random.point(50.0);
            face[round % 3] = face[round % 3].round();
            let mut axis = DVec3::ZERO;
            axis[round % 3] = STEP;
            let at = |steps: f64| noise_in_double(face + axis * steps, fade);
            let slope = |side: f64| side * (-1.5 * at(0.0) + 2.0 * at(side) - 0.5 * at(2.0 * side)) / STEP;
            let curvature =
                |side: f64| (2.0 * at(0.0) - 5.0 * at(side) + 4.0 * at(2.0 * side) - at(3.0 * side)) / STEP.powi(2);
            worst[0] = worst[0].max((slope(1.0) - slope(-1.0)).abs());
            worst[1] = worst[1].max((curvature(1.0) - curvature(-1.0)).abs());
        }
        worst
    };
    let [slope, curvature] = worst_jumps(quintic);
    println!("worst jump of the slope {slope:.2e}, of the curvature {curvature:.2e}");
    assert!(slope < 1e-5 && curvature < 0.05, "{slope} {curvature}");
    let [slope, curvature] = worst_jumps(|t| t);
    assert!(slope > 0.5, "a linear fade's slopes jump by {slope} only");
    let cubic = worst_jumps(|t| t * t * (3.0 - 2.0 * t));
    assert!(cubic[1] > 1.0, "a cubic fade's curvatures jump by {} only ({curvature})", cubic[1]);
}

#[test]
fn octaves_are_the_sum_of_the_api() {
    let mut random = Random(36);
    let octaves = |p: Vec3, count: i32| -> f64 {
        (0..count).map(|i| f64::from(perlin_noise(p * 2.0_f32.powi(i))) / 2.0_f64.powi(i)).sum()
    };
    let mut four_differ = 0;
    for _ in 0..5000 {
        let p = random.point(20.0).as_vec3();
        let sum = f64::from(perlin_octaves(p.x, p.y, p.z));
        assert!((sum - octaves(p, 5)).abs() < 1e-6);
        four_differ += usize::from((sum - octaves(p, 4)).abs() > 1e-6);
    }
    assert!(four_differ > 4900, "four octaves passed for five");
}

/// Perlin's table of 256 repeats; the hash does not, nor do rows and columns look alike.
#[test]
fn noise_does_not_repeat() {
    let mut random = Random(37);
    let points: Vec<Vec3> = (0..4000).map(|_| (random.point(8.0)).as_vec3()).collect();
    let correlation = |other: &dyn Fn(Vec3) -> Vec3| {
        let pairs: Vec<[f64; 2]> =
            points.iter().map(|p| [perlin_noise(*p), perlin_noise(other(*p))].map(f64::from)).collect();
        let sum = |term: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(term).sum::<f64>();
        sum(&|[a, b]| a * b) / (sum(&|[a, _]| a * a) * sum(&|[_, b]| b * b)).sqrt()
    };
    for period in [16.0, 64.0, 256.0, 1024.0, 4096.0] {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE, Vec3::new(1.0, -1.0, 0.0)] {
            let found = correlation(&|p| p + axis * period);
            assert!(found.abs() < 0.15, "{found} after {period} along {axis}");
        }
    }
    for turned in [Vec3::new(1.0, 0.0, 2.0), Vec3::new(2.0, 1.0, 0.0), Vec3::new(0.0, 2.0, 1.0)] {
        let order = turned.to_array().map(|axis| axis as usize);
        let found = correlation(&|p| Vec3::new(p[order[0]], p[order[1]], p[order[2]]));
        assert!(found.abs() < 0.15, "{found} between axes {order:?}");
    }
    assert!(correlation(&|p| p) > 0.99);
}
