//! Function tables: a WGSL function evaluated on the device for many inputs, to be compared with its CPU twin.
//!
//! ```ignore
//! let table = FunctionTable::new(&["math/roots.wgsl"], "results[0].x = bitcast<u32>(cube_root(f32_at(0u, 0u)));");
//! let twins = Twins::new(inputs, &table, |row| [floats([cube_root(f32::from_bits(row[0][0])), 0.0, 0.0, 0.0])]);
//! twins.assert_close("cube_root", [Compare::Floats], 0);
//! ```
//! Rows are made of lanes of four words; `floats` and `words` make lanes from numbers. In WGSL the body reads
//! `inputs[i]` (vec4<u32>) or `floats_at(i)` (vec4<f32>), `vec3_at(i)`, `f32_at(i, component)`, and writes
//! `results[i]` (vec4<u32>), for floats through `float_lane(vec4)`.

use std::sync::OnceLock;

/// Four words of a row: integers, or the bits of floats.
pub type Lane = [u32; 4];

/// The first three words of a lane.
pub fn lane_vec3(lane: Lane) -> glam::Vec3 {
    let [x, y, z, _] = lane.map(f32::from_bits);
    glam::Vec3::new(x, y, z)
}

pub fn floats(values: [f32; 4]) -> Lane {
    values.map(f32::to_bits)
}

pub fn vec3_lane(v: glam::Vec3, w: f32) -> Lane {
    floats([v.x, v.y, v.z, w])
}

struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

/// One device for all tables: a software device where there is one, since its arithmetic is known.
fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let request = |software| {
            let options = wgpu::RequestAdapterOptions {
                force_fallback_adapter: software,
                ..wgpu::RequestAdapterOptions::default()
            };
            pollster::block_on(instance.request_adapter(&options))
        };
        let adapter = request(true).or_else(|_| request(false)).unwrap_or_else(|error| {
            panic!("no Vulkan device: apt-get install mesa-vulkan-drivers libvulkan1 ({error})")
        });
        println!("function tables on {:?}", adapter.get_info());
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .expect("the device can be opened");
        Gpu { device, queue }
    })
}

/// A body of WGSL over some parts of the shaders.
pub struct FunctionTable {
    parts: Vec<String>,
    body: String,
}

impl FunctionTable {
    /// `parts` are files under `shaders/`: those that the body needs, and what they need in turn. Parts that declare
    /// bindings may be among them so long as the body does not reach the bindings.
    pub fn new(parts: &[&str], body: &str) -> FunctionTable {
        let read = |part: &&str| {
            let path = format!("{}/shaders/{part}", env!("CARGO_MANIFEST_DIR"));
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
        };
        FunctionTable { parts: parts.iter().map(read).collect(), body: body.to_owned() }
    }

    fn source(&self, inputs: usize, results: usize) -> String {
        let body = &self.body;
        let kernel = format!(
            "
@group(0) @binding(100) var<storage, read> table_inputs: array<array<vec4<u32>, {inputs}>>;
@group(0) @binding(101) var<storage, read_write> table_results: array<array<vec4<u32>, {results}>>;
var<private> inputs: array<vec4<u32>, {inputs}>;
fn floats_at(i: u32) -> vec4<f32> {{ return bitcast<vec4<f32>>(inputs[i]); }}
fn vec3_at(i: u32) -> vec3<f32> {{ return bitcast<vec3<f32>>(inputs[i].xyz); }}
fn f32_at(i: u32, component: u32) -> f32 {{ return bitcast<f32>(inputs[i][component]); }}
fn float_lane(v: vec4<f32>) -> vec4<u32> {{ return bitcast<vec4<u32>>(v); }}
@compute @workgroup_size(64)
fn function_table(@builtin(global_invocation_id) id: vec3<u32>) {{
    let row = id.x;
    if (row >= arrayLength(&table_inputs)) {{ return; }}
    inputs = table_inputs[row];
    var results: array<vec4<u32>, {results}>;
    {body}
    table_results[row] = results;
}}
"
        );
        self.parts.join("\n") + &kernel
    }

