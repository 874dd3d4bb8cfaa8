//! What maps do to surfaces as a whole: on both devices alike, and in pictures.

use crate::bump::image_words;
use crate::support::placed::*;
use crate::support::{BOTH, Stage};
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::cpu::geometry::bvh::scene_intersect;
use gpu_trace::cpu::geometry::instance::surface_at;
use gpu_trace::cpu::math::rng::{hash_combine, sobol_2d};
use gpu_trace::cpu::shading::detail::surface_detail;
use gpu_trace::device::{DeviceChoice, open_renderer};
use gpu_trace::film::Film;
use gpu_trace::flatten::{FeatureSet, SceneBuffers};
use gpu_trace::gpu::{Device, DeviceSelector, GpuOptions, GpuRenderer};
use gpu_trace::layout::{Dispatch, MATERIAL_NOISE_BUMP, MATERIAL_TEXTURE_REPLACES, Material};
use gpu_trace::render::{RenderOptions, Unattended, render};
use gpu_trace::renderer::{Renderer, Tally};
use gpu_trace::scene::{self, LightExtent, Shape};
use gpu_trace::shader::{PARTS, Part, Program};
use std::sync::Arc;

/// One ray a pixel; what it meets goes to the film word by word.
const KERNEL: &str = "
@compute @workgroup_size(64)
fn trace(@builtin(workgroup_id) group: vec3<u32>, lane: Lane) {
    let index = group.x * 64u + lane.index;
    if (group.x >= dispatch.block_count || index >= frame.image_size.x * frame.image_size.y) { return; }
    claim_lane(lane);
    let key = hash_combine(frame.seed, index);
    let a = sobol_2d(0u, hash_combine(key, 1u));
    let b = sobol_2d(0u, hash_combine(key, 2u));
    let c = sobol_2d(0u, hash_combine(key, 3u));
    let origin = 8.0 * (vec3<f32>(a.x, a.y, b.x) * 2.0 - 1.0);
    let direction = unit_vector(vec3<f32>(b.y, c.x, c.y) * 2.0 - 1.0);
    let hit = scene_intersect(origin, direction, T_INFINITY);
    var normal = vec3<f32>(0.0);
    var diffuse = vec3<f32>(0.0);
    if (hit.t > 0.0) {
        let surface = surface_detail(hit, surface_at(hit, origin, direction), direction, 0.02 * a.x);
        normal = surface.shading_normal;
        diffuse = surface.diffuse;
    }
    film[index] = FilmPixel(
        vec4<u32>(bitcast<vec3<u32>>(normal), hit.instance), vec4<u32>(bitcast<vec3<u32>>(diffuse), hit.primitive));
}";

#[derive(Clone, Copy, Debug)]
struct Answer {
    met: [u32; 2],
    normal: Vec3,
    diffuse: Vec3,
}

fn gpu_answers(buffers: &Arc<SceneBuffers>) -> Vec<Answer> {
    let device = Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"));
    let shared = PARTS.iter().filter(|part| !part.path.starts_with("shaders/kernels"));
    let parts: Vec<Part> = shared.copied().chain([Part { path: "tests/detail.wgsl", text: KERNEL }]).collect();
    let program = Program::link(&parts).unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = GpuRenderer::with_program(device, GpuOptions::default(), program, "trace");
    let [width, height] = buffers.frame.image_size.to_array();
    let mut film = Film::new(width, height);
    let run = |renderer: &mut GpuRenderer, film: &mut Film| -> gpu_trace::Result<()> {
        renderer.prepare(buffers.clone())?;
        renderer.begin_band(0..height)?;
        let block_count = (width * height).div_ceil(64);
        let dispatch = Dispatch { block_count, tile_stride: 1, portions: 1, band_rows: height, ..Dispatch::default() };
        renderer.submit(&buffers.frame, &[dispatch])?;
        renderer.end_band(film)
    };
    run(&mut renderer, &mut film).unwrap_or_else(|error| panic!("{error}"));
    let answer = |pixel: &[i64; 4]| Answer {
        met: [pixel[3] as u32, (pixel[3] >> 32) as u32],
        normal: Vec3::from_array([0, 1, 2].map(|axis| f32::from_bits(pixel[axis] as u32))),
        diffuse: Vec3::from_array([0, 1, 2].map(|axis| f32::from_bits((pixel[axis] >> 32) as u32))),
    };
    film.pixels.iter().map(answer).collect()
}

