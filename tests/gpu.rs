//! The GPU renderer's own work, with small kernels in place of the tracer: uploads, dispatches, bands, counters
//! and limits.

use glam::{UVec2, Vec3};
use gpu_trace::Error;
use gpu_trace::blocks::{BlockOrder, TILE_BLOCKS};
use gpu_trace::film::Film;
use gpu_trace::flatten::SceneBuffers;
use gpu_trace::gpu::{Device, DeviceSelector, GpuOptions, GpuRenderer};
use gpu_trace::layout::*;
use gpu_trace::renderer::{Renderer, Tally};
use gpu_trace::shader::{Part, Program, part};
use std::sync::Arc;

const WIDTH: u32 = 37;
const HEIGHT: u32 = 29;

/// Adds known numbers to every pixel's sum and reports known flags and counts.
const PATTERN: &str = "
@compute @workgroup_size(64)
fn pattern(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let place = place_of(group.x);
    if (place >= dispatch.first_block + dispatch.block_count) { return; }
    let block = block_at(place);
    let x = block.x * 8u + lane % 8u;
    let y = block.y * 8u + lane / 8u;
    if (x >= frame.image_size.x || y >= dispatch.band_rows) { return; }
    let index = y * frame.image_size.x + x;
    let row = y + dispatch.band_row;
    // The first is negative, the last carries into the high word at the second sample.
    let low = vec4<u32>(0xffffffffu - x, row, dispatch.sample_index * frame.seed, 0xf0000000u);
    let high = vec4<u32>(0xffffffffu, 0u, 1u, 0u);
    let sum = film[index].low + low;
    film[index].high += high + select(vec4<u32>(0u), vec4<u32>(1u), sum < low);
    film[index].low = sum;
    atomicOr(&status.flags, dispatch.pass_index);
    let kind = x % RAY_KINDS;
    atomicAdd(&status.rays[kind * RAY_SLOTS + index % RAY_SLOTS], row + 1u);
}";

