//! Every sampled distribution against the one it should be, by chi-square. The points are taken one for each key, so
//! that they are independent (within a key they are stratified, which is tested in `cpu::math::rng`).

use crate::support::chi_square_deviate;
use glam::{Vec2, Vec3};
use gpu_trace::cpu::camera::camera_ray;
use gpu_trace::cpu::dimensions::{DIMENSION_CHOICE, DIMENSION_LENS, DIMENSION_LIGHT, DIMENSION_PIXEL};
use gpu_trace::cpu::math::rng::{hash_combine, hash_u32, sobol_2d};
use gpu_trace::cpu::math::sampling::{orthonormal_basis, sample_cone, sample_glossy};
use gpu_trace::cpu::shading::light::sample_light;
use gpu_trace::layout::{Frame, LIGHT_PARALLELOGRAM, LIGHT_SPHERE, Light};

const SAMPLES: u32 = 200_000;
const GRID: usize = 16;

/// Deviate of points of the unit square against uniformity over a grid.
fn uniformity(points: impl Iterator<Item = Vec2>) -> f64 {
    let mut counts = vec![0_u64; GRID * GRID];
    for point in points {
        assert!((0.0..=1.0).contains(&point.x) && (0.0..=1.0).contains(&point.y), "{point} lies outside");
        let cell = (point * GRID as f32).as_uvec2().min(glam::UVec2::splat(GRID as u32 - 1));
        counts[cell.y as usize * GRID + cell.x as usize] += 1;
    }
    let total: u64 = counts.iter().sum();
    chi_square_deviate(&counts, &vec![total as f64 / counts.len() as f64; counts.len()])
}

fn assert_uniform(name: &str, points: impl Iterator<Item = Vec2>) {
    let deviate = uniformity(points);
    assert!(deviate.abs() < 4.0, "{name}: chi-square lies {deviate:.1} standard deviations off");
}

/// One independent point for each of many keys of a dimension.
fn independent(dimension: u32) -> impl Iterator<Item = Vec2> {
    (0..SAMPLES).map(move |n| sobol_2d(n % 64, hash_combine(hash_u32(n), dimension)))
}

#[test]
fn dimensions_are_uniform() {
    for dimension in [DIMENSION_PIXEL, DIMENSION_LENS, DIMENSION_CHOICE, DIMENSION_LIGHT, DIMENSION_LIGHT + 1] {
        assert_uniform(&format!("dimension {dimension}"), independent(dimension));
    }
}

/// Pairs (x of one dimension, x of another) of the same ray fill the square: no dimension repeats another.
#[test]
fn dimensions_are_independent_of_each_other() {
    let dimensions = [DIMENSION_PIXEL, DIMENSION_LENS, DIMENSION_CHOICE, DIMENSION_LIGHT];
    for (i, first) in dimensions.into_iter().enumerate() {
        for second in &dimensions[i + 1..] {
            let pairs = independent(first).zip(independent(*second)).map(|(a, b)| Vec2::new(a.x, b.x));
            assert_uniform(&format!("dimensions {first} and {second}"), pairs);
        }
    }
}

#[test]
fn a_shifted_dimension_is_rejected() {
    let same = independent(DIMENSION_PIXEL).zip(independent(DIMENSION_PIXEL)).map(|(a, b)| Vec2::new(a.x, b.x));
    assert!(uniformity(same) > 100.0);
    let skewed = independent(DIMENSION_PIXEL).map(|xi| Vec2::new(xi.x.powf(1.05), xi.y));
    assert!(uniformity(skewed) > 10.0);
}

#[test]
fn glossy_directions_fill_their_square() {
    for (r, edge) in [(Vec3::new(0.3, -0.5, 0.8), 0.4), (Vec3::new(-0.1, 0.2, -0.99), 1.7)] {
        let r = r.normalize();
        let basis = orthonormal_basis(r);
        let points = independent(3).map(|xi| {
            let direction = sample_glossy(r, edge, xi);
            let on_square = direction / direction.dot(r);
            Vec2::new(on_square.dot(basis.tangent), on_square.dot(basis.bitangent)) / edge + 0.5
        });
        assert_uniform("glossy square", points.map(|point| point.clamp(Vec2::ZERO, Vec2::ONE)));
    }
}

