//! Random numbers, sampling, elementary functions, shading and the film on the device against their CPU twins.

use crate::support::function_table::Compare::{Bits, Floats};
use crate::support::function_table::{Compare, FunctionTable, Lane, floats, vec3_lane, worst_difference};
use glam::{UVec2, Vec2, Vec3, Vec4};
use gpu_trace::cpu::film::film_add;
use gpu_trace::cpu::math::{elementary::*, rng::*, sampling::*};
use gpu_trace::cpu::shading::material::*;
use gpu_trace::layout::{FilmPixel, Material};
use gpu_trace::renderer::Tally;

const ROWS: u32 = 8192;

/// Words of all sizes: zero, powers of two and their neighbours, all ones, and hashes.
fn words(row: u32, salt: u32) -> u32 {
    match row % 8 {
        0 => 1 << ((row / 8) % 32),
        1 => (1_u32 << ((row / 8) % 32)).wrapping_sub(1),
        2 => row / 8,
        3 => !(row / 8),
        _ => hash_u32(row ^ salt),
    }
}

/// A number in [0, 1) for a row.
fn unit(row: u32, salt: u32) -> f32 {
    unit_from_bits(hash_u32(row ^ hash_u32(salt)))
}

/// A unit vector; every sixth is along an axis, of either sign.
fn direction(row: u32, salt: u32) -> Vec3 {
    if row.is_multiple_of(6) {
        let sign = if row.is_multiple_of(4) { 1.0 } else { -1.0 };
        return sign * Vec3::AXES[(row / 6 % 3) as usize];
    }
    sample_cone(Vec3::Z, 2.0, Vec2::new(unit(row, salt), unit(row, salt + 1)))
}

/// Evaluates a body for each row and compares with its twin; `limit` is in units of the last place.
fn agree<const I: usize, const O: usize>(
    parts: &[&str],
    body: &str,
    how: [Compare; O],
    limit: u32,
    row: impl Fn(u32) -> [Lane; I],
    twin: impl Fn([Lane; I]) -> [Lane; O],
) {
    let inputs: Vec<[Lane; I]> = (0..ROWS).map(row).collect();
    let gpu: Vec<[Lane; O]> = FunctionTable::new(parts, body).evaluate(&inputs);
    let cpu: Vec<[Lane; O]> = inputs.iter().map(|input| twin(*input)).collect();
    let worst = worst_difference(&gpu, &cpu, how);
    println!("{} of {ROWS} rows differ, by {} ulps at most", worst.rows, worst.ulps);
    let n = worst.row;
    assert!(
        worst.ulps <= limit,
        "{}: {:?} gives {:?} on the GPU, {:?} on the CPU",
        worst.ulps,
        inputs[n],
        gpu[n],
        cpu[n]
    );
}

fn vec3(lane: Lane) -> Vec3 {
    Vec3::new(f32::from_bits(lane[0]), f32::from_bits(lane[1]), f32::from_bits(lane[2]))
}

fn float(lane: Lane, component: usize) -> f32 {
    f32::from_bits(lane[component])
}

const RNG: &[&str] = &["math/rng.wgsl"];

#[test]
fn hashes_and_scrambling_are_the_same_bits() {
    agree(
        RNG,
        "let a = inputs[0].x; let b = inputs[0].y;
         results[0] = vec4<u32>(hash_u32(a), hash_combine(a, b), laine_karras(a, b), owen_scramble(a, b));
         results[1] = vec4<u32>(sobol_second_reversed(a), sobol_2d_bits(a, b), bitcast<u32>(unit_from_bits(a)));",
        [Bits, Bits],
        0,
        |row| [[words(row, 1), words(row.rotate_left(3), 2), 0, 0]],
        |[[a, b, ..]]| {
            let UVec2 { x, y } = sobol_2d_bits(a, b);
            [
                [hash_u32(a), hash_combine(a, b), laine_karras(a, b), owen_scramble(a, b)],
                [sobol_second_reversed(a), x, y, unit_from_bits(a).to_bits()],
            ]
        },
    );
}

#[test]
fn sobol_points_are_the_same_bits() {
    agree(
        RNG,
        "results[0] = vec4<u32>(bitcast<vec2<u32>>(sobol_2d(inputs[0].x, inputs[0].y)), 0u, 0u);",
        [Bits],
        0,
        |row| [[row % 512, words(row, 3), 0, 0]],
        |[[index, key, ..]]| {
            let point = sobol_2d(index, key);
            [[point.x.to_bits(), point.y.to_bits(), 0, 0]]
        },
    );
}

/// A scrambling with a shifted dimension must not pass for the right one.
#[test]
#[should_panic(expected = "on the GPU")]
fn a_shifted_dimension_is_rejected() {
    agree(
        RNG,
        "results[0].x = bitcast<u32>(sobol_2d(inputs[0].x, inputs[0].y + 1u).x);",
        [Bits],
        0,
        |row| [[row % 512, words(row, 3), 0, 0]],
        |[[index, key, ..]]| [[sobol_2d(index, key).x.to_bits(), 0, 0, 0]],
    );
}

