//! The GPU renderer against the CPU renderer, scene by scene: the same samples must give the same picture.

use crate::support::{Stage, paint, render_whole, render_with};
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::device::DeviceChoice;
use gpu_trace::film::{Comparison, Film, compare_images};
use gpu_trace::flatten::flatten;
use gpu_trace::gpu::{Device, DeviceKind, DeviceSelector, GpuOptions, GpuRenderer};
use gpu_trace::render::{RenderOptions, Unattended, render};
use gpu_trace::scene::{LightExtent, Material, Scene, Shape};
use gpu_trace::script::{ScriptOptions, load_scene};
use gpu_trace::shader::{MemoryAccess, Program, RENDER_ENTRY_POINT};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Pictures of the scenes are rendered this wide here, with this many camera samples.
const WIDTH: u32 = 200;
const CAMERA_SAMPLES: u32 = 4;

fn scene_files() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = ["scenes", "scenes/bench", "scenes/bench/convergence"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).expect("the tests run in the project's folder"))
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "lua"))
        .collect();
    files.sort();
    assert!(files.len() >= 14, "only {} scenes found", files.len());
    files
}

/// The scenes of a file at test size, with all their shadow and glossy rays.
fn reduced_scenes(file: &Path) -> Vec<Scene> {
    let mut scenes =
        load_scene(file, &ScriptOptions::default()).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    assert!(!scenes.is_empty(), "{} renders nothing", file.display());
    for scene in &mut scenes {
        let [width, height] = scene.size;
        if width > WIDTH {
            scene.size = [WIDTH, (height * WIDTH / width).max(1)];
        }
        scene.sampling.camera = scene.sampling.camera.min(CAMERA_SAMPLES);
    }
    scenes
}

pub fn compare(a: &Film, b: &Film, scene: &Scene) -> Comparison {
    let resolve = |film: &Film| film.resolve(scene.transfer, false);
    compare_images(&resolve(a), &resolve(b)).unwrap_or_else(|error| panic!("{error}"))
}

/// What counts as the same picture: FLIP at most 0.002, at most 0.1 % of the pixels off by more than 2/255.
pub fn agrees(comparison: &Comparison) -> bool {
    comparison.flip_mean <= 0.002 && comparison.differing_share <= 0.001
}

#[test]
fn every_scene_looks_the_same_on_both_devices() {
    for file in scene_files() {
        for scene in reduced_scenes(&file) {
            let gpu = render_whole(&scene, &DeviceChoice::Gpu);
            let cpu = render_whole(&scene, &DeviceChoice::Cpu);
            let comparison = compare(&gpu.film, &cpu.film, &scene);
            println!("{}: {comparison}; {} rays", file.display(), gpu.tally.total_rays());
            assert!(agrees(&comparison), "{}: {comparison}", file.display());
            // The trees of rays are the same but for a few choices that fall the other way by a rounding.
            for (gpu, cpu) in gpu.tally.rays.into_iter().zip(cpu.tally.rays) {
                assert!(gpu.abs_diff(cpu) <= cpu / 1000 + 10, "{}: {gpu} rays and {cpu}", file.display());
            }
        }
    }
}

/// A scene with everything that splits and chooses: glossy and refractive shapes under two area lights, a lens.
fn mixed_stage() -> Stage {
    let mut stage = Stage::new(72, 50);
    stage.scene.camera.lens_edge = 0.05;
    stage.scene.camera.focus_distance = 4.0;
    stage.scene.ambient = Vec3::splat(0.2);
    stage.scene.background.top = Vec3::new(0.2, 0.4, 0.8);
    stage.scene.sampling.camera = 4;
    stage.scene.sampling.shadow = 5;
    stage.scene.sampling.glossy = 6;
    let glass = Material { ior: Some(1.5), reflection: 1.0, diffuse: Vec3::ZERO, ..Material::default() };
    let brushed = Material { reflection: 0.7, glossy: 0.3, ..paint(0.3, 0.2, 0.1) };
    let place = |x: f64, y: f64, z: f64| DAffine3::from_translation(DVec3::new(x, y, z));
    stage.add(Shape::Plane, place(0.0, -1.0, 0.0), Material { specular: Vec3::splat(0.4), ..paint(0.6, 0.6, 0.5) });
    stage.add(Shape::Sphere, place(-1.2, 0.0, -4.0), glass.clone());
    stage.add(Shape::Torus { major: 0.8, minor: 0.3 }, place(1.2, -0.6, -4.0), brushed.clone());
    stage.add(Shape::Cone, place(0.0, 0.6, -6.0) * DAffine3::from_scale(DVec3::new(1.0, 1.6, 0.7)), brushed);
    stage.add(Shape::Cylinder, place(2.4, 0.0, -6.0) * DAffine3::from_scale(DVec3::new(-0.5, 1.0, 0.5)), glass);
    stage.add_light(DVec3::new(-3.0, 5.0, 0.0), Vec3::splat(0.6), LightExtent::Classic);
    stage.add_light(DVec3::new(4.0, 4.0, -2.0), Vec3::splat(0.4), LightExtent::Sphere { radius: 0.7 });
    stage
}

