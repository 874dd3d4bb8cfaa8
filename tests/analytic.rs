//! Pictures whose every pixel is known: each is computed here in f64 from the laws, and rendered on both devices.

use crate::support::{BOTH, Stage, paint, pixel_direction};
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::device::DeviceChoice;
use gpu_trace::film::Film;
use gpu_trace::scene::{LightExtent, Material, Scene, Shape};

/// Largest difference from `expected` over the pixels for which there is one.
pub fn worst_error(film: &Film, expected: impl Fn(u32, u32) -> Option<DVec3>) -> f64 {
    let mut worst = 0.0_f64;
    let mut compared = 0;
    for y in 0..film.height {
        for x in 0..film.width {
            if let Some(colour) = expected(x, y) {
                let [red, green, blue, _] = film.radiance(x, y).map(f64::from);
                worst = worst.max((DVec3::new(red, green, blue) - colour).abs().max_element());
                compared += 1;
            }
        }
    }
    assert!(compared * 2 > film.width * film.height, "only {compared} pixels have a known colour");
    worst
}

/// Renders on both devices and compares with a tolerance.
pub fn assert_picture(build: impl Fn() -> Stage, tolerance: f64, expected: impl Fn(&Scene, u32, u32) -> Option<DVec3>) {
    let scene = build().finish();
    for device in &BOTH {
        let film = build().film(device);
        let worst = worst_error(&film, |x, y| expected(&scene, x, y));
        println!("{device:?}: worst error {worst:.2e}, allowed {tolerance:.1e}");
        assert!(worst < tolerance, "{device:?}: a pixel is {worst} off, more than {tolerance}");
    }
}

pub fn centre_direction(scene: &Scene, x: u32, y: u32) -> DVec3 {
    pixel_direction(scene, x, y, [0.5, 0.5])
}

const RED: DVec3 = DVec3::new(1.0, 0.0, 0.0);
const GREEN: DVec3 = DVec3::new(0.0, 1.0, 0.0);

fn lambert_stage() -> Stage {
    let mut stage = Stage::new(64, 64);
    let white = Material { diffuse: Vec3::new(0.8, 0.6, 0.4), ..Material::default() };
    stage.add(Shape::Sphere, DAffine3::from_translation(DVec3::new(0.0, 0.0, -3.0)), white);
    stage.add_light(DVec3::new(3e5, 4e5, 2e5), Vec3::ONE, LightExtent::Classic);
    stage
}

/// kd (n.l) at the nearest hit; nothing is said of the limb, where a pixel's middle is within 1e-3 of the edge.
fn lambert_expected(scene: &Scene, x: u32, y: u32) -> Option<DVec3> {
    let d = centre_direction(scene, x, y);
    let centre = DVec3::new(0.0, 0.0, -3.0);
    let b = d.dot(centre);
    let discriminant = b * b - centre.length_squared() + 1.0;
    if discriminant.abs() < 1e-3 {
        return None;
    }
    if discriminant < 0.0 {
        return Some(DVec3::ZERO);
    }
    let n = d * (b - discriminant.sqrt()) - centre;
    let l = (DVec3::new(3e5, 4e5, 2e5) - n - centre).normalize();
    Some(DVec3::new(0.8, 0.6, 0.4) * n.dot(l).max(0.0))
}

#[test]
fn lambert_sphere_under_a_distant_light() {
    assert_picture(lambert_stage, 2e-5, lambert_expected);
}

#[test]
fn a_light_from_elsewhere_is_rejected() {
    let mut stage = lambert_stage();
    stage.scene.lights[0].position.x *= -1.0;
    let scene = lambert_stage().finish();
    assert!(worst_error(&stage.film(&DeviceChoice::Cpu), |x, y| lambert_expected(&scene, x, y)) > 0.1);
}

