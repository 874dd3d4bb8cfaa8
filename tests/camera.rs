//! Camera rays: what angle each stands for. (`statistics.rs` has how they fill pixel and lens.)

use crate::support::Stage;
use glam::{DVec3, UVec2};
use gpu_trace::cpu::camera::camera_ray;
use gpu_trace::flatten::flatten;
use gpu_trace::layout::Frame;

const EDGE: u32 = 400;

/// The frame of a wide square picture, one sample in the middle of each pixel.
fn wide_frame() -> Frame {
    let mut stage = Stage::new(EDGE, EDGE);
    stage.scene.camera.fov = 100.0;
    stage.scene.camera.forward = DVec3::new(0.3, -0.4, -1.0);
    flatten(&stage.finish()).unwrap().frame
}

/// The solid angle of a pixel by the directions of its neighbours' rays, sr.
fn solid_angle(frame: &Frame, x: u32, y: u32) -> f64 {
    let direction = |x, y| camera_ray(frame, UVec2::new(x, y), 0).direction.as_dvec3();
    let along = (direction(x + 1, y) - direction(x - 1, y)) / 2.0;
    let down = (direction(x, y + 1) - direction(x, y - 1)) / 2.0;
    along.cross(down).length()
}

/// The worst relative error of a spread's square against the solid angle of its pixel.
fn worst_error(frame: &Frame, spread: impl Fn(u32, u32) -> f32) -> f64 {
    let places = (1..EDGE - 1).step_by(36);
    let pixels = places.clone().flat_map(|x| places.clone().map(move |y| (x, y)));
    pixels.map(|(x, y)| (f64::from(spread(x, y)).powi(2) / solid_angle(frame, x, y) - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn the_spread_of_a_ray_is_the_edge_of_its_pixels_solid_angle() {
    let frame = wide_frame();
    let spread = |x, y| camera_ray(&frame, UVec2::new(x, y), 0).spread;
    // Differences of f32 directions over two pixels (0.01) are off by some 2^-24 / 0.01.
    let error = worst_error(&frame, spread);
    assert!(error < 2e-4, "{error}");
    // One angle for the whole picture, as if the pixels lay on a sphere.
    assert!(worst_error(&frame, |_, _| frame.pixel_spread) > 1.0);
}
