//! Rays against the whole scene; twin of `shaders/geometry/bvh.wgsl`, where the method and the groups are described.
//!
//! The order in which nodes and primitives are visited is the same, so that ties fall to the same primitive.

use super::hit::{Hit, MISS};
use super::instance::{instance_intersect, transform_point, transform_vector};
use super::plane::plane_intersect;
use super::triangle::{TriangleRay, triangle_intersect, triangle_ray};
use crate::cpu::bindings::Bindings;
use crate::layout::{
    INSTANCE_MIST, INSTANCE_SEEN, INSTANCE_SHADES, NONE, Node, SHAPE_MESH, STATUS_LOOP_BOUND, STATUS_STACK_FULL,
};
use crate::renderer::Tally;
use glam::{UVec2, UVec4, Vec3};

/// Groups that await their turn; the builder makes no hierarchy that needs more.
const TRAVERSAL_STACK: usize = crate::flatten::TRAVERSAL_STACK as usize;
const TRAVERSAL_TURNS: u32 = 65_536;
const CHILD: u32 = 8;
const BOX_ERROR: f32 = 4.768_371_6e-7;
const MIN_DIRECTION: f32 = 8.881_784e-16;

/// The hit of a surface nearest to the origin, with t in (0, t_max), world space; t is [`MISS`] where there is none.
/// Mist is no surface.
pub fn scene_intersect(scene: &Bindings, origin: Vec3, direction: Vec3, t_max: f32, tally: &mut Tally) -> Hit {
    traverse::<false, INSTANCE_SEEN>(scene, origin, direction, t_max, tally)
}

/// Whether any surface that casts shadows lies in (0, t_max) along the ray.
pub fn scene_occluded(scene: &Bindings, origin: Vec3, direction: Vec3, t_max: f32, tally: &mut Tally) -> bool {
    traverse::<true, INSTANCE_SHADES>(scene, origin, direction, t_max, tally).t > 0.0
}

/// The nearest boundary of a mist with t in (0, t_max).
pub fn mist_intersect(scene: &Bindings, origin: Vec3, direction: Vec3, t_max: f32, tally: &mut Tally) -> Hit {
    traverse::<false, INSTANCE_MIST>(scene, origin, direction, t_max, tally)
}

/// The groups that await their turn.
struct Stack {
    groups: [UVec2; TRAVERSAL_STACK],
    height: usize,
}

impl Stack {
    #[inline]
    fn push(&mut self, group: UVec2, tally: &mut Tally) {
        match self.groups.get_mut(self.height) {
            Some(place) => {
                *place = group;
                self.height += 1;
            }
            None => tally.flags |= STATUS_STACK_FULL,
        }
    }

    #[inline]
    fn pop(&mut self) -> Option<UVec2> {
        self.height = self.height.checked_sub(1)?;
        self.groups.get(self.height).copied()
    }
}

