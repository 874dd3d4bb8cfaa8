//! Single rays through whole scenes: what the GPU's traversal meets against what the CPU's does. The rays start
//! anywhere in the scene and go anywhere, so that they meet insides, edges and grazing angles that cameras miss.

use crate::support::{Stage, paint};
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::cpu::bindings::Bindings;
use gpu_trace::cpu::geometry::bvh::{scene_intersect, scene_occluded};
use gpu_trace::cpu::geometry::instance::surface_at;
use gpu_trace::cpu::math::rng::{hash_combine, sobol_2d};
use gpu_trace::film::Film;
use gpu_trace::flatten::{SceneBuffers, flatten};
use gpu_trace::gpu::{Device, DeviceSelector, GpuOptions, GpuRenderer};
use gpu_trace::layout::{Dispatch, NONE};
use gpu_trace::renderer::{Renderer, Tally};
use gpu_trace::scene::{Mesh, Scene, Shape};
use gpu_trace::shader::{PARTS, Part, Program};
use std::sync::Arc;

/// One ray a pixel; the answers go to the film word by word.
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
    let origin = frame.eye + frame.focus_distance * (vec3<f32>(a.x, a.y, b.x) * 2.0 - 1.0);
    let direction = vec3<f32>(b.y, c.x, c.y) * 2.0 - 1.0;
    let hit = scene_intersect(origin, direction, T_INFINITY);
    let occluded = scene_occluded(origin, direction, 1.0);
    var normal = vec3<f32>(0.0);
    if (hit.t > 0.0) { normal = surface_at(hit, origin, direction).shading_normal; }
    film[index] = FilmPixel(
        vec4<u32>(bitcast<u32>(hit.t), hit.instance, hit.primitive, u32(occluded)),
        vec4<u32>(bitcast<vec3<u32>>(normal), 0u));
    if (tally.flags != 0u) { atomicOr(&status.flags, tally.flags); }
}";

#[derive(Clone, Copy, Debug, PartialEq)]
struct Answer {
    t: f32,
    instance: u32,
    primitive: u32,
    occluded: bool,
    normal: Vec3,
}

fn gpu_answers(buffers: &Arc<SceneBuffers>) -> Vec<Answer> {
    let device = Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"));
    let parts: Vec<Part> = PARTS
        .iter()
        .filter(|part| !part.path.starts_with("shaders/kernels"))
        .copied()
        .chain([Part { path: "tests/single_rays.wgsl", text: KERNEL }])
        .collect();
    let program = Program::link(&parts).unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = GpuRenderer::with_program(device, GpuOptions::default(), program, "trace");
    let [width, height] = buffers.frame.image_size.to_array();
    let mut film = Film::new(width, height);
    let run = |renderer: &mut GpuRenderer, film: &mut Film| -> gpu_trace::Result<Tally> {
        renderer.prepare(buffers.clone())?;
        renderer.begin_band(0..height)?;
        let block_count = (width * height).div_ceil(64);
        let dispatch = Dispatch { block_count, tile_stride: 1, portions: 1, band_rows: height, ..Dispatch::default() };
        let tally = renderer.submit(&buffers.frame, &[dispatch])?;
        renderer.end_band(film)?;
        Ok(tally)
    };
    let tally = run(&mut renderer, &mut film).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(tally.flags, 0, "the traversal reported a bound");
    let answer = |pixel: &[i64; 4]| Answer {
        t: f32::from_bits(pixel[0] as u32),
        instance: pixel[1] as u32,
        primitive: pixel[2] as u32,
        occluded: pixel[3] as u32 != 0,
        normal: Vec3::from_array([0, 1, 2].map(|axis| f32::from_bits((pixel[axis] >> 32) as u32))),
    };
    film.pixels.iter().map(answer).collect()
}

fn cpu_answers(buffers: &SceneBuffers) -> Vec<Answer> {
    let scene = Bindings::new(buffers, &buffers.frame);
    let frame = &buffers.frame;
    (0..frame.image_size.x * frame.image_size.y)
        .map(|index| {
            let key = hash_combine(frame.seed, index);
            let [a, b, c] = [1, 2, 3].map(|dimension| sobol_2d(0, hash_combine(key, dimension)));
            let origin = frame.eye + frame.focus_distance * (Vec3::new(a.x, a.y, b.x) * 2.0 - 1.0);
            let direction = Vec3::new(b.y, c.x, c.y) * 2.0 - 1.0;
            let mut tally = Tally::default();
            let hit = scene_intersect(&scene, origin, direction, 3.0e38, &mut tally);
            let occluded = scene_occluded(&scene, origin, direction, 1.0, &mut tally);
            assert_eq!(tally.flags, 0, "the traversal reported a bound");
            let normal = match hit.t > 0.0 {
                true => surface_at(&scene, hit, origin, direction).shading_normal,
                false => Vec3::ZERO,
            };
            Answer { t: hit.t, instance: hit.instance, primitive: hit.primitive, occluded, normal }
        })
        .collect()
}