fn cpu_answers(buffers: &SceneBuffers) -> Vec<Answer> {
    let scene = bindings(buffers);
    let frame = &buffers.frame;
    (0..frame.image_size.x * frame.image_size.y)
        .map(|index| {
            let key = hash_combine(frame.seed, index);
            let [a, b, c] = [1, 2, 3].map(|dimension| sobol_2d(0, hash_combine(key, dimension)));
            let origin = 8.0 * (Vec3::new(a.x, a.y, b.x) * 2.0 - 1.0);
            let direction = (Vec3::new(b.y, c.x, c.y) * 2.0 - 1.0).normalize();
            let hit = scene_intersect(&scene, origin, direction, 3.0e38, &mut Tally::default());
            let met = [hit.instance, hit.primitive];
            if hit.t < 0.0 {
                return Answer { met, normal: Vec3::ZERO, diffuse: Vec3::ZERO };
            }
            let surface = surface_at(&scene, hit, origin, direction);
            let surface = surface_detail(&scene, hit, surface, direction, 0.02 * a.x);
            Answer { met, normal: surface.shading_normal, diffuse: surface.diffuse }
        })
        .collect()
}

/// Materials of each kind: plain, noise, an image as bump, as colour, and as both.
fn mapped_scene() -> SceneBuffers {
    let mut buffers = flattened(&random_scene(&mut Random(61), 60, true));
    let plain = buffers.materials[0];
    let replaces = plain.flags | MATERIAL_TEXTURE_REPLACES;
    let noise = plain.flags | MATERIAL_NOISE_BUMP;
    buffers.materials = vec![
        plain,
        Material { flags: noise, noise_z: 1.7, ..plain },
        Material { bump: 0, ..plain },
        Material { texture: 0, flags: replaces, ..plain },
        Material { texture: 0, bump: 0, flags: replaces, ..plain },
    ];
    for (material, instance) in (0..5).cycle().zip(&mut buffers.instances) {
        instance.material = material;
    }
    let waves = |x: u32, y: u32| (127.0 + 100.0 * (x as f32 * 0.4).sin() * (y as f32 * 0.3).cos()) as u32;
    buffers.texels = image_words(48, 32, waves);
    buffers.features = FeatureSet::of(&buffers);
    buffers
}

/// Of the rays that meet the same on both, those whose normal or colour differ.
fn differing(gpu: &[Answer], cpu: &[Answer]) -> [usize; 2] {
    let same = gpu.iter().zip(cpu).filter(|(a, b)| a.met == b.met);
    let near = |a: Vec3, b: Vec3| (a - b).length() < 1e-3;
    let different = same.clone().filter(|(a, b)| !near(a.normal, b.normal) || !near(a.diffuse, b.diffuse));
    [different.count(), same.filter(|(_, b)| b.normal != Vec3::ZERO).count()]
}

#[test]
fn maps_do_the_same_on_both_devices() {
    let buffers = Arc::new(mapped_scene());
    let (gpu, cpu) = (gpu_answers(&buffers), cpu_answers(&buffers));
    let [different, hits] = differing(&gpu, &cpu);
    println!("{different} of {hits} hits differ");
    assert!(hits > 1000 && different * 500 <= hits, "{different} of {hits} hits differ");
    // Without their maps, the materials show another picture.
    let mut plain = (*buffers).clone();
    plain.materials = vec![plain.materials[0]; 5];
    let [different, hits] = differing(&gpu, &cpu_answers(&plain));
    assert!(different * 2 > hits, "only {different} of {hits} show their maps");
}

