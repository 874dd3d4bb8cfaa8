// Rays against the whole scene: a compressed wide hierarchy over the instances, whose leaves lead to one within each
// mesh (Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017).
// A group is (base index, bits). For nodes, the high byte says which children are still to be visited, in the order
// of the ray's octant, and the low byte which children are inner nodes; for instances of meshes, the low 24 bits say
// which are still to be entered. So a group of meshes is at most GROUP_PRIMITIVES, and a group of nodes is more. Every
// turn visits one node, be it the root of a mesh that is just entered, and intersects the primitives that it leads to:
// lanes that wait for one another all wait for the same thing.

// Groups that await their turn; src/flatten/bvh.rs builds no hierarchy that needs more.
const TRAVERSAL_STACK: u32 = 32u;
// Nodes that one ray may visit, over both levels.
const TRAVERSAL_TURNS: u32 = 65536u;
const GROUP_PRIMITIVES: u32 = 0x00ffffffu;
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

// Meets the instances whose flags share a bit with the mask; with any_hit, the first that comes.
fn traverse(origin: vec3<f32>, direction: vec3<f32>, t_max: f32, any_hit: bool, mask: u32) -> Hit {
    var hit = Hit(MISS, NONE, 0u, 0.0, 0.0);
    var nearest = t_max;
    if HAS_PLANE {
        for (var i = 0u; i < frame.plane_count; i++) {
            if (HAS_MIST || HAS_SHADOWLESS) && (instances[i].flags & mask) == 0u {
                continue;
            }
            let object_origin = transform_point(instances[i].object_from_world, origin);
            let object_direction = transform_vector(instances[i].object_from_world, direction);
            let plane = plane_intersect(object_origin, object_direction, nearest);
            if plane.t > 0.0 {
                hit = Hit(plane.t, i, plane.face, 0.0, 0.0);
                nearest = plane.t;
                if any_hit { return hit; }
            }
        }
    }
    // Mists have a hierarchy of their own.
    let in_mist = HAS_MIST && mask == INSTANCE_MIST;
    let count = select(frame.bounded_count, frame.mist_count, in_mist);
    if count == 0u { return hit; }

    var stack: array<vec2<u32>, TRAVERSAL_STACK>;
    var height = 0u;
    // Inside a mesh: the height of the stack at which the ray is back among the instances.
    var return_height = NONE;
    var instance = 0u;
    var triangle_space: TriangleRay;
    var ray_origin = origin;
    let world_inverse = inverse_direction(direction);
    let world_octant = octant_bytes(direction);
    var inverse = world_inverse;
    var octant = world_octant;
    // The group in hand: nodes, or instances of meshes. The root, to begin with.
    var group = vec2<u32>(select(0u, frame.mist_root, in_mist), 0x80000000u);
    if HAS_MESH && count == 1u {
        let only = frame.plane_count + select(0u, frame.bounded_count, in_mist);
        if instances[only].shape == SHAPE_MESH && (instances[only].flags & mask) != 0u {
            group = vec2<u32>(only, 1u);
        }
    }

    let only_meshes = HAS_MESH && !(HAS_ANALYTIC || HAS_SHADOWLESS);
    for (var turn = 0u; ; turn++) {
        if turn == TRAVERSAL_TURNS {
            tally.flags |= STATUS_LOOP_BOUND;
            break;
        }
        let bit = firstLeadingBit(group.y);
        let is_mesh = HAS_MESH && group.y <= GROUP_PRIMITIVES;
        let rest = group.y & ~(1u << bit);
        // Written whether or not anything is left: what only some lanes do costs lavapipe a branch for each of them.
        let has_rest = rest > select(GROUP_PRIMITIVES, 0u, is_mesh);
        let has_room = height < TRAVERSAL_STACK;
        stack[min(height, TRAVERSAL_STACK - 1u)] = vec2<u32>(group.x, rest);
        height += select(0u, 1u, has_rest && has_room);
        tally.flags |= select(0u, STATUS_STACK_FULL, has_rest && !has_room);

        let slot = (bit - 24u) ^ (octant & 7u);
        var child = group.x + countOneBits(rest & ~(0xffffffffu << (slot & 31u)));
        if is_mesh {
            instance = group.x + bit;
            child = instances[instance].root;
            let object_from_world = instances[instance].object_from_world;
            let object_direction = transform_vector(object_from_world, direction);
            ray_origin = transform_point(object_from_world, origin);
            triangle_space = triangle_ray(ray_origin, object_direction);
            inverse = inverse_direction(object_direction);
            octant = octant_bytes(object_direction);
            return_height = height;
        }
        let node = nodes[child];
        let bits = node_intersect(node, ray_origin, inverse, octant, nearest);
        let inner = bits & ~GROUP_PRIMITIVES;
        group = vec2<u32>(node.children.x, select(0u, inner | (node.grid.w >> 24u), inner != 0u));
        var primitives_left = bits & GROUP_PRIMITIVES;
        var meshes = 0u;
        if only_meshes && return_height == NONE {
            meshes = primitives_left;
            primitives_left = 0u;
        }
        while primitives_left != 0u {
            let place = firstLeadingBit(primitives_left);
            primitives_left &= ~(1u << place);
            let index = node.children.y + place;
            if HAS_MESH && return_height != NONE {
                let triangle = triangles[index];
                let met = triangle_intersect(triangle_space, triangle.p0, triangle.p1, triangle.p2, nearest);
                if met.t > 0.0 {
                    hit = Hit(met.t, instance, index, met.b1, met.b2);
                    nearest = met.t;
                    if any_hit { return hit; }
                }
                continue;
            }
            if HAS_SHADOWLESS && (instances[index].flags & mask) == 0u {
                continue;
            }
            let shape = instances[index].shape;
            if HAS_MESH && shape == SHAPE_MESH {
                meshes |= 1u << place;
                continue;
            }
            let object_from_world = instances[index].object_from_world;
            let object_origin = transform_point(object_from_world, origin);
            let object_direction = transform_vector(object_from_world, direction);
            let met = instance_intersect(index, shape, object_origin, object_direction, nearest);
            if met.t > 0.0 {
                hit = Hit(met.t, index, met.face, 0.0, 0.0);
                nearest = met.t;
                if any_hit { return hit; }
            }
        }

        if HAS_MESH && meshes != 0u {
            // The meshes first, then the node's inner children.
            let has_inner = group.y != 0u;
            let has_space = height < TRAVERSAL_STACK;
            stack[min(height, TRAVERSAL_STACK - 1u)] = group;
            height += select(0u, 1u, has_inner && has_space);
            tally.flags |= select(0u, STATUS_STACK_FULL, has_inner && !has_space);
            group = vec2<u32>(node.children.y, meshes);
        }
        // Back among the instances, and the group that was put aside last: read whether or not it is needed, as above.
        let top = stack[max(height, 1u) - 1u];
        let is_done = group.y == 0u;
        if is_done && height == 0u { break; }
        if HAS_MESH {
            let leaves = is_done && height == return_height;
            return_height = select(return_height, NONE, leaves);
            ray_origin = select(ray_origin, origin, leaves);
            inverse = select(inverse, world_inverse, leaves);
            octant = select(octant, world_octant, leaves);
        }
        height -= select(0u, 1u, is_done);
        group = select(group, top, is_done);
    }
    return hit;
}