#[test]
fn elementary_functions_are_the_same_bits() {
    agree(
        &["math/elementary.wgsl"],
        "let x = f32_at(0u, 0u);
         results[0] = float_lane(vec4<f32>(log2_poly(x), exp2_poly(f32_at(0u, 1u)), power(f32_at(0u, 2u), f32_at(0u, 3u)),
             power(x, 0.0)));",
        [Floats],
        0,
        |row| {
            let any = f32::MIN_POSITIVE.log2() + unit(row, 1) * 250.0;
            let base = if row.is_multiple_of(32) { 0.0 } else { unit(row, 2) };
            let exponent = if row.is_multiple_of(33) { 0.0 } else { (unit(row, 3) * 12.0).exp2() - 1.0 };
            [floats([any.exp2(), unit(row, 4) * 300.0 - 150.0, base, exponent])]
        },
        |[lane]| {
            let [x, e, base, exponent] = lane.map(f32::from_bits);
            [floats([log2_poly(x), exp2_poly(e), power(base, exponent), power(x, 0.0)])]
        },
    );
}

#[test]
fn frames_and_glossy_directions_agree() {
    agree(
        &["math/elementary.wgsl", "math/sampling.wgsl"],
        "let n = vec3_at(0u); let xi = floats_at(1u).xy;
         let basis = orthonormal_basis(n);
         results[0] = float_lane(vec4<f32>(basis.tangent, 0.0));
         results[1] = float_lane(vec4<f32>(basis.bitangent, 0.0));
         results[2] = float_lane(vec4<f32>(sample_glossy(n, f32_at(1u, 2u), xi), 0.0));
         results[3] = float_lane(vec4<f32>(keep_above(vec3_at(2u), n), 0.0));",
        [Floats; 4],
        0,
        |row| {
            let xi = floats([unit(row, 5), unit(row, 6), unit(row, 7) * 2.0, 0.0]);
            [vec3_lane(direction(row, 1), 0.0), xi, vec3_lane(direction(row + 1, 3), 0.0)]
        },
        |[n, xi, d]| {
            let basis = orthonormal_basis(vec3(n));
            let glossy = sample_glossy(vec3(n), float(xi, 2), Vec2::new(float(xi, 0), float(xi, 1)));
            [basis.tangent, basis.bitangent, glossy, keep_above(vec3(d), vec3(n))].map(|v| vec3_lane(v, 0.0))
        },
    );
}

/// The driver's sine and cosine are good to 2^-22 of 1, not to the last bit: compared on a grid of that size.
#[test]
fn cone_directions_agree() {
    let grid = |v: Vec3| [v.x, v.y, v.z].map(|x| ((x + 1.0) * 65536.0).round() as u32);
    let inputs: Vec<[Lane; 2]> = (0..ROWS)
        .map(|row| {
            let one_minus_cos = if row.is_multiple_of(2) { 2.0 * unit(row, 2) } else { 1e-4 * unit(row, 2) };
            [vec3_lane(direction(row, 1), one_minus_cos), floats([unit(row, 3), unit(row, 4), 0.0, 0.0])]
        })
        .collect();
    let table = FunctionTable::new(
        &["math/elementary.wgsl", "math/sampling.wgsl"],
        "results[0] = float_lane(vec4<f32>(sample_cone(vec3_at(0u), f32_at(0u, 3u), floats_at(1u).xy), 0.0));",
    );
    let gpu: Vec<[Lane; 1]> = table.evaluate(&inputs);
    for (input, [found]) in inputs.iter().zip(gpu) {
        let xi = Vec2::new(float(input[1], 0), float(input[1], 1));
        let expected = sample_cone(vec3(input[0]), float(input[0], 3), xi);
        let apart = grid(vec3(found)).into_iter().zip(grid(expected)).map(|(a, b)| a.abs_diff(b)).max();
        assert!(apart <= Some(1), "{input:?}: {} on the GPU, {expected} on the CPU", vec3(found));
    }
}

const SHADING: &[&str] = &["types.wgsl", "bindings.wgsl", "math/elementary.wgsl", "shading/material.wgsl"];

#[test]
fn snell_and_schlick_agree() {
    agree(
        SHADING,
        "let n1 = f32_at(0u, 3u); let n2 = f32_at(1u, 3u);
         let r = refract_direction(vec3_at(0u), vec3_at(1u), n1, n2);
         // The direction says nothing under total reflection.
         results[0] = float_lane(select(vec4<f32>(r.direction, 0.0), vec4<f32>(0.0), r.total));
         results[1] = float_lane(vec4<f32>(r.cos_incident, r.cos_refracted,
             fresnel_schlick(n1, n2, r.cos_incident, r.cos_refracted), select(0.0, 1.0, r.total)));",
        [Floats; 2],
        0,
        |row| {
            let n = direction(row, 1);
            let mut d = direction(row.wrapping_mul(7) + 1, 2);
            if d.dot(n) > 0.0 {
                d = -d;
            }
            // Every ninth ray grazes, every tenth falls straight.
            if row.is_multiple_of(9) {
                d = (d - (d.dot(n) + 1e-4) * n).normalize();
            } else if row.is_multiple_of(10) {
                d = -n;
            }
            let [n1, n2] =
                if row.is_multiple_of(5) { [1.33, 1.33] } else { [1.0 + unit(row, 4) * 1.5, 1.0 + unit(row, 5)] };
            [vec3_lane(d, n1), vec3_lane(n, n2)]
        },
        |[d, n]| {
            let (n1, n2) = (float(d, 3), float(n, 3));
            let r = refract_direction(vec3(d), vec3(n), n1, n2);
            let direction = if r.total { Vec3::ZERO } else { r.direction };
            let schlick = fresnel_schlick(n1, n2, r.cos_incident, r.cos_refracted);
            let total = if r.total { 1.0 } else { 0.0 };
            [vec3_lane(direction, 0.0), floats([r.cos_incident, r.cos_refracted, schlick, total])]
        },
    );
}

