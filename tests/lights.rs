//! Lights with an extent against integrals over it, lights that are seen, and light from everywhere.

use crate::analytic::{assert_picture, centre_direction, worst_error};
use crate::mist_tables::mist;
use crate::support::{BOTH, Stage, paint};
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::device::DeviceChoice;
use gpu_trace::scene::{LightExtent, Material, Scene, Shape};

/// Closed shapes of the colour `grey` under ambient light of 1 from everywhere.
fn furnace(grey: f32) -> Stage {
    let mut stage = Stage::new(48, 32);
    stage.scene.ambient = Vec3::ONE;
    stage.scene.background.bottom = Vec3::ONE;
    stage.scene.background.top = Vec3::ONE;
    stage.scene.sampling.camera = 4;
    let place = |x: f64, z: f64| DAffine3::from_translation(DVec3::new(x, 0.0, z));
    stage.add(Shape::Sphere, place(-1.0, -4.0), paint(grey, grey, grey));
    stage.add(Shape::Sphere, place(1.2, -4.0), mist(0.8, Vec3::splat(grey)));
    stage.add(Shape::Sphere, place(0.0, -6.0), Material { reflection: 1.0, ..paint(0.0, 0.0, 0.0) });
    stage
}

#[test]
fn white_shapes_vanish_in_a_furnace() {
    for device in &BOTH {
        let film = furnace(1.0).film(device);
        assert_eq!(worst_error(&film, |_, _| Some(DVec3::ONE)), 0.0, "{device:?}");
        assert!(worst_error(&furnace(0.99).film(device), |_, _| Some(DVec3::ONE)) > 0.005);
    }
}

const SQUARE: (DVec3, DVec3) = (DVec3::new(1.6, 0.3, 0.0), DVec3::new(0.4, -0.2, 2.0));
const BALL: f64 = 1.2;
const AT: DVec3 = DVec3::new(0.7, 3.0, -4.5);

/// A white floor under one light.
fn floor_stage(extent: LightExtent, visible: bool) -> Stage {
    let mut stage = Stage::new(24, 16);
    stage.scene.camera.eye = DVec3::new(0.0, 2.0, 0.0);
    stage.scene.camera.forward = DVec3::new(0.0, -0.7, -1.0);
    stage.scene.camera.fov = 40.0;
    stage.scene.sampling.shadow = 2048;
    stage.add(Shape::Plane, DAffine3::IDENTITY, paint(1.0, 1.0, 1.0));
    stage.add_light(AT, Vec3::ONE, extent);
    stage.scene.lights[0].falloff = Vec3::new(0.0, 0.1, 0.1);
    stage.scene.lights[0].visible = visible;
    stage
}

fn floor_point(scene: &Scene, x: u32, y: u32) -> DVec3 {
    let d = centre_direction(scene, x, y);
    scene.camera.eye + d * (scene.camera.eye.y / -d.y)
}

/// What a point of the floor gets from a point of the light.
fn received(floor: DVec3, light: DVec3) -> f64 {
    let way = light - floor;
    let distance = way.length();
    way.y / distance / (0.1 * distance + 0.1 * distance * distance)
}

const STEPS: usize = 60;

fn centres() -> impl Iterator<Item = f64> + Clone {
    (0..STEPS).map(|i| (i as f64 + 0.5) / STEPS as f64)
}

/// The mean over the area of the parallelogram.
fn under_square(scene: &Scene, x: u32, y: u32) -> Option<DVec3> {
    let floor = floor_point(scene, x, y);
    let (u, v) = SQUARE;
    let sum: f64 =
        centres().flat_map(|s| centres().map(move |t| received(floor, AT + u * (s - 0.5) + v * (t - 0.5)))).sum();
    Some(DVec3::splat(sum / (STEPS * STEPS) as f64))
}