/// Meets the instances whose flags share a bit with `MASK`; with `ANY_HIT`, the first that comes.
fn traverse<const ANY_HIT: bool, const MASK: u32>(
    scene: &Bindings,
    origin: Vec3,
    direction: Vec3,
    t_max: f32,
    tally: &mut Tally,
) -> Hit {
    let mut hit = Hit { t: MISS, instance: NONE, primitive: 0, b1: 0.0, b2: 0.0 };
    let mut nearest = t_max;
    for (i, instance) in (0..scene.frame.plane_count).zip(scene.instances) {
        if instance.flags & MASK == 0 {
            continue;
        }
        let object_origin = transform_point(&instance.object_from_world, origin);
        let object_direction = transform_vector(&instance.object_from_world, direction);
        let plane = plane_intersect(object_origin, object_direction, nearest);
        if plane.t > 0.0 {
            hit = Hit { t: plane.t, instance: i, primitive: plane.face, b1: 0.0, b2: 0.0 };
            nearest = plane.t;
            if ANY_HIT {
                return hit;
            }
        }
    }
    // Mists have a hierarchy of their own.
    let (first, count, root) = match MASK {
        INSTANCE_MIST => {
            (scene.frame.plane_count + scene.frame.bounded_count, scene.frame.mist_count, scene.frame.mist_root)
        }
        _ => (scene.frame.plane_count, scene.frame.bounded_count, 0),
    };
    if count == 0 {
        return hit;
    }

    let mut stack = Stack { groups: [UVec2::ZERO; TRAVERSAL_STACK], height: 0 };
    // Inside a mesh: its instance, its ray, and the height of the stack at which the ray is back among the instances.
    let mut mesh: Option<(u32, TriangleRay, usize)> = None;
    let mut ray_origin = origin;
    let mut inverse = inverse_direction(direction);
    // The group in hand, of nodes: the root, to begin with.
    let mut group = UVec2::new(root, CHILD);
    // The meshes that the ray enters before it goes on with the group: a bit each, the last one first, and the instance
    // of bit 0.
    let mut meshes = 0;
    let mut first_mesh = 0;
    if count == 1 && scene.instances[first as usize].shape == SHAPE_MESH {
        group.y = 0;
        meshes = 1;
        first_mesh = first;
    }

    for turn in 0.. {
        if turn == TRAVERSAL_TURNS {
            tally.flags |= STATUS_LOOP_BOUND;
            break;
        }
        let is_mesh = meshes != 0 && mesh.is_none();
        let rest = if is_mesh { group.y } else { group.y >> 4 };
        if rest != 0 {
            stack.push(UVec2::new(group.x, rest), tally);
        }
        let mut limit = nearest;
        let child = if is_mesh {
            let place = first_leading_bit(meshes);
            meshes &= !(1 << place);
            let index = first_mesh + place;
            let instance = &scene.instances[index as usize];
            let object_direction = transform_vector(&instance.object_from_world, direction);
            ray_origin = transform_point(&instance.object_from_world, origin);
            inverse = inverse_direction(object_direction);
            mesh = Some((index, triangle_ray(ray_origin, object_direction), stack.height));
            if instance.flags & MASK == 0 {
                // Nothing of it is met.
                limit = MISS;
            }
            instance.root
        } else {
            group.x + (group.y & 7)
        };
        let node = &scene.nodes[child as usize];
        let met = node_intersect(node, ray_origin, inverse, limit);
        group = UVec2::new(node.children.x, met.children);
        // Instances of meshes come first among a node's primitives.
        let met_meshes = met.primitives & ((1 << (node.grid.w >> 28)) - 1);
        let mut primitives_left = met.primitives ^ met_meshes;
        if met_meshes != 0 {
            first_mesh = node.children.y;
            meshes = met_meshes;
        }
        while primitives_left != 0 {
            let place = first_leading_bit(primitives_left);
            primitives_left &= !(1 << place);
            let index = node.children.y + place;
            if let Some((instance, triangle_space, _)) = &mesh {
                let triangle = &scene.triangles[index as usize];
                let met = triangle_intersect(triangle_space, triangle.p0, triangle.p1, triangle.p2, nearest);
                if met.is_hit {
                    hit = Hit { t: met.t, instance: *instance, primitive: index, b1: met.b1, b2: met.b2 };
                    nearest = met.t;
                    if ANY_HIT {
                        return hit;
                    }
                }
                continue;
            }
            let instance = &scene.instances[index as usize];
            if instance.flags & MASK == 0 {
                continue;
            }
            let object_origin = transform_point(&instance.object_from_world, origin);
            let object_direction = transform_vector(&instance.object_from_world, direction);
            let met = instance_intersect(scene, index, instance.shape, object_origin, object_direction, nearest);
            if met.t > 0.0 {
                hit = Hit { t: met.t, instance: index, primitive: met.face, b1: 0.0, b2: 0.0 };
                nearest = met.t;
                if ANY_HIT {
                    return hit;
                }
            }
        }

        if group.y == 0 {
            if mesh.as_ref().is_some_and(|(_, _, return_height)| stack.height == *return_height) {
                mesh = None;
                ray_origin = origin;
                inverse = inverse_direction(direction);
            }
            if meshes == 0 || mesh.is_some() {
                match stack.pop() {
                    Some(top) => group = top,
                    None => break,
                }
            }
        }
    }
    hit
}

/// `firstLeadingBit` of WGSL, for words that are not 0.
#[inline]
fn first_leading_bit(word: u32) -> u32 {
    31 - word.leading_zeros()
}

/// Reciprocals, finite for directions along an axis.
#[inline]
pub fn inverse_direction(direction: Vec3) -> Vec3 {
    let least = direction.x.abs().max(direction.y.abs()).max(direction.z.abs()) * MIN_DIRECTION;
    let reciprocal = |component: f32| {
        let magnitude = component.abs().max(least);
        1.0 / if component < 0.0 { -magnitude } else { magnitude }
    };
    Vec3::new(reciprocal(direction.x), reciprocal(direction.y), reciprocal(direction.z))
}