/// The sum that the pattern leaves after the given samples.
fn expected_film(samples: &[u32], seed: u32) -> Film {
    let mut film = Film::new(WIDTH, HEIGHT);
    for (index, pixel) in film.pixels.iter_mut().enumerate() {
        let (x, row) = (index as i64 % i64::from(WIDTH), index as i64 / i64::from(WIDTH));
        for &sample in samples {
            let third = i64::from(sample.wrapping_mul(seed)) + (1 << 32);
            let values = [-1 - x, row, third, 0xf000_0000];
            pixel.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
    }
    film
}

fn open_device() -> Device {
    Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"))
}

fn renderer(device: Device, kernel: &'static str, entry_point: &str, checked: bool) -> GpuRenderer {
    let shared = ["types", "bindings", "memory/words/buffers", "blocks"];
    let shared = shared.map(|name| part(&format!("shaders/{name}.wgsl")).expect("a shared part"));
    let parts = [&shared[..], &[Part { path: "tests/gpu.wgsl", text: kernel }]].concat();
    let program = Program::link(&parts).unwrap_or_else(|error| panic!("{error}"));
    GpuRenderer::with_program(device, GpuOptions { checked }, program, entry_point)
}

fn scene() -> SceneBuffers {
    let frame = Frame { image_size: UVec2::new(WIDTH, HEIGHT), pass_count: 1, seed: 3, ..Frame::default() };
    SceneBuffers { frame, ..SceneBuffers::default() }
}

fn pattern_renderer(checked: bool) -> GpuRenderer {
    let mut renderer = renderer(open_device(), PATTERN, "pattern", checked);
    renderer.prepare(Arc::new(scene())).unwrap();
    renderer
}

/// The runs of `run` blocks that cover a band.
fn runs(rows: std::ops::Range<u32>, run: u32, stride: impl Fn(u32) -> u32, sample: u32) -> Vec<Dispatch> {
    let band_rows = rows.end - rows.start;
    let blocks = BlockOrder::new(WIDTH, band_rows).places();
    let dispatch = |first_block: u32| {
        let block_count = run.min(blocks - first_block);
        Dispatch {
            sample_index: sample,
            sample_count: 1,
            pass_index: 0,
            band_row: rows.start,
            band_rows,
            first_block,
            block_count,
            tile_stride: stride(blocks / TILE_BLOCKS),
            portions: 1 + run % 5,
            takes_work: 0,
            canary_turns: 0,
        }
    };
    (0..blocks).step_by(run as usize).map(dispatch).collect()
}

/// Renders the pattern in bands of `rows` and runs of `run` blocks.
fn pattern_film(renderer: &mut GpuRenderer, rows: u32, run: u32, stride: impl Fn(u32) -> u32, samples: &[u32]) -> Film {
    let mut film = Film::new(WIDTH, HEIGHT);
    for first in (0..HEIGHT).step_by(rows as usize) {
        let band = first..HEIGHT.min(first + rows);
        renderer.begin_band(band.clone()).unwrap();
        for &sample in samples {
            renderer.submit(&scene().frame, &runs(band.clone(), run, &stride, sample)).unwrap();
        }
        renderer.end_band(&mut film).unwrap();
    }
    film
}

#[test]
fn sums_of_every_pixel_come_back_however_the_work_is_cut() {
    let expected = expected_film(&[5, 9], 3);
    for checked in [false, true] {
        let mut renderer = pattern_renderer(checked);
        // A whole picture, bands that divide it unevenly, a row a band; runs of one block, of some, of all.
        for rows in [HEIGHT, 16, 7, 1] {
            for run in [1, 6, 1000] {
                let film = pattern_film(&mut renderer, rows, run, |_| 1, &[5, 9]);
                assert!(film == expected, "checked {checked}, bands of {rows} rows, runs of {run} blocks");
            }
        }
    }
}

#[test]
fn strides_only_change_the_order() {
    // Two tiles: any odd stride.
    let mut renderer = pattern_renderer(false);
    for stride in [1, 3, 7, 21, 1_000_003] {
        let film = pattern_film(&mut renderer, HEIGHT, 32, |_| stride, &[1]);
        assert!(film == expected_film(&[1], 3), "stride {stride}");
    }
}

/// Negative controls: a film from other samples, or from a kernel that is off by one, is not taken for the right one.
#[test]
fn wrong_films_are_rejected() {
    let mut right = pattern_renderer(false);
    assert!(pattern_film(&mut right, 16, 6, |_| 1, &[5, 8]) != expected_film(&[5, 9], 3));
    let shifted = PATTERN.replace("let row = y +", "let row = y + 1u +").leak();
    let mut wrong = renderer(open_device(), shifted, "pattern", false);
    wrong.prepare(Arc::new(scene())).unwrap();
    assert!(pattern_film(&mut wrong, 16, 6, |_| 1, &[5, 9]) != expected_film(&[5, 9], 3));
}

#[test]
fn flags_and_rays_are_those_of_one_submit() {
    let mut renderer = pattern_renderer(false);
    renderer.begin_band(8..HEIGHT).unwrap();
    let mut dispatches = runs(8..HEIGHT, 4, |_| 1, 0);
    dispatches[1].pass_index = STATUS_STACK_FULL;
    dispatches[2].pass_index = STATUS_SATURATED;
    let mut expected = Tally { flags: STATUS_STACK_FULL | STATUS_SATURATED, ..Tally::default() };
    for row in 8..HEIGHT {
        (0..WIDTH).for_each(|x| expected.rays[(x % RAY_KINDS) as usize] += u64::from(row) + 1);
    }
    assert_eq!(renderer.submit(&scene().frame, &dispatches).unwrap(), expected);

    let quiet = runs(8..HEIGHT, 4, |_| 1, 0);
    assert_eq!(renderer.submit(&scene().frame, &quiet).unwrap(), Tally { flags: 0, ..expected });
    assert_eq!(renderer.submit(&scene().frame, &[]).unwrap(), Tally::default());
}

/// Echoes what it sees of uniforms and scene buffers into pixel `sample_index`.
const ECHO: &str = "
@compute @workgroup_size(64)
fn echo(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (group.x >= dispatch.block_count || lane != 0u) { return; }
    let at = dispatch.sample_index;
    film[at].low = vec4<u32>(dispatch.pass_index, dispatch.first_block, dispatch.tile_stride, dispatch.canary_turns);
    film[at].high = vec4<u32>(dispatch.band_row, dispatch.band_rows, dispatch.block_count, frame.seed);
    if (at == 0u) {
        film[0].low = vec4<u32>(arrayLength(&nodes), arrayLength(&instances), arrayLength(&triangles), arrayLength(&materials));
        film[0].high = vec4<u32>(arrayLength(&lights), arrayLength(&texels), texels[2], bitcast<u32>(lights[1].colour.y));
    }
    if (at == 1u) {
        film[1].low = vec4<u32>(nodes[1].z.w, instances[1].root, triangles[1].flags, materials[1].medium);
        film[1].high = bitcast<vec4<u32>>(instances[1].world_from_object[2]);
    }
}";

/// The words of a pixel: low and high of the four channels.
fn words(film: &Film, pixel: usize) -> [u32; 8] {
    let sums = film.pixels[pixel];
    std::array::from_fn(|i| (sums[i % 4] >> (32 * (i / 4))) as u32)
}

#[test]
fn every_dispatch_sees_its_own_parameters_and_the_frame_of_its_submit() {
    let mut renderer = renderer(open_device(), ECHO, "echo", true);
    renderer.prepare(Arc::new(scene())).unwrap();
    renderer.begin_band(3..HEIGHT).unwrap();
    let dispatch = |i: u32| Dispatch {
        sample_index: i,
        sample_count: 1,
        pass_index: 100 + i,
        band_row: 3,
        band_rows: HEIGHT - 3,
        first_block: i % 13,
        block_count: 1 + i % 5,
        portions: 1,
        takes_work: 0,
        tile_stride: 7,
        canary_turns: 1000 + i,
    };
    // More dispatches in one submit than there was room for, then fewer with another frame.
    let (first, second): (Vec<_>, Vec<_>) = ((2..300).map(dispatch).collect(), (300..310).map(dispatch).collect());
    renderer.submit(&scene().frame, &first).unwrap();
    renderer.submit(&Frame { seed: 8, ..scene().frame }, &second).unwrap();
    let mut film = Film::new(WIDTH, HEIGHT);
    renderer.end_band(&mut film).unwrap();
    for (d, seed) in first.iter().map(|d| (d, 3)).chain(second.iter().map(|d| (d, 8))) {
        let pixel = d.sample_index + 3 * WIDTH;
        let expected =
            [d.pass_index, d.first_block, d.tile_stride, d.canary_turns, d.band_row, d.band_rows, d.block_count, seed];
        assert_eq!(words(&film, pixel as usize), expected, "dispatch {}", d.sample_index);
    }
}

#[test]
fn scene_buffers_arrive_and_empty_ones_hold_one_element() {
    let mut renderer = renderer(open_device(), ECHO, "echo", true);
    let mut echo = |scene: SceneBuffers| {
        let frame = scene.frame;
        renderer.prepare(Arc::new(scene)).unwrap();
        renderer.begin_band(0..8).unwrap();
        let dispatch = |sample_index| Dispatch { sample_index, ..runs(0..8, 1, |_| 1, 0)[0] };
        renderer.submit(&frame, &[dispatch(0), dispatch(1)]).unwrap();
        let mut film = Film::new(WIDTH, HEIGHT);
        renderer.end_band(&mut film).unwrap();
        (words(&film, 0), words(&film, 1))
    };
    let mut full = scene();
    full.nodes = vec![Node::default(); 2];
    full.nodes[1].z.w = 11;
    full.instances = vec![Instance::default(); 3];
    full.instances[1].root = 12;
    full.instances[1].world_from_object[2] = glam::Vec4::new(1.0, 2.0, 3.0, 4.0);
    full.triangles = vec![Triangle { flags: 13, ..Triangle::default() }; 4];
    full.materials = vec![Material { medium: 14, ..Material::default() }; 5];
    full.lights = vec![Light { colour: Vec3::new(0.25, 0.5, 0.75), ..Light::default() }; 6];
    full.texels = (0..7).collect();
    let (lengths, values) = echo(full);
    assert_eq!(lengths, [2, 3, 4, 5, 6, 7, 2, 0.5_f32.to_bits()]);
    assert_eq!(values[..4], [11, 12, 13, 14]);
    assert_eq!(values[4..], [1.0_f32, 2.0, 3.0, 4.0].map(f32::to_bits));

    assert_eq!(echo(scene()).0[..6], [1; 6]);
}

#[test]
fn a_scene_larger_than_the_device_binds_is_an_error_that_names_the_limit() {
    const LIMIT: u64 = 1 << 20;
    let device = Device::open_limited(&DeviceSelector::Any, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(device.limits().storage_binding, LIMIT);
    let mut renderer = renderer(device, PATTERN, "pattern", false);
    let with_texels = |count: usize| Arc::new(SceneBuffers { texels: vec![1; count], ..scene() });
    let most = (LIMIT / 4) as usize;
    renderer.prepare(with_texels(most)).unwrap();
    match renderer.prepare(with_texels(most + 1)) {
        Err(Error::Limit { buffer, needed, limit_name, limit, .. }) => {
            assert_eq!((buffer, needed, limit), ("texels", LIMIT + 4, LIMIT));
            assert_eq!(limit_name, "max_storage_buffer_binding_size");
        }
        other => panic!("a limit error was expected: {other:?}"),
    }

    // 2^15 pixels fit; 1000 wide that is 32 rows.
    let frame = Frame { image_size: UVec2::new(1000, 1000), ..scene().frame };
    renderer.prepare(Arc::new(SceneBuffers { frame, ..scene() })).unwrap();
    assert_eq!(renderer.max_band_pixels(), LIMIT / 32);
    renderer.begin_band(968..1000).unwrap();
    match renderer.begin_band(900..933) {
        Err(Error::Limit { needed, limit, .. }) => assert_eq!((needed, limit), (33 * 1000 * 32, LIMIT)),
        other => panic!("a limit error was expected: {other:?}"),
    }
}

/// The kernel runs unchecked, so that the host must not let through what would make it leave its buffers.
#[test]
fn dispatches_that_do_not_fit_the_band_are_refused() {
    let mut renderer = pattern_renderer(false);
    let frame = scene().frame;
    // Two tiles of 16 blocks.
    let right = runs(8..16, 32, |_| 3, 0)[0];
    assert!(renderer.submit(&frame, &[right]).is_err(), "no band was begun");
    renderer.begin_band(8..16).unwrap();
    renderer.submit(&frame, &[right]).unwrap();
    let wrong = [
        Dispatch { band_row: 0, ..right },
        Dispatch { band_rows: 9, ..right },
        Dispatch { band_row: 7, band_rows: u32::MAX, ..right },
        Dispatch { block_count: 33, ..right },
        Dispatch { first_block: 1, ..right },
        Dispatch { first_block: u32::MAX, ..right },
        Dispatch { portions: 0, ..right },
        Dispatch { portions: u32::MAX, ..right },
        Dispatch { tile_stride: 2, ..right },
        Dispatch { tile_stride: 0, ..right },
        Dispatch { tile_stride: 2_147_483_649, ..right },
    ];
    for dispatch in wrong {
        let result = renderer.submit(&frame, &[right, dispatch]);
        assert!(matches!(result, Err(Error::Kernel(_))), "{dispatch:?}: {result:?}");
    }
    let wrong = [
        Frame { image_size: UVec2::new(WIDTH + 1, HEIGHT), ..frame },
        Frame { pass_count: 0, ..frame },
        Frame { plane_count: 1, ..frame },
        Frame { light_count: 1, ..frame },
        Frame { bounded_count: 1, ..frame },
        Frame { mist_count: 1, ..frame },
    ];
    for frame in wrong {
        let result = renderer.submit(&frame, &[right]);
        assert!(matches!(result, Err(Error::Kernel(_))), "{frame:?}: {result:?}");
    }
    assert!(renderer.begin_band(0..HEIGHT + 1).is_err());
    assert!(renderer.begin_band(5..5).is_err());
    assert!(renderer.end_band(&mut Film::new(WIDTH, HEIGHT + 1)).is_err());
    renderer.submit(&frame, &[right]).unwrap();
}

#[test]
fn use_before_prepare_is_an_error() {
    let mut renderer = renderer(open_device(), PATTERN, "pattern", false);
    assert!(matches!(renderer.begin_band(0..1), Err(Error::Kernel(_))));
    assert!(matches!(renderer.submit(&Frame::default(), &[]), Err(Error::Kernel(_))));
    assert!(matches!(renderer.end_band(&mut Film::new(1, 1)), Err(Error::Kernel(_))));
}

#[test]
fn a_kernel_that_the_device_refuses_is_a_shader_error() {
    let mut renderer = renderer(open_device(), PATTERN, "absent", false);
    match renderer.prepare(Arc::new(scene())) {
        Err(Error::Shader(message)) => assert!(message.contains("absent"), "{message}"),
        other => panic!("a shader error was expected: {other:?}"),
    }
}

#[test]
fn a_device_that_is_gone_is_an_error_and_no_panic() {
    let mut renderer = pattern_renderer(false);
    renderer.begin_band(0..8).unwrap();
    let dispatches = runs(0..8, 5, |_| 1, 0);
    renderer.submit(&scene().frame, &dispatches).unwrap();
    renderer.device().close();
    let device_error = |result: Result<(), Error>| match result {
        Err(Error::Device(message)) => message,
        other => panic!("a device error was expected: {other:?}"),
    };
    device_error(renderer.submit(&scene().frame, &dispatches).map(|_| ()));
    device_error(renderer.end_band(&mut Film::new(WIDTH, HEIGHT)));
    device_error(renderer.begin_band(0..HEIGHT));
    let message = device_error(renderer.prepare(Arc::new(scene())));
    assert!(message.contains("closed") || message.contains("lost"), "{message}");
}
