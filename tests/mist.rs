//! Pictures of mist against exp(-density * thickness), and against each other.

use crate::analytic::{assert_picture, centre_direction, worst_error};
use crate::mist_tables::mist;
use crate::parity::{agrees, compare};
use crate::support::{BOTH, Stage, paint, render_whole};
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::cpu::shading::medium::MIST_CROSSINGS;
use gpu_trace::device::{DeviceChoice, open_renderer};
use gpu_trace::flatten::flatten;
use gpu_trace::render::{RenderOptions, Unattended, render};
use gpu_trace::scene::{LightExtent, Material, Scene, Shape};
use std::sync::Arc;

const BLACK: Vec3 = Vec3::ZERO;
/// Three standard deviations of the mean of 16,384 choices between 0 and 1.
const TOLERANCE: f64 = 0.012;

/// Looks straight along -z in a narrow view, with many samples.
fn narrow_stage() -> Stage {
    let mut stage = Stage::new(8, 6);
    stage.scene.camera.fov = 20.0;
    stage.scene.sampling.camera = 16_384;
    stage
}

/// A wall at z = `far` that shines with 1.
fn shining_wall(stage: &mut Stage, far: f64) {
    let shining = Material { emission: Vec3::ONE, diffuse: BLACK, ..Material::default() };
    stage.add_box(DVec3::new(-50.0, -50.0, far - 1.0), DVec3::new(50.0, 50.0, far), shining);
}

/// A layer of mist across the view.
fn layer(stage: &mut Stage, far: f64, near: f64, density: f32, colour: Vec3) {
    stage.add_box(DVec3::new(-40.0, -40.0, far), DVec3::new(40.0, 40.0, near), mist(density, colour));
}

/// What passes `thickness` of mist, counted along z.
fn transmitted(scene: &Scene, x: u32, y: u32, density: f64, thickness: f64) -> f64 {
    (-density * thickness / -centre_direction(scene, x, y).z).exp()
}

fn slab_stage(density: f32) -> Stage {
    let mut stage = narrow_stage();
    shining_wall(&mut stage, -8.0);
    layer(&mut stage, -6.0, -3.0, density, BLACK);
    stage
}

#[test]
fn a_slab_transmits_as_beer_and_lambert_say() {
    assert_picture(|| slab_stage(0.4), TOLERANCE, |scene, x, y| Some(DVec3::splat(transmitted(scene, x, y, 0.4, 3.0))));
}

#[test]
fn a_denser_slab_is_rejected() {
    let scene = slab_stage(0.4).finish();
    let film = slab_stage(0.45).film(&DeviceChoice::Cpu);
    let expected = |x, y| Some(DVec3::splat(transmitted(&scene, x, y, 0.4, 3.0)));
    assert!(worst_error(&film, expected) > 2.0 * TOLERANCE);
}

/// What does not pass is lit by the ambient light; a transparent picture covers that share.
#[test]
fn what_scatters_shows_the_mists_colour() {
    let build = || {
        let mut stage = narrow_stage();
        stage.scene.ambient = Vec3::ONE;
        stage.scene.background.transparent = true;
        layer(&mut stage, -6.0, -3.0, 0.4, Vec3::new(0.9, 0.5, 0.1));
        stage
    };
    let expected = |scene: &Scene, x, y| Some(DVec3::new(0.9, 0.5, 0.1) * (1.0 - transmitted(scene, x, y, 0.4, 3.0)));
    assert_picture(build, TOLERANCE, expected);
    let scene = build().finish();
    for device in &BOTH {
        let film = build().film(device);
        for y in 0..film.height {
            for x in 0..film.width {
                let covered = f64::from(film.radiance(x, y)[3]);
                assert!((covered - 1.0 + transmitted(&scene, x, y, 0.4, 3.0)).abs() < TOLERANCE, "{device:?}");
            }
        }
    }
}

#[test]
fn a_camera_in_mist_knows_it() {
    let build = || {
        let mut stage = narrow_stage();
        stage.scene.ambient = Vec3::ONE;
        shining_wall(&mut stage, -5.0);
        stage.add(Shape::Sphere, DAffine3::from_scale(DVec3::splat(20.0)), mist(0.2, Vec3::splat(0.5)));
        stage
    };
    assert_picture(build, TOLERANCE, |scene, x, y| {
        let passed = transmitted(scene, x, y, 0.2, 5.0);
        Some(DVec3::splat(passed + 0.5 * (1.0 - passed)))
    });
}

