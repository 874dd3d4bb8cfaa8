// Rays against the whole scene: a compressed wide hierarchy over the instances, whose leaves lead to one within each
// mesh (Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017).
// A group is (base index, members): up to eight digits of four bits, CHILD + the number of the child, the nearest lowest,
// in place of the paper's mask in the order of the ray's octant: that order visits a quarter more nodes of a forest.
// The meshes that a node leads to are entered before its inner children, one after another, and wait beside the stack.
// Every turn visits one node, be it the root of a mesh that is just entered, and intersects the primitives that it leads
// to: lanes that wait for one another all wait for the same thing.

// Groups that await their turn; src/flatten/bvh.rs builds no hierarchy that needs more.
const TRAVERSAL_STACK: u32 = 32u;
// Nodes that one ray may visit, over both levels.
const TRAVERSAL_TURNS: u32 = 65536u;
// What every member of a group has.
const CHILD: u32 = 8u;
// Sorts behind every child that is met, and is no member.
const UNMET: i32 = 0x7ffffff0;
// 8 * 2^-24: relative error of a box's plane in quantisation, of the distance to it, and of the ray's shear.
const BOX_ERROR: f32 = 4.7683716e-7;
// 2^-50: components of the direction are taken to be at least this share of the largest one, so that a reciprocal
// times zero is a number.
const MIN_DIRECTION: f32 = 8.8817842e-16;

// The hit of a surface nearest to the origin, with t in (0, t_max), world space; mist is no surface.
fn scene_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> Hit {
    return traverse(origin, direction, t_max, false, INSTANCE_SEEN);
}

