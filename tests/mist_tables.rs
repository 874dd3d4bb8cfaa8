//! Free flights through mist: both renderers' numbers, their distribution, and the volumes as flattened.

use crate::support::function_table::{Compare, FunctionTable, Twins, floats};
use crate::support::placed::bindings;
use crate::support::{Stage, chi_square_deviate, paint};
use glam::{DAffine3, DVec3, UVec2, Vec3};
use gpu_trace::cpu::dimensions::DIMENSION_MIST;
use gpu_trace::cpu::math::rng::{hash_combine, hash_u32, sobol_2d, unit_from_bits};
use gpu_trace::cpu::media::mists_at;
use gpu_trace::cpu::shading::medium::{choose_mist, free_flight, mist_cross, mists_density};
use gpu_trace::flatten::{SceneBuffers, flatten};
use gpu_trace::layout::{INSTANCE_MIST, MATERIAL_MIST};
use gpu_trace::scene::{Material, Shape};
use gpu_trace::shader::PARTS;

const SAMPLES: u32 = 200_000;

pub fn mist(density: f32, colour: Vec3) -> Material {
    Material { density: Some(density), ..paint(colour.x, colour.y, colour.z) }
}

/// A function of all the shaders, for (density, xi) in a lane.
fn flight_twins(body: &str) -> Twins<1, 1> {
    let parts: Vec<&str> = PARTS.iter().filter_map(|part| part.path.strip_prefix("shaders/")).collect();
    let rows = (0..10_000_u32).map(|row| {
        let xi = match row {
            0 => 0.0,
            1 => unit_from_bits(u32::MAX),
            _ => unit_from_bits(hash_u32(row)),
        };
        let density = if row % 100 == 2 { 0.0 } else { unit_from_bits(hash_u32(row ^ 0x5555_0000)).max(1e-6) };
        [floats([density, xi, 0.0, 0.0])]
    });
    Twins::new(rows.collect(), &FunctionTable::new(&parts, body), |[row]| {
        let [density, xi, ..] = row.map(f32::from_bits);
        [floats([free_flight(density, xi), 0.0, 0.0, 0.0])]
    })
}

#[test]
fn free_flights_are_the_same_bits() {
    let body = "results[0].x = bitcast<u32>(free_flight(f32_at(0u, 0u), f32_at(0u, 1u)));";
    flight_twins(body).assert_close("free_flight", [Compare::Floats], 0);
}

#[test]
fn a_slightly_denser_mist_is_rejected() {
    let body = "results[0].x = bitcast<u32>(free_flight(f32_at(0u, 0u) * 1.000001, f32_at(0u, 1u)));";
    assert!(flight_twins(body).difference([Compare::Floats]).ulps > 4);
}

/// Chi-square deviate of flights against exp(-density s), over intervals of equal probability, and their mean.
fn exponential_deviate(density: f64, flight: impl Fn(f32) -> f32) -> (f64, f64) {
    const BINS: usize = 64;
    let mut counts = vec![0_u64; BINS];
    let mut sum = 0.0;
    for n in 0..SAMPLES {
        let xi = sobol_2d(n % 64, hash_combine(hash_combine(hash_u32(n), DIMENSION_MIST), n % 3)).x;
        let s = f64::from(flight(xi));
        sum += s;
        counts[((1.0 - (-density * s).exp()) * BINS as f64).clamp(0.0, BINS as f64 - 1.0) as usize] += 1;
    }
    let deviate = chi_square_deviate(&counts, &vec![f64::from(SAMPLES) / BINS as f64; BINS]);
    (deviate, sum / f64::from(SAMPLES))
}

#[test]
fn free_flights_are_exponential_with_the_mean_one_over_density() {
    for density in [0.01_f32, 0.3, 1.0, 2.7] {
        let (deviate, mean) = exponential_deviate(f64::from(density), |xi| free_flight(density, xi));
        assert!(deviate.abs() < 4.0, "density {density}: chi-square lies {deviate:.1} standard deviations off");
        // The standard deviation of an exponential distribution is its mean.
        let error = (mean * f64::from(density) - 1.0) * f64::from(SAMPLES).sqrt();
        assert!(error.abs() < 4.0, "density {density}: the mean free path is {mean}");
    }
}

#[test]
fn flights_without_the_logarithm_are_rejected() {
    let (deviate, mean) = exponential_deviate(0.3, |xi| (1.0 - xi) / 0.3);
    assert!(deviate > 100.0 && (mean * 0.3 - 1.0).abs() > 0.4, "deviate {deviate}, mean {mean}");
}