fn overlapping_stage(green: f32) -> Stage {
    let mut stage = narrow_stage();
    stage.scene.ambient = Vec3::ONE;
    layer(&mut stage, -6.0, -3.0, 0.3, Vec3::X);
    layer(&mut stage, -5.0, -2.0, green, Vec3::Y);
    stage
}

/// Red mist from 3 to 6 and green from 2 to 5: in the common part the densities add, and the colours mix by them.
fn overlapping_expected(scene: &Scene, x: u32, y: u32) -> Option<DVec3> {
    let slant = 1.0 / -centre_direction(scene, x, y).z;
    let mut passed = 1.0;
    let mut colour = DVec3::ZERO;
    for (thickness, red, green) in [(1.0, 0.0, 0.2), (2.0, 0.3, 0.2), (1.0, 0.3, 0.0)] {
        let density: f64 = red + green;
        let through = (-density * thickness * slant).exp();
        colour += passed * (1.0 - through) * DVec3::new(red, green, 0.0) / density;
        passed *= through;
    }
    Some(colour)
}

#[test]
fn densities_add_where_mists_overlap() {
    assert_picture(|| overlapping_stage(0.2), TOLERANCE, overlapping_expected);
    let scene = overlapping_stage(0.2).finish();
    let alone = overlapping_stage(1e-6).film(&DeviceChoice::Cpu);
    assert!(worst_error(&alone, |x, y| overlapping_expected(&scene, x, y)) > 0.1);
}

/// Sides in common: two layers one behind the other, two at the same place, a wall on the last one's far side.
#[test]
fn common_sides_hide_no_boundary() {
    for (eye, size) in [(0.0, 40.0), (300.0, 40.0), (0.0, 0.5)] {
        let build = || {
            let mut stage = narrow_stage();
            stage.scene.camera.eye = DVec3::new(0.0, 0.0, eye);
            stage.scene.camera.fov = if eye > 0.0 { 0.1 } else { 5.0 };
            shining_wall(&mut stage, -6.0);
            for (far, near, density) in [(-4.0, -2.0, 0.2), (-6.0, -4.0, 0.1), (-4.0, -2.0, 0.05), (-6.0, -2.0, 0.02)] {
                let (low, high) = (DVec3::new(-size, -size, far), DVec3::new(size, size, near));
                stage.add_box(low, high, mist(density, BLACK));
            }
            stage
        };
        assert_picture(build, TOLERANCE, |scene, x, y| {
            Some(DVec3::splat(transmitted(scene, x, y, 1.0, 2.0 * 0.2 + 2.0 * 0.1 + 2.0 * 0.05 + 4.0 * 0.02)))
        });
    }
}

/// Glass that does not bend, so that every pixel is known: mist behind it, within it, and ending where it begins.
#[test]
fn mist_and_glass() {
    let clear = || Material { ior: Some(1.0), diffuse: BLACK, ..Material::default() };
    let pane = |stage: &mut Stage, far: f64, near: f64| {
        stage.add_box(DVec3::new(-45.0, -45.0, far), DVec3::new(45.0, 45.0, near), clear());
    };
    for arrangement in 0..4 {
        let build = || {
            let mut stage = narrow_stage();
            shining_wall(&mut stage, -8.0);
            match arrangement {
                0 => pane(&mut stage, -2.0, -1.0),
                1 => pane(&mut stage, -7.0, -2.0),
                2 => pane(&mut stage, -7.0, -5.0),
                _ => pane(&mut stage, -3.0, -1.0),
            }
            layer(&mut stage, -5.0, -3.0, 0.4, BLACK);
            stage
        };
        assert_picture(build, TOLERANCE, |scene, x, y| Some(DVec3::splat(transmitted(scene, x, y, 0.4, 2.0))));
    }
}

/// A mirror shows the mist behind the camera, and the ray to it and back crosses that before it twice.
#[test]
fn mist_in_a_mirror() {
    let build = || {
        let mut stage = narrow_stage();
        shining_wall(&mut stage, -20.0);
        let shining = Material { emission: Vec3::ONE, diffuse: BLACK, ..Material::default() };
        stage.add_box(DVec3::new(-50.0, -50.0, 4.0), DVec3::new(50.0, 50.0, 5.0), shining);
        let mirror = Material { reflection: 1.0, diffuse: BLACK, ..Material::default() };
        stage.add_box(DVec3::new(-45.0, -45.0, -5.0), DVec3::new(45.0, 45.0, -4.0), mirror);
        layer(&mut stage, 1.0, 3.0, 0.2, BLACK);
        layer(&mut stage, -4.0, -2.0, 0.1, BLACK);
        stage
    };
    assert_picture(build, TOLERANCE, |scene, x, y| {
        Some(DVec3::splat(transmitted(scene, x, y, 1.0, 0.2 * 2.0 + 2.0 * 0.1 * 2.0)))
    });
}