/// The mean over the solid angle of the ball.
fn under_ball(scene: &Scene, x: u32, y: u32) -> Option<DVec3> {
    let floor = floor_point(scene, x, y);
    let to_centre = AT - floor;
    let distance = to_centre.length();
    let axis = to_centre / distance;
    let least_cosine = (1.0 - (BALL / distance).powi(2)).sqrt();
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let sum: f64 = centres()
        .flat_map(|s| {
            centres().map(move |t| {
                let cosine = 1.0 - s * (1.0 - least_cosine);
                let (sine, phi) = ((1.0 - cosine * cosine).sqrt(), t * std::f64::consts::TAU);
                let d = cosine * axis + sine * (phi.cos() * tangent + phi.sin() * bitangent);
                let along = d.dot(to_centre);
                let half_chord = (BALL * BALL - distance * distance + along * along).max(0.0).sqrt();
                received(floor, floor + d * (along - half_chord))
            })
        })
        .sum();
    Some(DVec3::splat(sum / (STEPS * STEPS) as f64))
}

fn square() -> LightExtent {
    LightExtent::Parallelogram { u: SQUARE.0, v: SQUARE.1 }
}

/// Also with the light seen, though out of the camera's view: its surface does not shade its own light.
#[test]
fn a_parallelogram_lights_by_its_area() {
    for visible in [false, true] {
        assert_picture(|| floor_stage(square(), visible), 2e-3, under_square);
    }
    let scene = floor_stage(square(), false).finish();
    let turned = LightExtent::Parallelogram { u: 2.0 * SQUARE.0, v: SQUARE.1 };
    let film = floor_stage(turned, false).film(&DeviceChoice::Cpu);
    assert!(worst_error(&film, |x, y| under_square(&scene, x, y)) > 0.01);
}

#[test]
fn a_ball_lights_by_its_solid_angle() {
    for visible in [false, true] {
        assert_picture(|| floor_stage(LightExtent::Sphere { radius: BALL }, visible), 2e-3, under_ball);
    }
    let scene = floor_stage(LightExtent::Sphere { radius: BALL }, false).finish();
    let film = floor_stage(LightExtent::Sphere { radius: 0.5 * BALL }, false).film(&DeviceChoice::Cpu);
    assert!(worst_error(&film, |x, y| under_ball(&scene, x, y)) > 0.01);
}

/// A parallelogram on the left and a ball on the right, before black.
fn seen_stage(visible: bool) -> Stage {
    let mut stage = Stage::new(64, 40);
    let extent = LightExtent::Parallelogram { u: DVec3::new(1.0, 0.5, 0.0), v: DVec3::new(-0.3, 1.2, 0.0) };
    stage.add_light(DVec3::new(-1.0, 0.2, -4.0), Vec3::new(2.0, 0.0, 0.5), extent);
    stage.add_light(DVec3::new(1.1, -0.1, -5.0), Vec3::new(0.0, 3.0, 0.25), LightExtent::Sphere { radius: 0.8 });
    for light in &mut stage.scene.lights {
        light.visible = visible;
    }
    stage
}

fn seen_expected(scene: &Scene, x: u32, y: u32) -> Option<DVec3> {
    let d = centre_direction(scene, x, y);
    let on_plane = d * (4.0 / -d.z) - DVec3::new(-1.0, 0.2, -4.0);
    // Coordinates within the parallelogram, by Cramer's rule.
    let area = 1.0 * 1.2 + 0.3 * 0.5;
    let a = (on_plane.x * 1.2 + on_plane.y * 0.3) / area;
    let b = (on_plane.y * 1.0 - on_plane.x * 0.5) / area;
    let beyond_square = a.abs().max(b.abs()) - 0.5;
    let centre = DVec3::new(1.1, -0.1, -5.0);
    let beyond_ball = centre.cross(d).length() - 0.8;
    if beyond_square.abs() < 1e-4 || beyond_ball.abs() < 1e-4 {
        return None;
    }
    Some(match (beyond_square < 0.0, beyond_ball < 0.0) {
        (true, _) => DVec3::new(2.0, 0.0, 0.5),
        (_, true) => DVec3::new(0.0, 3.0, 0.25),
        _ => DVec3::ZERO,
    })
}

#[test]
fn visible_lights_are_seen_where_they_are() {
    assert_picture(|| seen_stage(true), 1e-6, seen_expected);
    let scene = seen_stage(true).finish();
    let unseen = seen_stage(false).film(&DeviceChoice::Cpu);
    assert!(worst_error(&unseen, |x, y| seen_expected(&scene, x, y)) > 1.0);
}