/// Balls of mist about the origin with these densities, sharing one material where they are equal.
fn nested(densities: &[f32]) -> SceneBuffers {
    let mut stage = Stage::new(4, 4);
    for (n, density) in densities.iter().enumerate() {
        let scale = DAffine3::from_scale(DVec3::splat(1.0 + n as f64));
        stage.add(Shape::Sphere, scale, mist(*density, Vec3::ONE));
    }
    flatten(&stage.finish()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn overlapping_mists_scatter_in_proportion_to_their_densities() {
    let densities = [0.1, 0.4, 0.3, 0.2];
    for used in 1..=4 {
        let buffers = nested(&densities[..used]);
        let scene = bindings(&buffers);
        let mists = mists_at(&scene, Vec3::new(0.1, 0.2, 0.3));
        let total: f32 = densities[..used].iter().sum();
        assert!((mists_density(&scene, mists) - total).abs() < 1e-6);
        let mut counts = vec![0_u64; used];
        for n in 0..SAMPLES {
            let number = choose_mist(&scene, mists, unit_from_bits(hash_u32(n)));
            let density = scene.materials[number as usize - 1].density;
            counts[densities.iter().position(|d| *d == density).expect("one of the densities")] += 1;
        }
        let expected: Vec<f64> = densities[..used].iter().map(|d| f64::from(d / total * SAMPLES as f32)).collect();
        if used == 1 {
            assert_eq!(counts[0], u64::from(SAMPLES));
            continue;
        }
        let deviate = chi_square_deviate(&counts, &expected);
        assert!(deviate < 4.0, "{counts:?} for {expected:?}: {deviate:.1} standard deviations off");
        // Equal shares are not what is wanted.
        let equal = vec![f64::from(SAMPLES) / used as f64; used];
        assert!(chi_square_deviate(&counts, &equal) > 20.0);
    }
}

#[test]
fn the_eye_is_found_in_the_mists_around_it() {
    let buffers = nested(&[0.1, 0.2, 0.3]);
    let scene = bindings(&buffers);
    for (at, expected) in [(0.5, 0.6), (1.5, 0.5), (2.5, 0.3), (3.5, 0.0)] {
        let mists = mists_at(&scene, Vec3::new(at, 0.0, 0.0));
        assert!((mists_density(&scene, mists) - expected).abs() < 1e-6, "at {at}: {mists}");
    }
}

#[test]
fn crossing_a_boundary_twice_changes_nothing() {
    let once = mist_cross(UVec2::ZERO, 7, true);
    assert_eq!(mist_cross(once, 7, true), once);
    let two = mist_cross(once, 9, true);
    assert_eq!(mist_cross(two, 7, true), two);
    assert_eq!(mist_cross(two, 9, false), once);
    assert_eq!(mist_cross(once, 9, false), once);
    assert_eq!(mist_cross(once, 7, false), UVec2::ZERO);
}

#[test]
fn every_volume_has_a_material_of_its_own() {
    let mut stage = Stage::new(4, 4);
    let fog = stage.add_material(mist(0.5, Vec3::ONE));
    for x in 0..5 {
        stage.add_with(Shape::Cube, DAffine3::from_translation(DVec3::X * f64::from(x)), fog);
    }
    stage.add(Shape::Cube, DAffine3::IDENTITY, paint(1.0, 1.0, 1.0));
    let buffers = flatten(&stage.finish()).unwrap_or_else(|error| panic!("{error}"));
    let mists: Vec<_> = buffers.instances.iter().filter(|instance| instance.flags & INSTANCE_MIST != 0).collect();
    assert_eq!(mists.len(), 5);
    let mut numbers: Vec<u32> = mists.iter().map(|instance| instance.material).collect();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), 5);
    for number in numbers {
        let material = &buffers.materials[number as usize];
        assert_eq!((material.medium, material.density), (number + 1, 0.5));
        assert!(material.flags & MATERIAL_MIST != 0 && material.mist_step > 0.0);
    }
    assert!(buffers.features.mist);
}

#[test]
fn mist_without_an_inside_is_refused() {
    let mut stage = Stage::new(4, 4);
    stage.add(Shape::Plane, DAffine3::IDENTITY, mist(0.5, Vec3::ONE));
    let error = flatten(&stage.finish()).expect_err("a plane of mist").to_string();
    assert!(error.contains("no inside"), "{error}");
}

#[test]
fn more_volumes_than_numbers_are_refused() {
    let mut stage = Stage::new(4, 4);
    let fog = stage.add_material(mist(0.5, Vec3::ONE));
    for x in 0..65_536 {
        stage.add_with(Shape::Sphere, DAffine3::from_translation(DVec3::X * f64::from(x)), fog);
    }
    let error = flatten(&stage.finish()).expect_err("65,536 volumes").to_string();
    assert!(error.contains("65535"), "{error}");
}