/// A glass slab tilted across the view shifts what is behind it by Snell's law: the edge between two colours.
fn slab_stage(index: f32) -> Stage {
    let mut stage = Stage::new(96, 32);
    stage.scene.camera.fov = 25.0;
    stage.scene.camera.forward = DVec3::new(0.7, 0.0, -0.7);
    stage.scene.ambient = Vec3::ONE;
    let glass = Material { ior: Some(index), diffuse: Vec3::ZERO, ..Material::default() };
    stage.add_box(DVec3::new(-20.0, -20.0, -4.0), DVec3::new(20.0, 20.0, -2.0), glass);
    stage.add_box(DVec3::new(-50.0, -50.0, -9.0), DVec3::new(4.5, 50.0, -6.0), paint(1.0, 0.0, 0.0));
    stage.add_box(DVec3::new(4.5, -50.0, -9.0), DVec3::new(50.0, 50.0, -6.0), paint(0.0, 1.0, 0.0));
    stage
}

fn slab_expected(scene: &Scene, x: u32, y: u32) -> Option<DVec3> {
    let d = centre_direction(scene, x, y);
    let inside = DVec3::new(d.x / 1.5, d.y / 1.5, 0.0);
    let inside = inside - DVec3::Z * (1.0 - inside.length_squared()).sqrt();
    // From the eye to z = -2, through the glass to -4, on along d to -6.
    let exit = d * (2.0 / -d.z) + inside * (2.0 / -inside.z) + d * (2.0 / -d.z);
    let off_edge = exit.x - 4.5;
    (off_edge.abs() > 1e-3).then_some(if off_edge < 0.0 { RED } else { GREEN })
}

#[test]
fn snell_exit_point_through_a_slab() {
    assert_picture(|| slab_stage(1.5), 1e-5, slab_expected);
}

#[test]
fn a_slab_of_another_index_is_rejected() {
    let scene = slab_stage(1.5).finish();
    let film = slab_stage(1.45).film(&DeviceChoice::Cpu);
    assert!(worst_error(&film, |x, y| slab_expected(&scene, x, y)) > 0.5);
}

/// An eye under water looks up: within the critical angle it sees the sky refracted, beyond it the red bed reflected.
#[test]
fn total_internal_reflection_under_water() {
    let build = || {
        let mut stage = Stage::new(96, 48);
        stage.scene.camera.forward = DVec3::new(0.0, 0.6, -0.8);
        stage.scene.camera.fov = 70.0;
        stage.scene.ambient = Vec3::ONE;
        stage.scene.background.bottom = Vec3::new(0.0, 1.0, 0.0);
        stage.scene.background.top = Vec3::new(0.0, 1.0, 0.0);
        let water = Material { ior: Some(1.33), diffuse: Vec3::ZERO, ..Material::default() };
        stage.add_box(DVec3::new(-90.0, -5.0, -90.0), DVec3::new(90.0, 2.0, 90.0), water);
        stage.add_box(DVec3::new(-80.0, -4.0, -80.0), DVec3::new(80.0, -3.0, 80.0), paint(1.0, 0.0, 0.0));
        stage
    };
    assert_picture(build, 1e-5, |scene, x, y| {
        let d = centre_direction(scene, x, y);
        // Below the horizon of this test the ray meets the bed or the walls first.
        if d.y < 0.1 {
            return None;
        }
        let sine = (1.0 - d.y * d.y).sqrt();
        let beyond = sine * 1.33 - 1.0;
        (beyond.abs() > 1e-4).then_some(if beyond > 0.0 { RED } else { GREEN })
    });
}

/// A mirror at z = -4 shows the wall behind the camera, the other way round.
#[test]
fn mirror_of_a_known_pattern() {
    let build = || {
        let mut stage = Stage::new(64, 48);
        stage.scene.ambient = Vec3::ONE;
        let mirror = Material { diffuse: Vec3::ZERO, reflection: 0.5, ..Material::default() };
        let stood =
            DAffine3::from_translation(DVec3::NEG_Z * 4.0) * DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2);
        stage.add(Shape::Plane, stood, mirror);
        stage.add_box(DVec3::new(-50.0, -50.0, 3.0), DVec3::new(0.7, 50.0, 4.0), paint(1.0, 0.0, 0.0));
        stage.add_box(DVec3::new(0.7, -50.0, 3.0), DVec3::new(50.0, 50.0, 4.0), paint(0.0, 1.0, 0.0));
        stage
    };
    assert_picture(build, 1e-5, |scene, x, y| {
        let d = centre_direction(scene, x, y);
        // 4 forward and 7 back.
        let off_edge = d.x * (11.0 / -d.z) - 0.7;
        (off_edge.abs() > 1e-3).then_some(0.5 * if off_edge < 0.0 { RED } else { GREEN })
    });
}