/// A mirror shows them too.
#[test]
fn visible_lights_are_seen_in_a_mirror() {
    let build = || {
        let mut stage = Stage::new(16, 16);
        stage.scene.camera.fov = 20.0;
        let mirror = Material { reflection: 0.5, ..paint(0.0, 0.0, 0.0) };
        stage.add_box(DVec3::new(-9.0, -9.0, -5.0), DVec3::new(9.0, 9.0, -4.0), mirror);
        let extent = LightExtent::Parallelogram { u: DVec3::X * 40.0, v: DVec3::Y * 40.0 };
        stage.add_light(DVec3::new(0.0, 0.0, 3.0), Vec3::new(1.0, 0.5, 0.25), extent);
        stage.scene.lights[0].visible = true;
        stage
    };
    assert_picture(build, 1e-6, |_, _, _| Some(DVec3::new(0.5, 0.25, 0.125)));
}

/// A visible light in the way of another one's light casts a shadow as any body does.
#[test]
fn visible_lights_shade_other_lights() {
    for visible in [false, true] {
        let build = || {
            let mut stage = Stage::new(8, 8);
            stage.scene.camera.eye = DVec3::Y;
            stage.scene.camera.forward = DVec3::NEG_Y;
            stage.scene.camera.up = DVec3::NEG_Z;
            stage.scene.camera.fov = 20.0;
            stage.add(Shape::Plane, DAffine3::IDENTITY, paint(1.0, 1.0, 1.0));
            stage.add_light(DVec3::Y * 3e6, Vec3::X, LightExtent::Classic);
            stage.add_light(DVec3::Y * 4.0, Vec3::ZERO, LightExtent::Sphere { radius: 1.0 });
            stage.scene.lights[1].visible = visible;
            stage
        };
        let red = if visible { 0.0 } else { 1.0 };
        assert_picture(build, 1e-5, |_, _, _| Some(DVec3::X * red));
    }
}

/// The floor under a point light with a roof between them that the camera doesn't see.
fn roofed_stage(roof: &[(Shape, DAffine3)], casts_shadow: bool) -> Stage {
    let mut stage = floor_stage(LightExtent::Sphere { radius: 0.1 }, false);
    stage.scene.sampling.shadow = 1;
    for (shape, place) in roof {
        stage.add(shape.clone(), *place, Material { casts_shadow, ..paint(0.5, 0.5, 0.5) });
    }
    stage
}

#[test]
fn shadow_rays_pass_what_casts_no_shadow() {
    let at = |scale: f64| {
        DAffine3::from_translation(DVec3::new(0.7, 2.6, -4.5)) * DAffine3::from_scale(DVec3::new(scale, 0.1, scale))
    };
    let roofs = [(Shape::Plane, at(1.0)), (Shape::Sphere, at(30.0)), (Shape::Cylinder, at(30.0))];
    for device in &BOTH {
        let open = roofed_stage(&[], true).film(device);
        assert!(open.pixels.iter().all(|pixel| pixel[0] > 0));
        for roof in roofs.chunks(1) {
            assert_eq!(roofed_stage(roof, false).film(device), open, "{device:?}: {roof:?}");
            let dark = roofed_stage(roof, true).film(device);
            assert!(dark.pixels.iter().all(|pixel| pixel[0] == 0), "{device:?}: {roof:?}");
        }
        // One that casts a shadow beside those that don't.
        let mut mixed = roofed_stage(&roofs[..2], false);
        mixed.add(roofs[2].0.clone(), roofs[2].1, paint(0.5, 0.5, 0.5));
        assert!(mixed.film(device).pixels.iter().all(|pixel| pixel[0] == 0), "{device:?}");
    }
}

#[test]
fn what_casts_no_shadow_is_seen() {
    let material = Material { casts_shadow: false, emission: Vec3::ONE, ..paint(0.0, 0.0, 0.0) };
    for device in &BOTH {
        let mut stage = Stage::new(8, 8);
        (stage.scene.background.bottom, stage.scene.background.top) = (Vec3::ZERO, Vec3::ZERO);
        stage.add(Shape::Sphere, DAffine3::from_translation(DVec3::new(0.0, 0.0, -2.0)), material.clone());
        assert_eq!(stage.film(device).radiance(4, 4)[0], 1.0, "{device:?}");
    }
}
