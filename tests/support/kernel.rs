//! Small kernels over a scene's buffers: what a function says that reads bindings, for many inputs at once.

use glam::UVec2;
use gpu_trace::film::Film;
use gpu_trace::flatten::SceneBuffers;
use gpu_trace::gpu::{Device, DeviceSelector, GpuOptions, GpuRenderer};
use gpu_trace::layout::Dispatch;
use gpu_trace::renderer::Renderer;
use gpu_trace::shader::{PARTS, Part, Program};
use std::sync::Arc;

/// Evaluates `body` for each query on the device. The body reads the words of its query by `word(i)` (u32) and
/// `number(i)` (f32), and assigns `low` and `high` (vec4<u32>), which come back as eight words. The queries lie behind
/// the scene's own texels.
pub fn evaluate<const N: usize>(buffers: &SceneBuffers, body: &str, queries: &[[u32; N]]) -> Vec<[u32; 8]> {
    let source = format!(
        "
var<private> query: u32;
fn word(i: u32) -> u32 {{ return texels[query + i]; }}
fn number(i: u32) -> f32 {{ return bitcast<f32>(texels[query + i]); }}
@compute @workgroup_size(64)
fn evaluate(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {{
    let index = group.x * 64u + lane;
    if (group.x >= dispatch.block_count || index >= texels[frame.seed]) {{ return; }}
    query = frame.seed + 1u + index * {N}u;
    var low = vec4<u32>(0u);
    var high = vec4<u32>(0u);
    {body}
    film[index] = FilmPixel(low, high);
}}
"
    );
    let parts: Vec<Part> = PARTS
        .iter()
        .filter(|part| !part.path.starts_with("shaders/kernels"))
        .copied()
        .chain([Part { path: "tests/kernel.wgsl", text: &source }])
        .collect();
    let program = Program::link(&parts).unwrap_or_else(|error| panic!("{error}"));
    let device = Device::open(&DeviceSelector::Any).unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = GpuRenderer::with_program(device, GpuOptions { checked: false }, program, "evaluate");

    let rows = queries.len().div_ceil(64).next_multiple_of(8) as u32;
    let mut buffers = buffers.clone();
    buffers.frame.image_size = UVec2::new(64, rows);
    buffers.frame.seed = buffers.texels.len() as u32;
    buffers.texels.push(queries.len() as u32);
    buffers.texels.extend(queries.as_flattened());
    let frame = buffers.frame;
    let mut film = Film::new(64, rows);
    let mut run = || -> gpu_trace::Result<()> {
        renderer.prepare(Arc::new(buffers.clone()))?;
        renderer.begin_band(0..rows)?;
        let dispatch =
            Dispatch { band_rows: rows, block_count: rows, tile_stride: 1, portions: 1, ..Dispatch::default() };
        renderer.submit(&frame, &[dispatch])?;
        renderer.end_band(&mut film)
    };
    run().unwrap_or_else(|error| panic!("{error}"));
    let words = |pixel: &[i64; 4]| {
        let [a, b, c, d] = pixel.map(|sum| [sum as u32, (sum >> 32) as u32]);
        [a[0], b[0], c[0], d[0], a[1], b[1], c[1], d[1]]
    };
    film.pixels.iter().take(queries.len()).map(words).collect()
}
