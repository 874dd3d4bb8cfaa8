//! The order in which a ray visits the children of a node: the nearest first, and the same on both devices.

use crate::support::kernel::evaluate;
use crate::support::placed::*;
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::cpu::geometry::bvh::{inverse_direction, node_intersect};
use gpu_trace::layout::Node;
use gpu_trace::scene::Shape;
use std::sync::Arc;

/// `UNMET` of shaders/geometry/bvh.wgsl.
const UNMET: u32 = 0x7fff_fff0;

/// The members that keys stand for, by sorting them.
fn sorted(mut keys: [u32; 8]) -> u32 {
    keys.sort_unstable();
    keys.iter().rev().fold(0, |members, key| members << 4 | key & 15)
}

/// A network of comparators that sorts all zeros and ones sorts everything (Knuth vol. 3, section 5.3.4, theorem Z).
#[test]
fn the_network_of_comparators_sorts() {
    let keys_of = |high: &dyn Fn(u32) -> u32| std::array::from_fn(|i| high(i as u32) << 4 | 8 | i as u32);
    let mut queries: Vec<[u32; 8]> = (0..256_u32).map(|bits| keys_of(&|i| bits >> i & 1)).collect();
    let mut random = Random(41);
    for _ in 0..2000 {
        let mut keys: [u32; 8] = keys_of(&|_| 0);
        for key in &mut keys {
            *key |= random.bits() & 0x3fff_fff0;
            if random.below(3) == 0 {
                *key = UNMET;
            }
        }
        queries.push(keys);
    }
    let body = "
    low.x = sorted_members(
        bitcast<vec4<i32>>(vec4<u32>(word(0u), word(1u), word(2u), word(3u))),
        bitcast<vec4<i32>>(vec4<u32>(word(4u), word(5u), word(6u), word(7u))));";
    let members = evaluate(&flattened(&scene_of([])), body, &queries);
    let wrong = queries.iter().zip(&members).find(|(keys, members)| sorted(**keys) != members[0]);
    assert_eq!(wrong, None);
    let unsorted = |keys: &[u32; 8]| keys.iter().rev().fold(0, |members, key| members << 4 | key & 15);
    assert!(queries.iter().filter(|keys| unsorted(keys) != sorted(**keys)).count() > 2000, "most keys were in order");
}

/// Where a ray enters the box of a child, in double precision.
fn entry(node: &Node, child: usize, origin: DVec3, direction: DVec3) -> f64 {
    let mut entry = 0.0f64;
    for (axis, bounds) in [node.x, node.y, node.z].into_iter().enumerate() {
        let cell = f32::from_bits((node.grid.w >> (8 * axis) & 0xff) << 23);
        let plane = |words: [u32; 2]| {
            let byte = words[child / 4] >> (8 * (child % 4)) & 0xff;
            let place = f64::from(f32::from_bits(node.grid[axis])) + f64::from(byte) * f64::from(cell);
            (place - origin[axis]) / direction[axis]
        };
        entry = entry.max(plane([bounds.x, bounds.y]).min(plane([bounds.z, bounds.w])));
    }
    entry
}

#[test]
fn children_are_visited_nearest_first_on_both_devices() {
    let ball = Shape::Mesh(Arc::new(bumpy_ball(40)));
    let buffers = flattened(&scene_of([(ball, DAffine3::IDENTITY)]));
    let mut random = Random(42);
    let (mut queries, mut found, mut several, mut backwards) = (Vec::new(), Vec::new(), 0, 0);
    for ray in rays_into(&buffers, &mut random, 2.0, 20_000) {
        // The nodes near the root, which most rays meet.
        let index = random.below(9);
        let node = &buffers.nodes[index];
        let met = node_intersect(node, ray.origin, inverse_direction(ray.direction), ray.t_max);
        let digits: Vec<u32> = (0..8).map(|i| met.children >> (4 * i) & 15).take_while(|&digit| digit != 0).collect();
        assert!(met.children.checked_shr(4 * digits.len() as u32).unwrap_or(0) == 0, "{:#x}", met.children);
        let axial = ray.direction.to_array().contains(&0.0);
        if digits.len() > 1 && !axial {
            let entry =
                |digit: &u32| entry(node, (digit & 7) as usize, ray.origin.as_dvec3(), ray.direction.as_dvec3());
            let entries: Vec<f64> = digits.iter().map(entry).collect();
            let slack = 1e-4 * (ray.origin.length() + 1.0);
            assert!(entries.windows(2).all(|pair| pair[0] <= pair[1] + f64::from(slack)), "{entries:?}");
            backwards += usize::from(entries.windows(2).any(|pair| pair[1] > pair[0] + f64::from(slack)));
            several += 1;
        }
        let Vec3 { x, y, z } = ray.origin;
        let [dx, dy, dz] = ray.direction.to_array();
        let [x, y, z, dx, dy, dz, t_max] = [x, y, z, dx, dy, dz, ray.t_max].map(f32::to_bits);
        queries.push([index as u32, x, y, z, dx, dy, dz, t_max]);
        found.push([met.children, met.primitives]);
    }
    println!("{several} visits meet several children; {backwards} of them would be out of order backwards");
    assert!(several > 500 && backwards * 4 > several, "{several} {backwards}");

    let body = "
    let origin = vec3<f32>(number(1u), number(2u), number(3u));
    let direction = vec3<f32>(number(4u), number(5u), number(6u));
    let met = node_intersect(node_at(word(0u)), origin, inverse_direction(direction), number(7u));
    low = vec4<u32>(met.children, met.primitives, 0u, 0u);";
    let gpu = evaluate(&buffers, body, &queries);
    let same = gpu.iter().zip(&found).filter(|(gpu, cpu)| gpu[..2] == cpu[..]).count();
    println!("{same} of {} are the same on both devices", found.len());
    // Devices may round where two boxes are entered at all but the same place.
    assert!(same * 1000 >= found.len() * 999, "{same} of {}", found.len());
}