/// The unit-square light at height 6 behind the edge of a roof at height 2 throws a penumbra 2 / (6 - 2) wide: each
/// pixel is the integral over the part of the light that its floor point sees.
#[test]
fn penumbra_of_the_unit_square_light() {
    let build = || {
        let mut stage = Stage::new(48, 12);
        stage.scene.camera.eye = DVec3::new(0.0, 1.5, 0.0);
        stage.scene.camera.forward = DVec3::NEG_Y;
        stage.scene.camera.up = DVec3::NEG_Z;
        stage.scene.camera.fov = 20.0;
        stage.scene.sampling.shadow = 256;
        stage.add(Shape::Plane, DAffine3::IDENTITY, paint(1.0, 1.0, 1.0));
        stage.add_box(DVec3::new(-30.0, 2.0, -30.0), DVec3::new(0.0, 2.1, 30.0), paint(1.0, 1.0, 1.0));
        stage.add_light(DVec3::new(0.0, 6.0, 0.0), Vec3::ONE, LightExtent::Classic);
        stage
    };
    assert_picture(build, 0.012, |scene, x, y| {
        let d = centre_direction(scene, x, y);
        let floor = scene.camera.eye + d * (1.5 / -d.y);
        const STEPS: usize = 200;
        let mut sum = 0.0;
        for i in 0..STEPS {
            for j in 0..STEPS {
                let light =
                    DVec3::new((i as f64 + 0.5) / STEPS as f64 - 0.5, 6.0, (j as f64 + 0.5) / STEPS as f64 - 0.5);
                let to_light = light - floor;
                // Where the shadow ray passes the roof's two faces; the lower edge is met from the left.
                let clear = [2.0, 2.1].iter().all(|height| (floor + to_light * (height / 6.0)).x > 0.0);
                sum += if clear { to_light.normalize().y } else { 0.0 };
            }
        }
        Some(DVec3::splat(sum / (STEPS * STEPS) as f64))
    });
}

/// An edge at distance 6 seen through a lens 0.5 wide in focus at 3 is blurred over 0.5 * (6 - 3) / 3 world units.
#[test]
fn depth_of_field_blur_of_an_edge() {
    const LENS: f64 = 0.5;
    let build = || {
        let mut stage = Stage::new(48, 8);
        stage.scene.camera.fov = 6.0;
        stage.scene.camera.lens_edge = LENS;
        stage.scene.camera.focus_distance = 3.0;
        stage.scene.sampling.camera = 256;
        stage.scene.ambient = Vec3::ONE;
        stage.add_box(DVec3::new(-9.0, -9.0, -6.0001), DVec3::new(0.1, 9.0, -6.0), paint(1.0, 0.0, 0.0));
        stage
    };
    assert_picture(build, 0.02, |scene, x, y| {
        const STEPS: usize = 400;
        let mut covered = 0.0;
        for i in 0..STEPS {
            let through = pixel_direction(scene, x, y, [(i as f64 + 0.5) / STEPS as f64, 0.5]);
            let focus_x = through.x * (3.0 / -through.z);
            // A ray from lens point u through the focus point reaches 2 * focus - u at twice the distance: red where
            // that is left of the edge.
            let bound = (2.0 * focus_x - 0.1) / LENS;
            covered += 0.5 - bound.clamp(-0.5, 0.5);
        }
        Some(RED * (covered / STEPS as f64))
    });
}