/// A ball in the middle of a layer: where it stands, the ray meets mist only as far as its face.
#[test]
fn a_solid_ends_the_way_through_mist() {
    let build = || {
        let mut stage = narrow_stage();
        shining_wall(&mut stage, -8.0);
        layer(&mut stage, -7.0, -2.0, 0.3, BLACK);
        let shining = Material { emission: Vec3::splat(0.5), diffuse: BLACK, ..Material::default() };
        stage.add_box(DVec3::new(-9.0, -9.0, -5.0), DVec3::new(0.0, 9.0, -4.0), shining);
        stage
    };
    assert_picture(build, TOLERANCE, |scene, x, y| {
        let ahead = x < scene.size[0] / 2;
        let passed = transmitted(scene, x, y, 0.3, if ahead { 2.0 } else { 5.0 });
        // The box's right side is seen from within the left half alone.
        Some(DVec3::splat(passed * if ahead { 0.5 } else { 1.0 }))
    });
}

/// The floor seen from below the mist, lit from above it, with `between` in the way of the light.
fn lit_floor(between: Option<Material>) -> Stage {
    let mut stage = Stage::new(32, 24);
    stage.scene.camera.eye = DVec3::new(0.0, 1.0, 0.0);
    stage.scene.camera.forward = DVec3::new(0.0, -0.4, -1.0);
    stage.scene.camera.fov = 30.0;
    stage.add(Shape::Plane, DAffine3::IDENTITY, paint(0.8, 0.8, 0.8));
    stage.add_light(DVec3::new(0.0, 9.0, -3.0), Vec3::ONE, LightExtent::Classic);
    if let Some(material) = between {
        stage.add_box(DVec3::new(-40.0, 4.0, -40.0), DVec3::new(40.0, 7.0, 40.0), material);
    }
    stage
}

#[test]
fn mist_neither_blocks_nor_darkens_light() {
    for device in &BOTH {
        let clear = lit_floor(None).film(device);
        let misty = lit_floor(Some(mist(1.0, Vec3::ONE))).film(device);
        assert!(clear.radiance(16, 20)[0] > 0.5);
        assert!(clear.pixels == misty.pixels, "{device:?}: the mist changes the light on the floor");
        let roofed = lit_floor(Some(paint(1.0, 1.0, 1.0))).film(device);
        assert!(clear.pixels != roofed.pixels, "{device:?}: a roof changes nothing");
    }
}

/// Single scattering of a light that falls off with the square of the distance, with a screen that keeps it from the
/// nearer half of the layer.
#[test]
fn scattered_light_is_the_integral_along_the_ray() {
    const LIGHT: DVec3 = DVec3::new(0.0, 4.0, -5.0);
    let build = || {
        let mut stage = narrow_stage();
        stage.scene.camera.fov = 10.0;
        layer(&mut stage, -8.0, -2.0, 0.25, Vec3::new(1.0, 0.6, 0.3));
        stage.add_box(DVec3::new(-30.0, 1.0, -5.0), DVec3::new(30.0, 30.0, -4.9), paint(0.0, 0.0, 0.0));
        stage.add_light(LIGHT - DVec3::Z * 0.05, Vec3::splat(30.0), LightExtent::Classic);
        stage.scene.lights[0].falloff = Vec3::Z;
        stage
    };
    assert_picture(build, 2.0 * TOLERANCE, |scene, x, y| {
        const STEPS: usize = 4000;
        let d = centre_direction(scene, x, y);
        let slant = 1.0 / -d.z;
        let light = LIGHT - DVec3::Z * 0.05;
        let mut sum = 0.0;
        for i in 0..STEPS {
            let depth = 2.0 + 6.0 * (i as f64 + 0.5) / STEPS as f64;
            let point = d * (depth * slant);
            // The lowest edge of the screen that the way to the light must pass.
            let at_screen = light + (point - light) * ((-5.0 - light.z) / (point.z - light.z));
            let lit = point.z < -5.0 || at_screen.y < 1.0;
            let passed = (-0.25 * (depth - 2.0) * slant).exp();
            sum += if lit { 0.25 * passed * slant * 30.0 / point.distance_squared(light) } else { 0.0 };
        }
        Some(DVec3::new(1.0, 0.6, 0.3) * (sum * 6.0 / STEPS as f64))
    });
}

