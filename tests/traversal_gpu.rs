//! Single rays through placed shapes: the GPU's hits and surfaces against the CPU's.

use crate::support::placed::*;
use glam::{DAffine3, UVec2, Vec3};
use gpu_trace::cpu::geometry::bvh::{scene_intersect, scene_occluded};
use gpu_trace::cpu::geometry::hit::{Hit, Surface};
use gpu_trace::cpu::geometry::instance::surface_at;
use gpu_trace::film::Film;
use gpu_trace::flatten::SceneBuffers;
use gpu_trace::gpu::{Device, DeviceSelector, GpuOptions, GpuRenderer};
use gpu_trace::layout::Dispatch;
use gpu_trace::renderer::{Renderer, Tally};
use gpu_trace::scene::Shape;
use gpu_trace::shader::{Part, Program};
use std::sync::Arc;

/// Reads rays from `texels`, eight words each, and writes two film pixels for each.
const TRACE_RAYS: &str = "
@compute @workgroup_size(64)
fn trace_rays(@builtin(workgroup_id) group: vec3<u32>, lane: Lane) {
    if (group.x >= dispatch.block_count) { return; }
    let index = group.x * 64u + lane.index;
    if (2u * index + 1u >= frame.image_size.x * dispatch.band_rows) { return; }
    let origin = vec3<f32>(ray_word(index, 0u), ray_word(index, 1u), ray_word(index, 2u));
    let direction = vec3<f32>(ray_word(index, 3u), ray_word(index, 4u), ray_word(index, 5u));
    let t_max = ray_word(index, 6u);
    claim_lane(lane);
    tally = Tally(0u, vec4<u32>(0u));
    let occluded = select(0u, 1u, scene_occluded(origin, direction, t_max));
    let hit = scene_intersect(origin, direction, t_max);
    var surface: Surface;
    if (hit.t > 0.0) {
        surface = surface_at(hit, origin, direction);
    }
    film[2u * index] = FilmPixel(
        vec4<u32>(bitcast<u32>(hit.t), hit.instance, hit.primitive, bitcast<u32>(hit.b1)),
        vec4<u32>(bitcast<u32>(hit.b2), occluded, select(0u, 1u, surface.entering), surface.material));
    film[2u * index + 1u] = FilmPixel(
        vec4<u32>(bitcast<vec3<u32>>(surface.point), tally.flags),
        vec4<u32>(bitcast<vec3<u32>>(surface.shading_normal), 0u));
}

fn ray_word(ray: u32, word: u32) -> f32 {
    return bitcast<f32>(texels[8u * ray + word]);
}
";

/// What one ray finds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Found {
    hit: Hit,
    occluded: bool,
    entering: bool,
    point: Vec3,
    normal: Vec3,
}

fn found_on_gpu(buffers: &SceneBuffers, rays: &[Ray], source: &str) -> Vec<Found> {
    let device = Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"));
    let kernel = Part { path: "tests/traversal.wgsl", text: source };
    let program = Program::renderer(device.memory_access(), &[kernel]).unwrap_or_else(|error| panic!("{error}"));
    let options = GpuOptions { checked: false };
    let mut renderer = GpuRenderer::with_program(device, options, program, "trace_rays");

    let mut buffers = buffers.clone();
    let words = |ray: &Ray| {
        let (o, d) = (ray.origin, ray.direction);
        [o.x, o.y, o.z, d.x, d.y, d.z, ray.t_max, 0.0].map(f32::to_bits)
    };
    let rows = (2 * rays.len()).div_ceil(64).next_multiple_of(8) as u32;
    buffers.texels = rays.iter().flat_map(words).collect();
    buffers.texels.resize(rows as usize / 2 * 64 * 8, 0);
    buffers.frame.image_size = UVec2::new(64, rows);
    let frame = buffers.frame;
    let mut film = Film::new(64, rows);
    renderer.prepare(Arc::new(buffers)).unwrap_or_else(|error| panic!("{error}"));
    renderer.begin_band(0..rows).unwrap();
    let dispatch = Dispatch { band_rows: rows, block_count: rows, tile_stride: 1, portions: 1, ..Dispatch::default() };
    renderer.submit(&frame, &[dispatch]).unwrap();
    renderer.end_band(&mut film).unwrap();

    let low = |pixel: &[i64; 4]| pixel.map(|sum| sum as u32);
    let high = |pixel: &[i64; 4]| pixel.map(|sum| (sum >> 32) as u32);
    let vector =
        |words: [u32; 4]| Vec3::new(f32::from_bits(words[0]), f32::from_bits(words[1]), f32::from_bits(words[2]));
    let found = |pixels: &[[i64; 4]]| {
        let ([t, instance, primitive, b1], [b2, occluded, entering, _]) = (low(&pixels[0]), high(&pixels[0]));
        assert_eq!(low(&pixels[1])[3], 0, "the traversal reported a bound");
        Found {
            hit: Hit { t: f32::from_bits(t), instance, primitive, b1: f32::from_bits(b1), b2: f32::from_bits(b2) },
            occluded: occluded == 1,
            entering: entering == 1,
            point: vector(low(&pixels[1])),
            normal: vector(high(&pixels[1])),
        }
    };
    film.pixels.chunks(2).take(rays.len()).map(found).collect()
}