/// Software devices are given the last access that they support; what other devices are given has to do the same.
#[test]
fn every_access_to_memory_gives_the_identical_film() {
    let device = Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"));
    let supported = MemoryAccess::ALL.into_iter().filter(|&access| device.supports(access)).collect::<Vec<_>>();
    assert!(supported.contains(&MemoryAccess::Words) && supported.contains(&device.memory_access()));
    if device.description().kind == DeviceKind::Software {
        assert_eq!(supported.last(), Some(&device.memory_access()));
    }
    // Lanes hand nodes on to each other only where there are few meshes.
    let files = [("scenes/texture.lua", false), ("scenes/waterfall.lua", true), ("scenes/cylinder-torus.lua", false)];
    for (file, has_many_meshes) in files {
        let mut scene = reduced_scenes(Path::new(file)).swap_remove(0);
        scene.size = [64, 64 * scene.size[1] / scene.size[0]];
        let buffers = Arc::new(flatten(&scene).unwrap_or_else(|error| panic!("{error}")));
        assert_eq!(buffers.features.many_meshes, has_many_meshes, "{file}");
        let outcome = |access: MemoryAccess| {
            let program = Program::renderer(access, &[]).unwrap_or_else(|error| panic!("{error}"));
            let options = GpuOptions { checked: false };
            let mut renderer = GpuRenderer::with_program(device.clone(), options, program, RENDER_ENTRY_POINT);
            let options = RenderOptions::whole(&buffers);
            render(buffers.clone(), &mut renderer, &options, &mut Unattended).unwrap_or_else(|error| panic!("{error}"))
        };
        let words = outcome(MemoryAccess::Words);
        assert!(words.film.pixels.iter().any(|pixel| pixel[0] > 0), "{file}: the picture is black");
        for &access in supported.iter().filter(|&&access| access != MemoryAccess::Words) {
            let other = outcome(access);
            assert!(words.film == other.film && words.tally == other.tally, "{file} {access:?}");
        }
    }
}

#[test]
fn a_flipped_normal_is_rejected() {
    let scene = mixed_stage().finish();
    let mut wrong = mixed_stage();
    // A mirrored light is what a flipped normal looks like from the picture's side.
    wrong.scene.lights[0].position.x *= -1.0;
    let right = render_whole(&scene, &DeviceChoice::Gpu);
    let wrong = render_whole(&wrong.finish(), &DeviceChoice::Cpu);
    assert!(!agrees(&compare(&right.film, &wrong.film, &scene)));
}

#[test]
fn a_shifted_seed_is_rejected() {
    let scene = mixed_stage().finish();
    let mut shifted = scene.clone();
    shifted.sampling.seed += 1;
    let right = render_whole(&scene, &DeviceChoice::Gpu);
    let wrong = render_whole(&shifted, &DeviceChoice::Cpu);
    assert!(!agrees(&compare(&right.film, &wrong.film, &scene)));
}

#[test]
fn tiles_and_batches_give_the_identical_film() {
    let scene = mixed_stage().finish();
    for device in [DeviceChoice::Gpu, DeviceChoice::Cpu] {
        let whole = render_whole(&scene, &device).film;
        assert!(whole.pixels.iter().any(|pixel| pixel[0] > 0), "the picture is black");
        for (blocks, pixels) in [(Some(1), None), (Some(7), None), (Some(1000), None), (Some(13), Some(72 * 16))] {
            let parts = render_with(&scene, &device, |options| {
                options.blocks_per_dispatch = blocks;
                options.max_band_pixels = pixels;
            });
            assert!(parts.film == whole, "{device:?}: {blocks:?} blocks in bands of {pixels:?} pixels differ");
        }
    }
}

