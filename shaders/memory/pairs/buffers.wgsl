// The buffers of memory/words/buffers.wgsl as integers of 64 bits. Lavapipe loads lane by lane: each load waits for a
// test of the lane, and each component for one against the buffer's end. Fewest of both have vectors of four integers;
// components that are not used are left out.
@group(0) @binding(2) var<storage, read> nodes: array<array<vec4<u64>, 3>>;
@group(0) @binding(3) var<storage, read> instances: array<array<vec4<u64>, 4>>;
@group(0) @binding(4) var<storage, read> triangles: array<array<vec4<u64>, 2>>;

// Four words, the lower half of a pair first, as the buffers are little-endian.
fn words_of(pairs: vec2<u64>) -> vec4<u32> {
    return vec4<u32>(u32(pairs.x), u32(pairs.x >> 32u), u32(pairs.y), u32(pairs.y >> 32u));
}
fn numbers_of(pairs: vec2<u64>) -> vec4<f32> { return bitcast<vec4<f32>>(words_of(pairs)); }

// For `node_at`.
fn load_node(index: u32) -> Node {
    let first = nodes[index][0];
    let second = nodes[index][1];
    let third = nodes[index][2];
    return Node(
        words_of(first.xy),
        words_of(first.zw),
        words_of(second.xy),
        words_of(second.zw),
        words_of(third.xy),
        vec4<u32>(0u),
    );
}

fn object_from_world_of(instance: u32) -> mat3x4<f32> {
    let first = instances[instance][0];
    let second = instances[instance][1];
    return mat3x4<f32>(numbers_of(first.xy), numbers_of(first.zw), numbers_of(second.xy));
}
fn shape_of(instance: u32) -> u32 { return u32(instances[instance][1].z); }
fn material_of(instance: u32) -> u32 { return u32(instances[instance][1].z >> 32u); }
// Of whole vectors, as they are read beside the map: a load of one component would be another load.
fn root_of(instance: u32) -> u32 {
    let second = instances[instance][1];
    return u32(second.w);
}
fn flags_of(instance: u32) -> u32 {
    let second = instances[instance][1];
    return u32(second.w >> 32u);
}
fn world_from_object_of(instance: u32) -> mat3x4<f32> {
    let third = instances[instance][2];
    let fourth = instances[instance][3];
    return mat3x4<f32>(numbers_of(third.xy), numbers_of(third.zw), numbers_of(fourth.xy));
}
fn parameters_of(instance: u32) -> vec4<f32> { return numbers_of(instances[instance][3].zw); }

fn triangle_at(index: u32) -> Triangle {
    let low = triangles[index][0];
    let high = triangles[index][1];
    let corner0 = words_of(low.xy);
    let corner1 = words_of(low.zw);
    let corner2 = words_of(high.xy);
    let rest = words_of(high.zw);
    return Triangle(
        bitcast<vec3<f32>>(corner0.xyz), corner0.w,
        bitcast<vec3<f32>>(corner1.xyz), corner1.w,
        bitcast<vec3<f32>>(corner2.xyz), corner2.w,
        rest.x, rest.y, rest.z, rest.w,
    );
}
