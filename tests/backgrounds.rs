//! Pictures all around the scene: which way each part of them lies, and where they are seen.

use crate::analytic::{assert_picture, worst_error};
use crate::support::{BOTH, Stage, paint};
use glam::{DVec3, Vec3};
use gpu_trace::device::DeviceChoice;
use gpu_trace::scene::{Image, Material, Texels};
use std::sync::Arc;

/// One colour for each half of the rows and quarter of the columns, from the top left.
const PATCHES: [[[f32; 3]; 4]; 2] = [
    [[0.9, 0.1, 0.1], [0.1, 0.9, 0.1], [0.1, 0.1, 0.9], [0.9, 0.9, 0.1]],
    [[0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.4], [0.4, 0.4, 0.0]],
];
const WIDTH: u32 = 64;
const HEIGHT: u32 = 32;

fn patches(float: bool) -> Arc<Image> {
    let colours =
        (0..WIDTH * HEIGHT).map(|i| PATCHES[(i / WIDTH * 2 / HEIGHT) as usize][(i % WIDTH * 4 / WIDTH) as usize]);
    let texels = if float {
        Texels::Rgb32F(colours.map(|colour| colour.map(|c| c * 100.0)).collect())
    } else {
        let byte = |c: f32| (c * 255.0).round() as u8;
        Texels::Rgba8(colours.map(|[r, g, b]| [byte(r), byte(g), byte(b), 255]).collect())
    };
    Arc::new(Image { name: "patches".into(), width: WIDTH, height: HEIGHT, texels })
}

/// Looks that way, narrowly.
fn looking(forward: DVec3, float: bool) -> Stage {
    let mut stage = Stage::new(4, 4);
    stage.scene.camera.forward = forward;
    stage.scene.camera.fov = 2.0;
    stage.scene.background.image = Some(patches(float));
    stage
}

/// The middle of the patch in this row and column: columns run clockwise seen from above, from +z by -x... to +z.
fn towards(row: usize, column: usize) -> DVec3 {
    let elevation = if row == 0 { 0.7_f64 } else { -0.7 };
    // Of u = 0 at +z, 1/4 at -x, 1/2 at -z and 3/4 at +x.
    let turn = std::f64::consts::TAU * ((column as f64 + 0.5) / 4.0);
    DVec3::new(-turn.sin() * elevation.cos(), elevation.sin(), turn.cos() * elevation.cos())
}

fn patch(row: usize, column: usize) -> DVec3 {
    DVec3::from_array(PATCHES[row][column].map(f64::from))
}

#[test]
fn each_part_of_the_picture_lies_where_it_should() {
    for (row, column) in (0..2).flat_map(|row| (0..4).map(move |column| (row, column))) {
        let forward = towards(row, column);
        assert_picture(|| looking(forward, false), 0.003, |_, _, _| Some(patch(row, column)));
        // Nine bits of mantissa.
        assert_picture(|| looking(forward, true), 0.2, |_, _, _| Some(100.0 * patch(row, column)));
    }
}

#[test]
fn a_mirrored_picture_is_rejected() {
    let film = looking(towards(0, 1) * DVec3::new(-1.0, 1.0, 1.0), false).film(&DeviceChoice::Cpu);
    assert!(worst_error(&film, |_, _| Some(patch(0, 1))) > 0.5);
}

#[test]
fn mirrors_and_glass_show_the_picture() {
    let mirror = Material { reflection: 1.0, ..paint(0.0, 0.0, 0.0) };
    let clear = Material { ior: Some(1.0), ..paint(0.0, 0.0, 0.0) };
    let forward = towards(0, 1);
    for (material, seen) in [(mirror, (0, 2)), (clear, (0, 1))] {
        let build = || {
            let mut stage = looking(forward, false);
            // Its face across x turns the direction over in x.
            stage.add_box(DVec3::new(-9.0, -50.0, -50.0), DVec3::new(-3.0, 50.0, 50.0), material.clone());
            // Camera rays that meet something are not cut out of a transparent picture.
            stage.scene.background.transparent = true;
            stage
        };
        assert_picture(build, 0.003, |_, _, _| Some(patch(seen.0, seen.1)));
    }
}

#[test]
fn transparent_pictures_are_empty_where_nothing_is_met() {
    for device in &BOTH {
        let mut stage = looking(DVec3::X, false);
        stage.scene.background.transparent = true;
        let film = stage.film(device);
        assert_eq!(film.radiance(1, 1), [0.0; 4], "{device:?}");
        assert_eq!(looking(DVec3::X, false).film(device).radiance(1, 1)[3], 1.0, "{device:?}");
    }
}

#[test]
fn gradients_run_from_bottom_to_top() {
    let build = || {
        let mut stage = Stage::new(4, 32);
        stage.scene.background.bottom = Vec3::new(1.0, 0.0, 0.25);
        stage.scene.background.top = Vec3::new(0.0, 1.0, 0.25);
        stage
    };
    assert_picture(build, 1e-5, |scene, x, y| {
        let share = 0.5 + 0.5 * crate::analytic::centre_direction(scene, x, y).y;
        Some(DVec3::new(1.0 - share, share, 0.25))
    });
}
