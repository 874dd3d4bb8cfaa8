// The buffers that rays read most, word by word, as types.wgsl declares them. The files in memory/pairs and memory/shared
// have the functions of those of their names here; `MemoryAccess` in src/shader.rs says which of them a device is given.
@group(0) @binding(2) var<storage, read> nodes: array<Node>;
@group(0) @binding(3) var<storage, read> instances: array<Instance>;
@group(0) @binding(4) var<storage, read> triangles: array<Triangle>;

fn object_from_world_of(instance: u32) -> mat3x4<f32> { return instances[instance].object_from_world; }
fn shape_of(instance: u32) -> u32 { return instances[instance].shape; }
fn material_of(instance: u32) -> u32 { return instances[instance].material; }
fn root_of(instance: u32) -> u32 { return instances[instance].root; }
fn flags_of(instance: u32) -> u32 { return instances[instance].flags; }
fn world_from_object_of(instance: u32) -> mat3x4<f32> { return instances[instance].world_from_object; }
fn parameters_of(instance: u32) -> vec4<f32> { return instances[instance].parameters; }

fn triangle_at(index: u32) -> Triangle { return triangles[index]; }