// Reciprocals, finite for directions along an axis.
fn inverse_direction(direction: vec3<f32>) -> vec3<f32> {
    let least = max(max(abs(direction.x), abs(direction.y)), abs(direction.z)) * MIN_DIRECTION;
    let magnitude = max(abs(direction), vec3<f32>(least));
    return 1.0 / select(magnitude, -magnitude, direction < vec3<f32>(0.0));
}

// In each byte, which components of the direction are not negative (4 for x, 2 for y, 1 for z): children lie in the
// slot of the octant that they fill, so slot ^ octant puts the nearest highest.
fn octant_bytes(direction: vec3<f32>) -> u32 {
    return select(0x04040404u, 0u, direction.x < 0.0)
        | select(0x02020202u, 0u, direction.y < 0.0)
        | select(0x01010101u, 0u, direction.z < 0.0);
}

// The children of a node that the ray meets before t_max: inner nodes in the high byte, by priority, and the
// primitives of leaves in the low 24 bits.
fn node_intersect(node: Node, origin: vec3<f32>, inverse: vec3<f32>, octant: u32, t_max: f32) -> u32 {
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

    return four_children(
        node.children.z, octant,
        max(max(planes(near_x.x, step.x, near.x), planes(near_y.x, step.y, near.y)), planes(near_z.x, step.z, near.z)),
        min(min(planes(far_x.x, step.x, far.x), planes(far_y.x, step.y, far.y)), planes(far_z.x, step.z, far.z)),
        t_max,
    ) | four_children(
        node.children.w, octant,
        max(max(planes(near_x.y, step.x, near.x), planes(near_y.y, step.y, near.y)), planes(near_z.y, step.z, near.z)),
        min(min(planes(far_x.y, step.x, far.x), planes(far_y.y, step.y, far.y)), planes(far_z.y, step.z, far.z)),
        t_max,
    );
}

// Where a ray meets a plane of each of four children. As integers: the order of floats that are not negative is that of
// their bits, a negative one stays below 0, and a minimum is one instruction, where one of floats takes care of NaN.
fn planes(bytes: u32, step: f32, start: f32) -> vec4<i32> {
    return bitcast<vec4<i32>>(vec4<f32>(unpack4xU8(bytes)) * step + start);
}

// Where each of four children belongs in the group, if the ray's stretch inside its box, from 0 to t_max, is not empty.
fn four_children(meta_bytes: u32, octant: u32, near: vec4<i32>, far: vec4<i32>, t_max: f32) -> u32 {
    // Inner children have the offsets 24 to 31, which no leaf has: both bits of 24 are set.
    let inner_mask = (((meta_bytes & (meta_bytes << 1u)) & 0x10101010u) >> 4u) * 0xffu;
    let shifts = (meta_bytes ^ (octant & inner_mask)) & 0x1f1f1f1fu;
    let bits = (meta_bytes >> 5u) & 0x07070707u;
    let t_enter = max(near, vec4<i32>(0));
    let t_leave = min(far, vec4<i32>(bitcast<i32>(t_max)));
    let met = select(vec4<u32>(0u), unpack4xU8(bits) << unpack4xU8(shifts), t_enter <= t_leave);
    return met.x | met.y | met.z | met.w;
}