const PHONG_BODY: &str = "
    var material: Material;
    material.diffuse = vec3_at(3u); material.specular = vec3_at(4u); material.shininess = f32_at(3u, 3u);
    results[0] = float_lane(vec4<f32>(phong(material, vec3_at(0u), vec3_at(1u), vec3_at(2u), f32_at(4u, 3u) > 0.5), 0.0));";

fn phong_row(row: u32) -> [Lane; 5] {
    let colour = |salt: u32| Vec3::new(unit(row, salt), unit(row, salt + 1), unit(row, salt + 2));
    let n = direction(row, 1);
    let l = if row.is_multiple_of(11) { n } else { direction(row + 5, 2) };
    // A viewer in the mirror direction, another at the grazing edge, the others anywhere.
    let v = if row.is_multiple_of(7) { 2.0 * n.dot(l) * n - l } else { direction(row + 9, 3) };
    let shininess = if row.is_multiple_of(13) { 0.0 } else { (unit(row, 4) * 10.0).exp2() };
    [
        vec3_lane(n, 0.0),
        vec3_lane(l, 0.0),
        vec3_lane(v, 0.0),
        vec3_lane(colour(10), shininess),
        vec3_lane(colour(20), (row % 2) as f32),
    ]
}

fn phong_twin(input: [Lane; 5], flip: f32) -> [Lane; 1] {
    let [n, l, v, diffuse, specular] = input;
    let material = Material {
        diffuse: vec3(diffuse),
        shininess: float(diffuse, 3),
        specular: vec3(specular),
        ..Material::default()
    };
    [vec3_lane(phong(&material, flip * vec3(n), vec3(l), vec3(v), float(specular, 3) > 0.5), 0.0)]
}

#[test]
fn phong_and_blinn_agree() {
    agree(SHADING, PHONG_BODY, [Floats], 0, phong_row, |input| phong_twin(input, 1.0));
}

#[test]
#[should_panic(expected = "on the GPU")]
fn phong_with_a_flipped_normal_is_rejected() {
    agree(SHADING, PHONG_BODY, [Floats], 0, phong_row, |input| phong_twin(input, -1.0));
}

#[test]
fn media_lists_are_the_same_bits() {
    agree(
        SHADING,
        "let media = inputs[0].xy; let medium = inputs[0].z;
         results[0] = vec4<u32>(media_enter(media, medium), media_leave(media, medium));
         results[1].x = u32(media_contains(media, medium));",
        [Bits; 2],
        0,
        |row| {
            let medium = |salt: u32| hash_u32(row ^ salt) % 6;
            [[medium(1) | (medium(2) << 16), medium(3) | (medium(4) << 16), 1 + medium(5), 0]]
        },
        |[[x, y, medium, _]]| {
            let media = UVec2::new(x, y);
            let (inside, outside) = (media_enter(media, medium), media_leave(media, medium));
            [[inside.x, inside.y, outside.x, outside.y], [u32::from(media_contains(media, medium)), 0, 0, 0]]
        },
    );
}

#[test]
fn film_sums_are_the_same_bits() {
    agree(
        &["types.wgsl", "tally.wgsl", "film.wgsl"],
        "let pixel = film_add(FilmPixel(inputs[0], inputs[1]), floats_at(2u));
         results[0] = pixel.low; results[1] = pixel.high; results[2].x = tally.flags;",
        [Bits; 3],
        0,
        |row| {
            let word = |salt: u32| words(row.rotate_left(salt), salt);
            let sample = match row % 16 {
                0 => [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1.0],
                1 => [3000.0, -3000.0, 2047.0, -2047.0],
                2 => [1.5 / 1_048_576.0, 2.5 / 1_048_576.0, -0.5 / 1_048_576.0, -0.0],
                _ => [unit(row, 1), -unit(row, 2), unit(row, 3) * 1000.0, 1e-7],
            };
            [[word(1), word(2), word(3), word(4)], [word(5), word(6), word(7), word(8)], floats(sample)]
        },
        |[low, high, sample]| {
            let mut tally = Tally::default();
            let sum = film_add(FilmPixel { low, high }, Vec4::from_array(sample.map(f32::from_bits)), &mut tally);
            [sum.low, sum.high, [tally.flags, 0, 0, 0]]
        },
    );
}