#[test]
fn cone_directions_are_uniform_in_solid_angle() {
    for one_minus_cos in [1e-3, 0.3, 2.0] {
        let axis = Vec3::new(0.6, 0.0, -0.8);
        let basis = orthonormal_basis(axis);
        let points = independent(3).map(|xi| {
            let direction = sample_cone(axis, one_minus_cos, xi);
            assert!((direction.length() - 1.0).abs() < 1e-5);
            // The height on the sphere is uniform (Archimedes), and so is the angle about the axis. The height is
            // taken from the sine, which keeps its precision in a narrow cone.
            let (x, y) = (f64::from(direction.dot(basis.tangent)), f64::from(direction.dot(basis.bitangent)));
            let sine_squared = x * x + y * y;
            let upper = sine_squared / (1.0 + (1.0 - sine_squared).max(0.0).sqrt());
            let height = if direction.dot(axis) >= 0.0 { upper } else { 2.0 - upper };
            let angle = (y.atan2(x) / std::f64::consts::TAU).rem_euclid(1.0);
            Vec2::new((height / f64::from(one_minus_cos)).min(1.0) as f32, angle as f32)
        });
        assert_uniform(&format!("cone of {one_minus_cos}"), points);
    }
}

#[test]
fn light_points_are_uniform() {
    let square = Light {
        position: Vec3::new(1.0, 5.0, -2.0),
        kind: LIGHT_PARALLELOGRAM,
        u: Vec3::new(2.0, 0.0, 0.0),
        v: Vec3::new(0.0, 1.0, 3.0),
        ..Light::default()
    };
    let points = independent(DIMENSION_LIGHT).map(|xi| {
        let offset = sample_light(&square, Vec3::ZERO, xi) - square.position;
        Vec2::new(offset.dot(square.u) / 4.0, offset.dot(square.v) / 10.0) + 0.5
    });
    assert_uniform("parallelogram", points.map(|point| point.clamp(Vec2::ZERO, Vec2::ONE)));

    let ball = Light { kind: LIGHT_SPHERE, radius: 2.0, ..square };
    let from = Vec3::new(4.0, -1.0, 0.5);
    let to_centre = ball.position - from;
    let axis = to_centre.normalize();
    let basis = orthonormal_basis(axis);
    let widest = 1.0 - (1.0 - 4.0 / to_centre.length_squared()).sqrt();
    let points = independent(DIMENSION_LIGHT).map(|xi| {
        let point = sample_light(&ball, from, xi);
        assert!(((point - ball.position).length() - 2.0).abs() < 1e-2, "{point} is not on the ball");
        let direction = (point - from).normalize();
        let angle = direction.dot(basis.bitangent).atan2(direction.dot(basis.tangent)) / std::f32::consts::TAU;
        Vec2::new(((1.0 - direction.dot(axis)) / widest).clamp(0.0, 1.0), angle.rem_euclid(1.0).min(1.0))
    });
    assert_uniform("ball as seen from a point", points);
}

/// Camera rays fill the pixel square and the lens square.
#[test]
fn camera_rays_fill_pixel_and_lens() {
    let frame = Frame {
        right: Vec3::X,
        up: Vec3::Y,
        forward: Vec3::NEG_Z,
        tan_half_fov: 0.5,
        aspect: 1.0,
        focus_distance: 4.0,
        lens_edge: 0.8,
        image_size: glam::UVec2::splat(1000),
        ..Frame::default()
    };
    let rays = || {
        (0..SAMPLES).map(|n| {
            let pixel = glam::UVec2::new(n % 1000, n / 1000);
            (pixel, camera_ray(&frame, pixel, n % 64))
        })
    };
    assert_uniform("lens", rays().map(|(_, ray)| Vec2::new(ray.origin.x, ray.origin.y) / 0.8 + 0.5));
    let in_pixel = rays().map(|(pixel, ray)| {
        let t = 4.0 / -ray.direction.z;
        let focus = (ray.origin + t * ray.direction) / 4.0;
        let on_film = Vec2::new(focus.x, -focus.y) / 0.5;
        ((on_film + 1.0) * 500.0 - pixel.as_vec2()).clamp(Vec2::ZERO, Vec2::ONE)
    });
    assert_uniform("pixel", in_pixel);
}