    /// The results for each row of inputs; at most 64 * 65,535 rows.
    pub fn evaluate<const I: usize, const O: usize>(&self, inputs: &[[Lane; I]]) -> Vec<[Lane; O]> {
        let Gpu { device, queue } = gpu();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("function table"),
            source: wgpu::ShaderSource::Wgsl(self.source(I, O).into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("function table"),
            layout: None,
            module: &module,
            entry_point: Some("function_table"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let buffer = |size: usize, usage: wgpu::BufferUsages| {
            let descriptor =
                wgpu::BufferDescriptor { label: None, size: size as u64, usage, mapped_at_creation: false };
            device.create_buffer(&descriptor)
        };
        let result_bytes = inputs.len() * O * size_of::<Lane>();
        let input_buffer = buffer(size_of_val(inputs), wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST);
        let result_buffer = buffer(result_bytes, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let read_buffer = buffer(result_bytes, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        queue.write_buffer(&input_buffer, 0, bytemuck::cast_slice(inputs.as_flattened()));
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 100, resource: input_buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 101, resource: result_buffer.as_entire_binding() },
            ],
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            pass.dispatch_workgroups(inputs.len().div_ceil(64) as u32, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&result_buffer, 0, &read_buffer, 0, result_bytes as u64);
        queue.submit([encoder.finish()]);
        read_buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("the results can be read"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
        let view = read_buffer.get_mapped_range(..).expect("the results are mapped");
        let lanes: Vec<Lane> = bytemuck::pod_collect_to_vec(&view);
        lanes.as_chunks::<O>().0.to_vec()
    }
}

/// The inputs of a table with the results of both twins.
pub struct Twins<const I: usize, const O: usize> {
    pub inputs: Vec<[Lane; I]>,
    pub gpu: Vec<[Lane; O]>,
    pub cpu: Vec<[Lane; O]>,
}

impl<const I: usize, const O: usize> Twins<I, O> {
    pub fn new(inputs: Vec<[Lane; I]>, gpu: &FunctionTable, cpu: impl Fn(&[Lane; I]) -> [Lane; O]) -> Self {
        let (gpu, cpu) = (gpu.evaluate(&inputs), inputs.iter().map(cpu).collect());
        Twins { inputs, gpu, cpu }
    }

    pub fn difference(&self, how: [Compare; O]) -> Difference {
        worst_difference(&self.gpu, &self.cpu, how)
    }

    /// Fails where the twins are more than `limit` ulps apart.
    pub fn assert_close(&self, name: &str, how: [Compare; O], limit: u32) {
        let Difference { ulps, row, rows } = self.difference(how);
        println!("{name}: {} rows, {rows} differ, by {ulps} ulps at most", self.inputs.len());
        let print = |lanes: &[Lane]| {
            format!("{:?} = {lanes:x?}", lanes.iter().map(|lane| lane.map(f32::from_bits)).collect::<Vec<_>>())
        };
        assert!(
            ulps <= limit,
            "{name}: {ulps} ulps apart in row {row}: inputs {}\n gpu {}\n cpu {}",
            print(&self.inputs[row]),
            print(&self.gpu[row]),
            print(&self.cpu[row]),
        );
    }
}

/// How the words of a lane are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compare {
    /// Floats, by the number of floats between them; NaN differs from everything but NaN.
    Floats,
    /// Integers, which are equal or as different as can be.
    Bits,
}

/// Number of floats between a and b. Subnormals count as zero, which is what some devices make of them.
pub fn ulps(a: f32, b: f32) -> u32 {
    let order = |x: f32| {
        let magnitude = i64::from(x.abs().to_bits()) - i64::from(f32::MIN_POSITIVE.to_bits()) + 1;
        magnitude.max(0) * if x < 0.0 { -1 } else { 1 }
    };
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0,
        (false, false) => (order(a) - order(b)).unsigned_abs().try_into().unwrap_or(u32::MAX),
        _ => u32::MAX,
    }
}

/// The row where the two tables differ most, and by how much in ulps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    pub ulps: u32,
    pub row: usize,
    /// Rows that differ at all.
    pub rows: usize,
}

pub fn worst_difference<const O: usize>(gpu: &[[Lane; O]], cpu: &[[Lane; O]], how: [Compare; O]) -> Difference {
    assert_eq!(gpu.len(), cpu.len(), "tables of different lengths");
    assert!(!gpu.is_empty(), "an empty table");
    let mut worst = Difference::default();
    for (row, (a, b)) in gpu.iter().zip(cpu).enumerate() {
        let word = |lane: usize, i: usize| match how[lane] {
            Compare::Floats => ulps(f32::from_bits(a[lane][i]), f32::from_bits(b[lane][i])),
            Compare::Bits => {
                if a[lane][i] == b[lane][i] {
                    0
                } else {
                    u32::MAX
                }
            }
        };
        let difference = (0..O).flat_map(|lane| (0..4).map(move |i| (lane, i))).map(|(l, i)| word(l, i)).max();
        let difference = difference.unwrap_or(u32::MAX);
        worst.rows += usize::from(difference > 0);
        if difference > worst.ulps {
            (worst.ulps, worst.row) = (difference, row);
        }
    }
    worst
}