/// Up to four lights are told apart by constants, more are loaded one by one.
#[test]
fn few_and_many_lights_look_the_same_on_both_devices() {
    let lit = |count: u32| {
        let mut stage = mixed_stage();
        stage.scene.lights.clear();
        for i in 0..count {
            let at = DVec3::new(2.0 * f64::from(i) - 3.0, 4.0, f64::from(i % 2) - 2.0);
            let colour = Vec3::new(0.1 * (i + 1) as f32, 0.3, 0.6 - 0.1 * i as f32);
            let round = LightExtent::Sphere { radius: 0.2 * f64::from(i + 1) };
            stage.add_light(at, colour, if i % 2 == 0 { LightExtent::Classic } else { round });
        }
        stage
    };
    for count in [2, 3, 4, 5] {
        let scene = lit(count).finish();
        let buffers = flatten(&scene).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(buffers.features.many_lights, count > 4);
        let [gpu, cpu] = [DeviceChoice::Gpu, DeviceChoice::Cpu].map(|device| render_whole(&scene, &device).film);
        let comparison = compare(&gpu, &cpu, &scene);
        assert!(agrees(&comparison), "{count} lights: {comparison}");

        // The last light's colour must matter, or its place among the constants would not be seen.
        let mut other = lit(count);
        other.scene.lights[count as usize - 1].colour = Vec3::new(0.6, 0.3, 0.1);
        let other = render_whole(&other.finish(), &DeviceChoice::Cpu).film;
        assert!(!agrees(&compare(&gpu, &other, &scene)), "light {count} of another colour was not noticed");
    }
}

/// However many samples a dispatch takes, the film is the same, and so are the rays.
#[test]
fn samples_taken_together_give_the_identical_film() {
    let mut stage = mixed_stage();
    stage.scene.sampling.camera = 7;
    let scene = stage.finish();
    for device in [DeviceChoice::Gpu, DeviceChoice::Cpu] {
        let with = |count: u32, blocks: Option<u32>| {
            render_with(&scene, &device, |options| {
                options.samples_per_dispatch = Some(count);
                options.blocks_per_dispatch = blocks;
            })
        };
        let single = with(1, None);
        assert!(single.film.pixels.iter().any(|pixel| pixel[0] > 0), "the picture is black");
        for (count, blocks) in [(2, None), (3, Some(5)), (7, Some(1)), (100, None)] {
            let together = with(count, blocks);
            assert!(together.film == single.film, "{device:?}: {count} samples at a time, {blocks:?} blocks differ");
            assert_eq!(together.tally, single.tally, "{device:?}: {count} samples at a time");
        }
    }
}

#[test]
fn sample_ranges_add_up_to_the_identical_film() {
    let mut stage = mixed_stage();
    stage.scene.sampling.camera = 64;
    stage.scene.size = [40, 24];
    let scene = stage.finish();
    for device in [DeviceChoice::Gpu, DeviceChoice::Cpu] {
        let range =
            |samples: std::ops::Range<u32>| render_with(&scene, &device, |options| options.samples = samples).film;
        let whole = range(0..64);
        let (mut first, second) = (range(0..32), range(32..64));
        assert!(first.pixels != second.pixels, "the halves are the same samples");
        first.merge(&second).unwrap_or_else(|error| panic!("{error}"));
        assert!(first == whole, "{device:?}: 0..32 and 32..64 do not add up to 0..64");
    }
}

/// `tests/run --old-driver` says which driver it has put in place; this fails if another one answers.
#[test]
fn the_expected_driver_answers() {
    let (_, device) =
        gpu_trace::device::open_renderer(&DeviceChoice::Gpu, false).unwrap_or_else(|error| panic!("{error}"));
    println!("{device:?}");
    let expected = std::env::var("GPU_TRACE_EXPECT_DRIVER").unwrap_or_default();
    assert!(device.driver.contains(&expected), "{} answers instead of {expected}", device.driver);
}