/// What a ray meets of a node's children.
pub struct NodeHit {
    /// The members of the group of inner children.
    pub children: u32,
    /// The primitives of leaves, a bit each.
    pub primitives: u32,
}

/// The children of a node whose boxes the ray's stretch from 0 to t_max meets.
#[inline]
pub fn node_intersect(node: &Node, origin: Vec3, inverse: Vec3, t_max: f32) -> NodeHit {
    let cell = Vec3::new(
        f32::from_bits((node.grid.w & 0xff) << 23),
        f32::from_bits(((node.grid.w >> 8) & 0xff) << 23),
        f32::from_bits(((node.grid.w >> 16) & 0xff) << 23),
    );
    let corner = Vec3::new(f32::from_bits(node.grid.x), f32::from_bits(node.grid.y), f32::from_bits(node.grid.z));
    // Grid plane q is met at start + q * step; nearer and farther starts make up for all roundings.
    let step = cell * inverse;
    let start = (corner - origin) * inverse;
    let slack = BOX_ERROR * (start.abs() + 256.0 * step.abs());
    let near = start - slack;
    let far = start + slack;

    let (near_x, far_x) = near_and_far(node.x, inverse.x);
    let (near_y, far_y) = near_and_far(node.y, inverse.y);
    let (near_z, far_z) = near_and_far(node.z, inverse.z);
    let mut met = 0;
    let mut enter = [0.0f32; 8];
    for i in 0..8 {
        enter[i] = larger(
            larger(near_x[i] * step.x + near.x, near_y[i] * step.y + near.y),
            larger(near_z[i] * step.z + near.z, 0.0),
        );
        let t_leave = smaller(
            smaller(far_x[i] * step.x + far.x, far_y[i] * step.y + far.y),
            smaller(far_z[i] * step.z + far.z, t_max),
        );
        met |= u32::from(enter[i] <= t_leave) << i;
    }
    // Inner children come first, as src/flatten/bvh.rs has put them.
    let inner_mask = (1 << (node.grid.w >> 24 & 15)) - 1;
    NodeHit { children: sorted_members(&enter, met & inner_mask), primitives: leaf_primitives(node, met & !inner_mask) }
}

/// The members of the group of inner children that are met (bit i: child i), by where the ray enters them.
#[inline]
fn sorted_members(enter: &[f32; 8], mut met: u32) -> u32 {
    let mut keys = [0; 8];
    let mut count = 0;
    while met != 0 {
        let child = met.trailing_zeros() & 7;
        met &= met - 1;
        let key = enter[child as usize].to_bits() & !15 | CHILD | child;
        // Few are met, so they are inserted one by one.
        let mut place = count & 7;
        while place > 0 && keys[place - 1] > key {
            keys[place] = keys[place - 1];
            place -= 1;
        }
        keys[place] = key;
        count += 1;
    }
    keys.iter().take(count).rev().fold(0, |members, key| members << 4 | key & 15)
}

/// The primitives of leaves that are met (bit i: child i).
#[inline]
fn leaf_primitives(node: &Node, mut met: u32) -> u32 {
    let meta_bytes = u64::from(node.children.z) | (u64::from(node.children.w) << 32);
    let mut result = 0;
    while met != 0 {
        let meta = (meta_bytes >> (8 * met.trailing_zeros())) as u32;
        met &= met - 1;
        result |= ((meta >> 5) & 7) << (meta & 0x1f);
    }
    result
}

/// The planes of the eight children along an axis, in grid units, that a ray meets first and last.
#[inline]
fn near_and_far(bounds: UVec4, inverse: f32) -> ([f32; 8], [f32; 8]) {
    let (minima, maxima) = (unpack_bytes(bounds.x, bounds.y), unpack_bytes(bounds.z, bounds.w));
    if inverse < 0.0 { (maxima, minima) } else { (minima, maxima) }
}

#[inline]
fn unpack_bytes(low: u32, high: u32) -> [f32; 8] {
    let (low, high) = (low.to_le_bytes(), high.to_le_bytes());
    [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]].map(f32::from)
}

/// `max` as one instruction: unlike `f32::max` it takes no care of NaN.
#[inline]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `min` as one instruction: unlike `f32::min` it takes no care of NaN.
#[inline]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