// Whether any surface that casts shadows lies in (0, t_max) along the ray.
fn scene_occluded(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> bool {
    return traverse(origin, direction, t_max, true, INSTANCE_SHADES).t > 0.0;
}

// The nearest boundary of a mist with t in (0, t_max).
fn mist_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> Hit {
    return traverse(origin, direction, t_max, false, INSTANCE_MIST);
}

// Meets the instances whose flags share a bit with the mask; with any_hit, it ends soon after the first that comes.
fn traverse(origin: vec3<f32>, direction: vec3<f32>, t_max: f32, any_hit: bool, mask: u32) -> Hit {
    var hit = Hit(MISS, NONE, 0u, 0.0, 0.0);
    var nearest = t_max;
    // The ray has met what any_hit asks for. No `return` within a loop: lavapipe would mask all that follows.
    var is_over = false;
    if HAS_PLANE {
        for (var i = 0u; i < frame.plane_count && !is_over; i++) {
            if (HAS_MIST || HAS_SHADOWLESS) && (flags_of(i) & mask) == 0u {
                continue;
            }
            let object_origin = transform_point(object_from_world_of(i), origin);
            let object_direction = transform_vector(object_from_world_of(i), direction);
            let plane = plane_intersect(object_origin, object_direction, nearest);
            if plane.t > 0.0 {
                hit = Hit(plane.t, i, plane.face, 0.0, 0.0);
                nearest = plane.t;
                is_over = any_hit;
            }
        }
    }
    // Mists have a hierarchy of their own.
    let in_mist = HAS_MIST && mask == INSTANCE_MIST;
    let count = select(frame.bounded_count, frame.mist_count, in_mist);
    if count == 0u || is_over { return hit; }

    var height = 0u;
    // Inside a mesh: the height of the stack at which the ray is back among the instances.
    var return_height = NONE;
    var instance = 0u;
    var triangle_space: TriangleRay;
    var ray_origin = origin;
    let world_inverse = inverse_direction(direction);
    var inverse = world_inverse;
    // The group in hand, of nodes: the root, to begin with.
    var group = vec2<u32>(select(0u, frame.mist_root, in_mist), CHILD);
    // The meshes that the ray enters before it goes on with the group: a bit each, the last one first, and the instance
    // of bit 0.
    var meshes = 0u;
    var first_mesh = 0u;
    if !HAS_INSTANCES {
        // In the only mesh from the beginning to the end.
        instance = frame.plane_count;
        if HAS_SHADOWLESS && (flags_of(instance) & mask) == 0u { return hit; }
        group.x = root_of(instance);
        let object_from_world = object_from_world_of(instance);
        let object_direction = transform_vector(object_from_world, direction);
        ray_origin = transform_point(object_from_world, origin);
        triangle_space = triangle_ray(ray_origin, object_direction);
        inverse = inverse_direction(object_direction);
    } else if HAS_MESH && count == 1u {
        let only = frame.plane_count + select(0u, frame.bounded_count, in_mist);
        let is_mesh = shape_of(only) == SHAPE_MESH;
        group.y = select(group.y, 0u, is_mesh);
        meshes = select(0u, 1u, is_mesh);
        first_mesh = only;
    }

    var turn = 0u;
    for (; ; turn++) {
        let is_mesh = HAS_MESH && HAS_INSTANCES && meshes != 0u && return_height == NONE;
        let rest = select(group.y >> 4u, group.y, is_mesh);
        // Written whether or not anything is left: what only some lanes do costs lavapipe a branch for each of them.
        let has_room = height < TRAVERSAL_STACK;
        stack_set(min(height, TRAVERSAL_STACK - 1u), vec2<u32>(group.x, rest));
        height += select(0u, 1u, rest != 0u && has_room);
        tally.flags |= select(0u, STATUS_STACK_FULL, rest != 0u && !has_room);

        var child = group.x + (group.y & 7u);
        var limit = nearest;
        if is_mesh {
            let place = firstLeadingBit(meshes);
            meshes &= ~(1u << place);
            instance = first_mesh + place;
            child = root_of(instance);
            let object_from_world = object_from_world_of(instance);
            let object_direction = transform_vector(object_from_world, direction);
            ray_origin = transform_point(object_from_world, origin);
            triangle_space = triangle_ray(ray_origin, object_direction);
            inverse = inverse_direction(object_direction);
            return_height = height;
            if HAS_SHADOWLESS && (flags_of(instance) & mask) == 0u {
                // Nothing of it is met.
                limit = MISS;
            }
        }
        let node = node_at(child);
        let met = node_intersect(node, ray_origin, inverse, limit);
        group = vec2<u32>(node.children.x, met.children);
        // Instances of meshes come first among a node's primitives.
        var primitives_left = met.primitives;
        if HAS_MESH && HAS_INSTANCES {
            let met_meshes = met.primitives & ((1u << (node.grid.w >> 28u)) - 1u);
            primitives_left ^= met_meshes;
            first_mesh = select(first_mesh, node.children.y, met_meshes != 0u);
            meshes |= met_meshes;
        }
        // All of them, even where any hit will do: a loop that waits for what the last one has brought is slower than
        // one that goes on.
        while primitives_left != 0u {
            let place = firstLeadingBit(primitives_left);
            primitives_left &= ~(1u << place);
            let index = node.children.y + place;
            if HAS_MESH && (!HAS_INSTANCES || !HAS_ANALYTIC || return_height != NONE) {
                let triangle = triangle_at(index);
                let met = triangle_intersect(triangle_space, triangle.p0, triangle.p1, triangle.p2, nearest);
                if met.is_hit {
                    hit = Hit(met.t, instance, index, met.b1, met.b2);
                    nearest = met.t;
                }
                continue;
            }
            if HAS_SHADOWLESS && (flags_of(index) & mask) == 0u {
                continue;
            }
            let shape = shape_of(index);
            let object_from_world = object_from_world_of(index);
            let object_origin = transform_point(object_from_world, origin);
            let object_direction = transform_vector(object_from_world, direction);
            let met = instance_intersect(index, shape, object_origin, object_direction, nearest);
            if met.t > 0.0 {
                hit = Hit(met.t, index, met.face, 0.0, 0.0);
                nearest = met.t;
            }
        }

        // Back among the instances, and the group that was put aside last: read whether or not it is needed, as above.
        let top = stack_get(max(height, 1u) - 1u);
        let is_done = group.y == 0u;
        is_over = any_hit && hit.t > 0.0;
        if is_over || (is_done && height == 0u && meshes == 0u) || turn == TRAVERSAL_TURNS { break; }
        var pops = is_done;
        if HAS_MESH && HAS_INSTANCES {
            let leaves = is_done && height == return_height;
            return_height = select(return_height, NONE, leaves);
            ray_origin = select(ray_origin, origin, leaves);
            inverse = select(inverse, world_inverse, leaves);
            pops = is_done && (meshes == 0u || return_height != NONE);
        }
        height -= select(0u, 1u, pops);
        group = select(group, top, pops);
    }
    tally.flags |= select(0u, STATUS_LOOP_BOUND, turn == TRAVERSAL_TURNS);
    return hit;
}

// Reciprocals, finite for directions along an axis.
fn inverse_direction(direction: vec3<f32>) -> vec3<f32> {
    let least = max(max(abs(direction.x), abs(direction.y)), abs(direction.z)) * MIN_DIRECTION;
    let magnitude = max(abs(direction), vec3<f32>(least));
    return 1.0 / select(magnitude, -magnitude, direction < vec3<f32>(0.0));
}

// What a ray meets of a node's children.
struct NodeHit {
    // The members of the group of inner children.
    children: u32,
    // The primitives of leaves, a bit each.
    primitives: u32,
};

// The children of a node whose boxes the ray's stretch from 0 to t_max meets.
fn node_intersect(node: Node, origin: vec3<f32>, inverse: vec3<f32>, t_max: f32) -> NodeHit {
    let cell = vec3<f32>(
        bitcast<f32>((node.grid.w & 0xffu) << 23u),
        bitcast<f32>(((node.grid.w >> 8u) & 0xffu) << 23u),
        bitcast<f32>(((node.grid.w >> 16u) & 0xffu) << 23u),
    );
    // Grid plane q is met at start + q * step; nearer and farther starts make up for all roundings.
    let step = cell * inverse;
    let start = (bitcast<vec3<f32>>(node.grid.xyz) - origin) * inverse;
    let slack = BOX_ERROR * (abs(start) + 256.0 * abs(step));
    let near = start - slack;
    let far = start + slack;

    let negative = inverse < vec3<f32>(0.0);
    let near_x = select(node.x.xy, node.x.zw, negative.x);
    let far_x = select(node.x.zw, node.x.xy, negative.x);
    let near_y = select(node.y.xy, node.y.zw, negative.y);
    let far_y = select(node.y.zw, node.y.xy, negative.y);
    let near_z = select(node.z.xy, node.z.zw, negative.z);
    let far_z = select(node.z.zw, node.z.xy, negative.z);

    let enter_low = max(
        max(planes(near_x.x, step.x, near.x), planes(near_y.x, step.y, near.y)),
        max(planes(near_z.x, step.z, near.z), vec4<i32>(0)),
    );
    let enter_high = max(
        max(planes(near_x.y, step.x, near.x), planes(near_y.y, step.y, near.y)),
        max(planes(near_z.y, step.z, near.z), vec4<i32>(0)),
    );
    let limit = vec4<i32>(bitcast<i32>(t_max));
    let leave_low = min(
        min(planes(far_x.x, step.x, far.x), planes(far_y.x, step.y, far.y)),
        min(planes(far_z.x, step.z, far.z), limit),
    );
    let leave_high = min(
        min(planes(far_x.y, step.x, far.x), planes(far_y.y, step.y, far.y)),
        min(planes(far_z.y, step.z, far.z), limit),
    );
    let met_low = enter_low <= leave_low;
    let met_high = enter_high <= leave_high;
    // Inner children come first, as src/flatten/bvh.rs has put them.
    let inner_count = vec4<u32>((node.grid.w >> 24u) & 15u);
    return NodeHit(
        sorted_members(
            select(vec4<i32>(UNMET), (enter_low & vec4<i32>(-16)) | vec4<i32>(8, 9, 10, 11),
                met_low & (inner_count > vec4<u32>(0u, 1u, 2u, 3u))),
            select(vec4<i32>(UNMET), (enter_high & vec4<i32>(-16)) | vec4<i32>(12, 13, 14, 15),
                met_high & (inner_count > vec4<u32>(4u, 5u, 6u, 7u))),
        ),
        leaf_primitives(node.children.z, met_low) | leaf_primitives(node.children.w, met_high),
    );
}

// The lowest four bits of eight keys, by the order of the keys, which a network of 19 comparators finds
// (Batcher's odd-even merge sort, Knuth vol. 3, section 5.3.4).
fn sorted_members(low: vec4<i32>, high: vec4<i32>) -> u32 {
    let a = vec4<i32>(min(low.xy, low.zw), max(low.xy, low.zw));
    let b = vec4<i32>(min(high.xy, high.zw), max(high.xy, high.zw));
    let c = min(a, b);
    let d = max(a, b);
    // Keys 0, 2, 4, 6 and 1, 3, 5, 7 of the order so far.
    let even = vec4<i32>(min(c.xz, c.yw), min(d.xz, d.yw));
    let odd = vec4<i32>(max(c.xz, c.yw), max(d.xz, d.yw));
    let k2 = min(even.y, even.z);
    let k3 = min(odd.y, odd.z);
    let k4 = max(even.y, even.z);
    let k5 = max(odd.y, odd.z);
    let l1 = min(odd.x, k4);
    let l3 = min(k3, even.w);
    let l4 = max(odd.x, k4);
    let l6 = max(k3, even.w);
    return u32(even.x & 15) | u32(min(l1, k2) & 15) << 4u | u32(max(l1, k2) & 15) << 8u
        | u32(min(l3, l4) & 15) << 12u | u32(max(l3, l4) & 15) << 16u
        | u32(min(k5, l6) & 15) << 20u | u32(max(k5, l6) & 15) << 24u | u32(odd.w & 15) << 28u;
}

// Where a ray meets a plane of each of four children. As integers: the order of floats that are not negative is that of
// their bits, a negative one stays below 0, and a minimum is one instruction, where one of floats takes care of NaN.
fn planes(bytes: u32, step: f32, start: f32) -> vec4<i32> {
    return bitcast<vec4<i32>>(vec4<f32>(unpack4xU8(bytes)) * step + start);
}

// The primitives of those of four children that are met.
fn leaf_primitives(meta_bytes: u32, met: vec4<bool>) -> u32 {
    let shifts = unpack4xU8(meta_bytes & 0x1f1f1f1fu);
    let counts = unpack4xU8((meta_bytes >> 5u) & 0x07070707u);
    let bits = select(vec4<u32>(0u), counts << shifts, met);
    return bits.x | bits.y | bits.z | bits.w;
}