/// Rays whose answers differ: another shape or triangle, a distance off by more than 1e-5 of itself, a normal by 1e-3.
fn differing(gpu: &[Answer], cpu: &[Answer]) -> usize {
    assert_eq!(gpu.len(), cpu.len());
    let hits = cpu.iter().filter(|answer| answer.t > 0.0).count();
    assert!(hits * 4 > cpu.len(), "only {hits} of {} rays meet anything", cpu.len());
    gpu.iter()
        .zip(cpu)
        .filter(|(a, b)| {
            a.instance != b.instance
                || a.primitive != b.primitive
                || a.occluded != b.occluded
                || (a.t - b.t).abs() > 1e-5 * b.t.abs()
                || (a.normal - b.normal).length() > 1e-3
        })
        .count()
}

/// A bumpy closed mesh with smooth normals on half of its vertices.
fn bumpy_mesh() -> Mesh {
    let (rings, segments) = (24_u32, 48_u32);
    let mut mesh = Mesh { name: "bumpy".into(), ..Mesh::default() };
    for ring in 0..=rings {
        for segment in 0..segments {
            let theta = ring as f32 / rings as f32 * std::f32::consts::PI;
            let phi = segment as f32 / segments as f32 * std::f32::consts::TAU;
            let radius = 1.0 + 0.1 * (5.0 * phi).sin() * (4.0 * theta).sin();
            let direction = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            mesh.positions.push(direction * radius);
            mesh.normals.push(if segment % 2 == 0 { direction } else { Vec3::ZERO });
        }
    }
    for ring in 0..rings {
        for segment in 0..segments {
            let next = (segment + 1) % segments;
            let corner = |r: u32, s: u32| r * segments + s;
            mesh.triangles.push([corner(ring, segment), corner(ring + 1, segment), corner(ring + 1, next)]);
            mesh.triangles.push([corner(ring, segment), corner(ring + 1, next), corner(ring, next)]);
        }
    }
    mesh
}

fn crowded_scene() -> Scene {
    let mut stage = Stage::new(128, 96);
    // The rays start in a box of this half edge about the eye.
    stage.scene.camera.focus_distance = 6.0;
    stage.scene.camera.lens_edge = 0.1;
    let mesh = Arc::new(bumpy_mesh());
    let shapes = [
        Shape::Sphere,
        Shape::Cube,
        Shape::Cylinder,
        Shape::Cone,
        Shape::Torus { major: 1.0, minor: 0.4 },
        Shape::Torus { major: 1.0, minor: 0.05 },
        Shape::Mesh(mesh),
    ];
    for n in 0..140_u32 {
        let random = |dimension| sobol_2d(n, dimension).extend(sobol_2d(n, dimension + 1).x).as_dvec3();
        let place = (random(1) * 2.0 - 1.0) * 5.0;
        let angles = random(3) * std::f64::consts::TAU;
        let mut size = 0.2 + random(5);
        if n % 3 == 0 {
            size.x = -size.x;
        }
        let placed = DAffine3::from_translation(place)
            * DAffine3::from_rotation_x(angles.x)
            * DAffine3::from_rotation_y(angles.y)
            * DAffine3::from_scale(size);
        stage.add(shapes[n as usize % shapes.len()].clone(), placed, paint(0.5, 0.5, 0.5));
    }
    stage.add(Shape::Plane, DAffine3::from_translation(DVec3::NEG_Y * 5.5), paint(0.5, 0.5, 0.5));
    stage.finish()
}

#[test]
fn rays_meet_the_same_on_both_devices() {
    let buffers = Arc::new(flatten(&crowded_scene()).unwrap_or_else(|error| panic!("{error}")));
    let (gpu, cpu) = (gpu_answers(&buffers), cpu_answers(&buffers));
    let count = differing(&gpu, &cpu);
    let identical = gpu.iter().zip(&cpu).filter(|(a, b)| a == b).count();
    println!("{count} of {} rays differ; {identical} are identical to the bit", cpu.len());
    // Rays that graze an edge within rounding may fall to either side of it.
    assert!(count * 2000 <= cpu.len(), "{count} of {} rays differ", cpu.len());
}

#[test]
fn rays_with_a_wrong_twin_are_rejected() {
    let buffers = Arc::new(flatten(&crowded_scene()).unwrap_or_else(|error| panic!("{error}")));
    let right = cpu_answers(&buffers);
    let flipped: Vec<Answer> = right.iter().map(|answer| Answer { normal: -answer.normal, ..*answer }).collect();
    assert!(differing(&flipped, &right) * 4 > right.len());
    // A hierarchy that lost a node: what was behind it is met instead.
    let mut torn = (*buffers).clone();
    let root = torn.nodes.first_mut().expect("a hierarchy");
    root.grid.w -= 1 << 24;
    assert!(differing(&cpu_answers(&torn), &right) * 2000 > right.len());
    assert!(right.iter().any(|answer| answer.instance == NONE), "no ray misses everything");
}
