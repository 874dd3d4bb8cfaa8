// The buffers of memory/words/buffers.wgsl, two words at a time as integers of 64 bits. Lavapipe loads lane by lane and
// checks each load, whatever its width, so that half as many are faster; what a load brings that is not used is left out.
@group(0) @binding(2) var<storage, read> nodes: array<array<vec2<u64>, 5>>;
@group(0) @binding(3) var<storage, read> instances: array<array<vec2<u64>, 8>>;
@group(0) @binding(4) var<storage, read> triangles: array<array<vec2<u64>, 4>>;

// Four words, the lower half of a pair first, as the buffers are little-endian.
fn words_of(pairs: vec2<u64>) -> vec4<u32> {
    return vec4<u32>(u32(pairs.x), u32(pairs.x >> 32u), u32(pairs.y), u32(pairs.y >> 32u));
}
fn numbers_of(pairs: vec2<u64>) -> vec4<f32> { return bitcast<vec4<f32>>(words_of(pairs)); }

fn node_at(index: u32) -> Node {
    return Node(
        words_of(nodes[index][0]),
        words_of(nodes[index][1]),
        words_of(nodes[index][2]),
        words_of(nodes[index][3]),
        words_of(nodes[index][4]),
    );
}

fn object_from_world_of(instance: u32) -> mat3x4<f32> {
    return mat3x4<f32>(
        numbers_of(instances[instance][0]),
        numbers_of(instances[instance][1]),
        numbers_of(instances[instance][2]),
    );
}
fn shape_of(instance: u32) -> u32 { return words_of(instances[instance][3]).x; }
fn material_of(instance: u32) -> u32 { return words_of(instances[instance][3]).y; }
fn root_of(instance: u32) -> u32 { return words_of(instances[instance][3]).z; }
fn flags_of(instance: u32) -> u32 { return words_of(instances[instance][3]).w; }
fn world_from_object_of(instance: u32) -> mat3x4<f32> {
    return mat3x4<f32>(
        numbers_of(instances[instance][4]),
        numbers_of(instances[instance][5]),
        numbers_of(instances[instance][6]),
    );
}
fn parameters_of(instance: u32) -> vec4<f32> { return numbers_of(instances[instance][7]); }

fn triangle_at(index: u32) -> Triangle {
    let corner0 = words_of(triangles[index][0]);
    let corner1 = words_of(triangles[index][1]);
    let corner2 = words_of(triangles[index][2]);
    let rest = words_of(triangles[index][3]);
    return Triangle(
        bitcast<vec3<f32>>(corner0.xyz), corner0.w,
        bitcast<vec3<f32>>(corner1.xyz), corner1.w,
        bitcast<vec3<f32>>(corner2.xyz), corner2.w,
        rest.x, rest.y, rest.z, rest.w,
    );
}