/// White shapes and a lamp; with `extreme`, under the steepest chequers.
fn lit_picture(shapes: &[(Shape, DAffine3)], light: DVec3, extreme: bool, device: &DeviceChoice) -> Film {
    let mut stage = Stage::new(64, 48);
    let white = scene::Material { diffuse: Vec3::ONE, ..scene::Material::default() };
    for (shape, transform) in shapes {
        stage.add(shape.clone(), *transform, white.clone());
    }
    stage.add_light(light, Vec3::ONE, LightExtent::Classic);
    let mut buffers = flattened(&stage.finish());
    if extreme {
        buffers.materials.iter_mut().for_each(|material| material.bump = 0);
        buffers.texels = image_words(64, 64, |x, y| 255 * ((x / 4 + y / 4) % 2));
        buffers.features = FeatureSet::of(&buffers);
    }
    let options = RenderOptions::whole(&buffers);
    let (mut renderer, _) = open_renderer(device, false).unwrap_or_else(|error| panic!("{error}"));
    let rendered = render(Arc::new(buffers), renderer.as_mut(), &options, &mut Unattended);
    rendered.unwrap_or_else(|error| panic!("{error}")).film
}

fn brightness(film: &Film) -> Vec<f32> {
    (0..film.width * film.height).map(|i| film.radiance(i % film.width, i / film.width)[0]).collect()
}

/// Where the eye's lamp lights the smooth shapes, the bumpy ones are at least half as bright.
#[test]
fn pictures_have_no_black_spots() {
    let turned = DAffine3::from_rotation_x(0.5) * DAffine3::from_rotation_z(0.4);
    let placed = |x: f64, y: f64, scale: DVec3| {
        DAffine3::from_translation(DVec3::new(x, y, -5.0)) * turned * DAffine3::from_scale(scale)
    };
    let shapes = [
        (Shape::Sphere, placed(-1.8, 0.8, DVec3::ONE)),
        (Shape::Cube, placed(0.6, 0.6, DVec3::new(-1.2, 1.2, 1.2))),
        (Shape::Torus { major: 1.0, minor: 0.4 }, placed(2.2, 1.0, DVec3::new(0.7, 1.0, 1.0))),
        // From inside.
        (Shape::Sphere, DAffine3::from_scale(DVec3::splat(20.0))),
        // Towards the horizon.
        (Shape::Plane, DAffine3::from_translation(DVec3::NEG_Y)),
    ];
    for device in &BOTH {
        let picture = |extreme| brightness(&lit_picture(&shapes, DVec3::ZERO, extreme, device));
        let (smooth, bumpy) = (picture(false), picture(true));
        let lit = smooth.iter().filter(|value| **value > 0.02).count();
        let changed = smooth.iter().zip(&bumpy).filter(|(a, b)| (**a - **b).abs() > 0.02).count();
        let dark = smooth.iter().zip(&bumpy).filter(|(a, b)| **a > 0.02 && **b < 0.48 * **a).count();
        println!("{device:?}: {lit} lit, {changed} changed, {dark} dark");
        assert!(lit > 2000 && changed * 10 > lit, "{device:?}: {lit} lit, {changed} changed");
        assert_eq!(dark, 0, "{device:?}");
    }
}

/// A lamp under the floor lights nothing above it, however its normals lean.
#[test]
fn no_light_comes_from_below_the_true_surface() {
    let floor = [(Shape::Plane, DAffine3::from_translation(DVec3::NEG_Y))];
    let below = DVec3::new(0.0, -1.4, -4.0);
    for device in &BOTH {
        let sum = |light| brightness(&lit_picture(&floor, light, true, device)).iter().sum::<f32>();
        assert_eq!(sum(below), 0.0, "{device:?}");
        assert!(sum(DVec3::new(0.0, -0.6, -4.0)) > 10.0, "{device:?}: a lamp above the floor lights it");
    }
}