/// Mist of every kind at once: around the camera, overlapping, in and behind glass, under an area light.
fn mixed_stage() -> Stage {
    let mut stage = Stage::new(72, 48);
    stage.scene.ambient = Vec3::splat(0.3);
    stage.scene.background.top = Vec3::new(0.2, 0.4, 0.8);
    stage.scene.sampling.camera = 16;
    stage.scene.sampling.shadow = 3;
    stage.scene.sampling.glossy = 2;
    let place = |x: f64, y: f64, z: f64| DAffine3::from_translation(DVec3::new(x, y, z));
    let glass = Material { ior: Some(1.5), reflection: 1.0, diffuse: BLACK, ..Material::default() };
    let brushed = Material { reflection: 0.6, glossy: 0.2, ..paint(0.3, 0.3, 0.4) };
    stage.add(Shape::Plane, place(0.0, -1.0, 0.0), brushed);
    stage.add_box(DVec3::new(-9.0, -1.0, -9.0), DVec3::new(9.0, 0.2, 1.0), mist(0.15, Vec3::splat(0.9)));
    stage.add(Shape::Torus { major: 1.0, minor: 0.4 }, place(1.0, 0.0, -4.0), mist(0.9, Vec3::new(0.9, 0.3, 0.2)));
    stage.add(Shape::Cone, place(-1.0, 1.0, -6.0), mist(0.8, Vec3::new(0.2, 0.6, 0.9)));
    stage.add(Shape::Sphere, place(-1.2, 0.0, -4.0), glass);
    let snow = DAffine3::from_scale(DVec3::splat(0.6));
    stage.add(Shape::Sphere, place(-1.2, 0.0, -4.0) * snow, mist(1.0, Vec3::ONE));
    stage.add_light(DVec3::new(-3.0, 5.0, 0.0), Vec3::splat(0.6), LightExtent::Classic);
    stage
}

#[test]
fn mist_looks_the_same_on_both_devices() {
    let scene = mixed_stage().finish();
    let gpu = render_whole(&scene, &DeviceChoice::Gpu);
    let cpu = render_whole(&scene, &DeviceChoice::Cpu);
    let comparison = compare(&gpu.film, &cpu.film, &scene);
    println!("{comparison}");
    assert!(agrees(&comparison), "{comparison}");
    let mut shifted = scene.clone();
    shifted.sampling.seed += 1;
    let wrong = render_whole(&shifted, &DeviceChoice::Cpu);
    assert!(!agrees(&compare(&gpu.film, &wrong.film, &scene)), "another seed passes for the same");
}

#[test]
fn too_many_boundaries_of_mist_end_the_picture_with_advice() {
    let sheets = |count: u32| {
        let mut stage = Stage::new(8, 8);
        for i in 0..count {
            let far = -4.0 - 0.1 * f64::from(i);
            layer(&mut stage, far - 0.05, far, 1e-6, BLACK);
        }
        stage.finish()
    };
    for device in &BOTH {
        let outcome = |count| {
            let buffers = Arc::new(flatten(&sheets(count)).unwrap());
            let (mut renderer, _) = open_renderer(device, false).unwrap_or_else(|error| panic!("{error}"));
            let options = RenderOptions::whole(&buffers);
            render(buffers, renderer.as_mut(), &options, &mut Unattended).map(drop)
        };
        let message = outcome(MIST_CROSSINGS / 2 + 8).unwrap_err().to_string();
        assert!(message.contains("boundaries of mist") && message.contains("fewer shapes"), "{device:?}: {message}");
        outcome(MIST_CROSSINGS / 2 - 8).unwrap_or_else(|error| panic!("{device:?}: {error}"));
    }
}

#[test]
fn grazing_rays_leave_boundaries_behind() {
    let stage = || {
        let mut stage = Stage::new(160, 90);
        stage.scene.camera.eye = DVec3::new(0.0, 2.0, 9.0);
        stage.scene.camera.forward = DVec3::new(0.0, -2.0, -9.0);
        stage.scene.camera.fov = 40.0;
        stage.scene.sampling.camera = 16;
        for i in 1..9 {
            let i = f64::from(i);
            let place = DAffine3::from_translation(DVec3::new(0.1 * i, 0.0, -0.05 * i));
            stage.add(Shape::Sphere, place * DAffine3::from_scale(DVec3::splat(2.0 + 0.3 * i)), mist(0.05, BLACK));
        }
        stage.finish()
    };
    for device in &BOTH {
        // Without doubled steps, rays that touch a ball end with an error after 256 crossings of its boundary.
        let film = render_whole(&stage(), device).film;
        assert_eq!(film.samples, 16, "{device:?}");
    }
}