fn found_on_cpu(buffers: &SceneBuffers, rays: &[Ray]) -> Vec<Found> {
    let scene = bindings(buffers);
    let none = Surface {
        point: Vec3::ZERO,
        geometric_normal: Vec3::ZERO,
        shading_normal: Vec3::ZERO,
        entering: false,
        material: 0,
        diffuse: Vec3::ZERO,
    };
    let found = |ray: &Ray| {
        let mut tally = Tally::default();
        let hit = scene_intersect(&scene, ray.origin, ray.direction, ray.t_max, &mut tally);
        let occluded = scene_occluded(&scene, ray.origin, ray.direction, ray.t_max, &mut tally);
        let surface = if hit.t > 0.0 { surface_at(&scene, hit, ray.origin, ray.direction) } else { none };
        Found { hit, occluded, entering: surface.entering, point: surface.point, normal: surface.shading_normal }
    };
    rays.iter().map(found).collect()
}

/// Whether two renderers found the same: the same primitive to 1e-5 of the distance, or, where surfaces cross or a
/// silhouette is grazed, hits that are that near to each other.
fn alike(a: &Found, b: &Found) -> bool {
    let near = |a: f32, b: f32, size: f32| (a - b).abs() <= 1e-5 * size.max(1e-3);
    let same_side = a.hit.instance != b.hit.instance
        || a.hit.primitive != b.hit.primitive
        || (a.entering == b.entering && (a.normal - b.normal).length() < 1e-3);
    a.occluded == b.occluded
        && near(a.hit.t, b.hit.t, a.hit.t.abs())
        && (a.point - b.point).length() <= 1e-5 * (1.0 + a.point.length())
        && same_side
}

#[test]
fn the_gpu_finds_what_the_cpu_finds() {
    let mut random = Random(17);
    let buffers = flattened(&random_scene(&mut random, 80, true));
    let rays = rays_into(&buffers, &mut random, 8.0, 6000);
    let cpu = found_on_cpu(&buffers, &rays);
    let gpu = found_on_gpu(&buffers, &rays, TRACE_RAYS);
    let identical = cpu.iter().zip(&gpu).filter(|(a, b)| a == b).count();
    let different: Vec<_> = cpu.iter().zip(&gpu).zip(&rays).filter(|((a, b), _)| !alike(a, b)).collect();
    let hits = cpu.iter().filter(|found| found.hit.t > 0.0).count();
    println!("{} rays, {hits} hits: {identical} identical, {} different", rays.len(), different.len());
    assert!(hits > 2000);
    // Grazing rays may meet a silhouette on one and not on the other.
    assert!(different.len() * 2000 <= rays.len(), "{} differ, the first: {:?}", different.len(), different[0]);
    assert!(identical * 10 >= rays.len() * 9, "only {identical} identical");

    // A twin whose rays are turned by a 10,000th must not pass.
    let wrong = TRACE_RAYS.replace(
        "scene_intersect(origin, direction, t_max)",
        "scene_intersect(origin, direction * vec3<f32>(1.0, 1.0, 1.0001), t_max)",
    );
    assert_ne!(wrong, TRACE_RAYS);
    let gpu = found_on_gpu(&buffers, &rays, &wrong);
    let different = cpu.iter().zip(&gpu).filter(|(a, b)| !alike(a, b)).count();
    assert!(different * 10 > hits, "only {different} rays of a wrong twin were noticed");
}

/// The kernel for one mesh has no hierarchy of instances: it must find what the one for all scenes does.
#[test]
fn the_only_mesh_is_found_as_among_others() {
    let mut random = Random(5);
    let ball = (Shape::Mesh(Arc::new(bumpy_ball(12))), random.transform(1.0));
    let buffers = flattened(&scene_of([ball, (Shape::Plane, DAffine3::IDENTITY)]));
    assert!(!buffers.features.instances);
    let rays = rays_into(&buffers, &mut random, 8.0, 3000);
    let mut general = buffers.clone();
    general.features.instances = true;
    let (alone, among) = (found_on_gpu(&buffers, &rays, TRACE_RAYS), found_on_gpu(&general, &rays, TRACE_RAYS));
    let cpu = found_on_cpu(&buffers, &rays);
    let on_mesh = cpu.iter().filter(|found| found.hit.t > 0.0 && found.hit.instance == buffers.frame.plane_count);
    assert!(on_mesh.count() > 500);
    assert_eq!(alone, among);
    let different = cpu.iter().zip(&alone).filter(|(a, b)| !alike(a, b)).count();
    assert!(different * 1000 <= rays.len(), "{different} differ");
}
