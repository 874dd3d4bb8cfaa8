//! The traversal of the hierarchy against brute force over everything.

use crate::support::placed::*;
use glam::{DAffine3, DMat3, DQuat, DVec3, UVec4, Vec3};
use gpu_trace::cpu::bindings::Bindings;
use gpu_trace::cpu::geometry::bvh::{scene_intersect, scene_occluded};
use gpu_trace::cpu::geometry::hit::MISS;
use gpu_trace::cpu::geometry::instance::{instance_intersect, transform_point, transform_vector};
use gpu_trace::cpu::geometry::plane::plane_intersect;
use gpu_trace::cpu::geometry::triangle::{triangle_intersect, triangle_ray};
use gpu_trace::flatten::SceneBuffers;
use gpu_trace::layout::{
    INSTANCE_SHADES, Instance, Node, SHAPE_MESH, SHAPE_PLANE, STATUS_LOOP_BOUND, STATUS_STACK_FULL,
};
use gpu_trace::renderer::Tally;
use gpu_trace::scene::{Mesh, Node as SceneNode, Shape};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

/// For each node that rays enter meshes at, the triangles below it. Only what leaves there are is read, and no box.
fn triangle_ranges(buffers: &SceneBuffers) -> BTreeMap<u32, Range<u32>> {
    let is_mesh = |instance: &&Instance| instance.shape == SHAPE_MESH;
    let roots: BTreeSet<u32> = buffers.instances.iter().filter(is_mesh).map(|instance| instance.root).collect();
    let below = |root: u32| {
        let mut triangles = BTreeSet::new();
        let mut nodes = vec![root];
        while let Some(index) = nodes.pop() {
            let node = &buffers.nodes[index as usize];
            let metas = [node.children.z, node.children.w].map(u32::to_le_bytes);
            let count: u32 = metas.as_flattened().iter().map(|meta| (meta >> 5).count_ones()).sum();
            triangles.extend(node.children.y..node.children.y + count);
            nodes.extend(node.children.x..node.children.x + (node.grid.w >> 24 & 15));
        }
        let range = *triangles.first().expect("a mesh has triangles")..triangles.last().expect("likewise") + 1;
        assert_eq!(range.len(), triangles.len(), "the triangles below node {root} lie apart");
        range
    };
    let ranges: BTreeMap<u32, Range<u32>> = roots.into_iter().map(|root| (root, below(root))).collect();
    let reached: BTreeSet<u32> = ranges.values().cloned().flatten().collect();
    assert_eq!(reached.len(), buffers.triangles.len());
    ranges
}

/// The least t of a ray's hits, and all hits that have it.
fn brute_force(scene: &Bindings, ranges: &BTreeMap<u32, Range<u32>>, ray: Ray) -> (f32, Vec<(u32, u32)>) {
    let mut nearest = MISS;
    let mut hits = Vec::new();
    let mut add = |t: f32, instance, primitive| {
        if t > 0.0 && (nearest == MISS || t < nearest) {
            nearest = t;
            hits.clear();
        }
        if t > 0.0 && t == nearest {
            hits.push((instance, primitive));
        }
    };
    for (index, instance) in (0..).zip(scene.instances) {
        let origin = transform_point(&instance.object_from_world, ray.origin);
        let direction = transform_vector(&instance.object_from_world, ray.direction);
        match instance.shape {
            SHAPE_PLANE => {
                let hit = plane_intersect(origin, direction, ray.t_max);
                add(hit.t, index, hit.face);
            }
            SHAPE_MESH => {
                let sheared = triangle_ray(origin, direction);
                for i in ranges[&instance.root].clone() {
                    let triangle = &scene.triangles[i as usize];
                    let hit = triangle_intersect(&sheared, triangle.p0, triangle.p1, triangle.p2, ray.t_max);
                    add(hit.t, index, i);
                }
            }
            _ => {
                let hit = instance_intersect(scene, index, instance.shape, origin, direction, ray.t_max);
                add(hit.t, index, hit.face);
            }
        }
    }
    (nearest, hits)
}

#[derive(Debug, Default)]
struct Comparison {
    rays: usize,
    hits: usize,
    ties: usize,
    different: Vec<String>,
}

/// Traces the rays both ways: nearest hits have to be the same to the bit, and occlusion has to agree with them for
/// a range that ends before, at and after the hit.
fn compare(buffers: &SceneBuffers, rays: &[Ray]) -> Comparison {
    let scene = bindings(buffers);
    let ranges = triangle_ranges(buffers);
    let mut result = Comparison { rays: rays.len(), ..Comparison::default() };
    for &ray in rays {
        let (t, candidates) = brute_force(&scene, &ranges, ray);
        let mut tally = Tally::default();
        let hit = scene_intersect(&scene, ray.origin, ray.direction, ray.t_max, &mut tally);
        let same = hit.t == t && (t == MISS || candidates.contains(&(hit.instance, hit.primitive)));
        let mut occlusion = vec![(ray.t_max, t > 0.0)];
        if t > 0.0 {
            result.hits += 1;
            result.ties += usize::from(candidates.len() > 1);
            // Beyond by more than the error of a hit at grazing incidence.
            let beyond = t * 1.001 + 1e-5 * ray.origin.length() / ray.direction.length();
            occlusion.extend([(t * 0.999, false), (t, false), (beyond, true)]);
        }
        let wrong = occlusion.into_iter().find(|&(t_max, expected)| {
            scene_occluded(&scene, ray.origin, ray.direction, t_max, &mut tally) != expected
        });
        if !same || wrong.is_some() || tally.flags != 0 {
            let flags = tally.flags;
            result.different.push(format!(
                "{ray:?}: {hit:?} where brute force has {t} {candidates:?}; occlusion {wrong:?}; flags {flags}"
            ));
        }
    }
    result
}

fn assert_same(name: &str, buffers: &SceneBuffers, rays: &[Ray]) -> Comparison {
    let result = compare(buffers, rays);
    println!("{name}: {} rays, {} hits, {} ties", result.rays, result.hits, result.ties);
    let count = result.different.len();
    assert!(count == 0, "{name}: {count} of {} differ, the first: {}", result.rays, result.different[0]);
    result
}

#[test]
fn random_scenes_are_traversed_as_by_brute_force() {
    let mut random = Random(11);
    let mut hits = 0;
    let mut ties = 0;
    for round in 0..40 {
        let shapes = [1, 2, 5, 20, 80][round % 5];
        let buffers = flattened(&random_scene(&mut random, shapes, round % 2 == 0));
        let rays = rays_into(&buffers, &mut random, 8.0, 1500);
        let result = assert_same(&format!("{} instances", buffers.instances.len()), &buffers, &rays);
        hits += result.hits;
        ties += result.ties;
    }
    assert!(hits > 10_000 && ties > 100, "{hits} hits and {ties} ties are too few to say much");
}

#[test]
fn large_and_small_and_far_scenes_are_too() {
    let mut random = Random(12);
    for (scale, offset) in [(1e-4, 0.0), (1e4, 0.0), (1.0, 3e3), (1e-2, 100.0)] {
        let inner = random_scene(&mut random, 30, false);
        let mut graph = (*inner.graph).clone();
        let root = graph.add_node(SceneNode::new("outer", None));
        graph.node_mut(root).transform = DAffine3::from_scale_rotation_translation(
            DVec3::splat(scale),
            DQuat::from_rotation_z(0.3),
            DVec3::splat(offset),
        );
        graph.node_mut(root).children.push(inner.root);
        let buffers = flattened(&scene_with(graph, root));
        let rays: Vec<Ray> = rays_into(&flattened(&inner), &mut random, 8.0, 4000)
            .into_iter()
            .map(|ray| Ray { origin: ray.origin * scale as f32 + offset as f32, ..ray })
            .collect();
        let result = assert_same(&format!("scale {scale}, offset {offset}"), &buffers, &rays);
        assert!(result.hits > 100);
    }
}

#[test]
fn meshes_of_thousands_of_triangles_are_too() {
    // In a crowd they are entered below their roots, by themselves at these; a little apart they are none, unless the
    // boxes around them were loose.
    for (distance, in_parts) in [(2.0, true), (2.5, false), (25.0, false)] {
        let mut random = Random(13);
        let ball = Arc::new(bumpy_ball(40));
        let place = |i: u32| {
            let centre = DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9)) * distance - distance;
            (Shape::Mesh(ball.clone()), DAffine3::from_translation(centre) * random.transform(0.0))
        };
        let buffers = flattened(&scene_of((0..27).map(place).collect::<Vec<_>>()));
        assert_eq!(buffers.statistics.instances, 27);
        assert_eq!(buffers.instances.len() > 2 * 27, in_parts, "{} members", buffers.instances.len());
        let rays = rays_into(&buffers, &mut Random(14), 2.0 * distance, 1500);
        let result = assert_same("27 balls of 6,400 triangles", &buffers, &rays);
        assert!(result.hits > 500);
    }
}

/// A floor of unit squares, seen straight down at corners, along edges and in the middle: nothing may slip through.
#[test]
fn flat_axis_aligned_meshes_are_never_missed() {
    let quad = Arc::new(quad());
    let turns = [
        DMat3::IDENTITY,
        DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
        DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
        DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)),
    ];
    for (turn, height) in turns.into_iter().zip([0.0, 1.0 / 3.0, 1000.1, -7.0]) {
        let mut shapes = Vec::new();
        for x in 0..16 {
            for z in 0..16 {
                let corner = DVec3::new(f64::from(x), height, f64::from(z));
                let placed = DAffine3::from_mat3(turn) * DAffine3::from_translation(corner);
                shapes.push((Shape::Mesh(quad.clone()), placed));
            }
        }
        let buffers = flattened(&scene_of(shapes));
        let mut rays = Vec::new();
        for x in 1..64 {
            for z in 1..64 {
                let at = DVec3::new(f64::from(x) * 0.25, height, f64::from(z) * 0.25);
                for sign in [1.0, -1.0] {
                    let above = at + DVec3::Y * 5.0 * sign;
                    for lean in [DVec3::ZERO, DVec3::new(0.3, 0.0, -0.7)] {
                        let direction = (turn * (at + lean - above - lean)).as_vec3();
                        rays.push(Ray { origin: (turn * above).as_vec3(), direction, t_max: 1e30 });
                        let slanted = (turn * (at - above - lean)).as_vec3();
                        rays.push(Ray { origin: (turn * (above + lean)).as_vec3(), direction: slanted, t_max: 1e30 });
                    }
                }
            }
        }
        let result = assert_same(&format!("floor at {height}"), &buffers, &rays);
        assert_eq!(result.hits, rays.len(), "rays slipped through the floor at {height}");
    }
}

/// Rays that run within the faces of boxes, through shared edges and corners.
#[test]
fn rays_in_the_faces_of_stacked_cubes_are_as_by_brute_force() {
    let cubes = (0..64).map(|i| {
        let corner = DVec3::new(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16));
        (Shape::Cube, DAffine3::from_translation(corner))
    });
    let buffers = flattened(&scene_of(cubes));
    let mut rays = Vec::new();
    for a in 0..=16 {
        for b in 0..=16 {
            let (a, b) = (a as f32 * 0.25, b as f32 * 0.25);
            for axis in 0..3 {
                for (start, step) in [(-3.0, 1.0), (7.0, -1.0), (2.0, 1.0), (1.5, -1.0)] {
                    for zero in [0.0, -0.0] {
                        let mut origin = Vec3::new(a, b, b);
                        origin[axis] = start;
                        origin[(axis + 1) % 3] = a;
                        let mut direction = Vec3::splat(zero);
                        direction[axis] = step;
                        rays.push(Ray { origin, direction, t_max: 1e30 });
                        // Diagonals through edges and corners.
                        direction[(axis + 1) % 3] = step;
                        rays.push(Ray { origin, direction, t_max: 1e30 });
                        rays.push(Ray { origin, direction: Vec3::splat(step), t_max: 1e30 });
                    }
                }
            }
        }
    }
    let result = assert_same("stacked cubes", &buffers, &rays);
    assert!(result.hits > rays.len() / 3 && result.ties > 100);
}

type Breakage = fn(&mut Node);

/// The comparison has to notice boxes that are too small or in the wrong place, and children that are not visited.
#[test]
fn the_comparison_notices_a_broken_hierarchy() {
    let mut random = Random(15);
    let sound = flattened(&random_scene(&mut random, 60, false));
    let rays = rays_into(&sound, &mut random, 8.0, 4000);
    assert_same("sound", &sound, &rays);

    let breakages: [(&str, Breakage); 3] = [
        ("a box that is a quarter too short", |node| {
            let shorten = |bytes: u32| u32::from_le_bytes(bytes.to_le_bytes().map(|byte| byte - byte / 4));
            node.x = UVec4::new(node.x.x, node.x.y, shorten(node.x.z), shorten(node.x.w));
        }),
        ("no inner children, and empty leaves", |node| {
            node.grid.w &= 0x00ff_ffff;
            node.children.z = 0;
        }),
        ("a misplaced grid", |node| node.grid.y = (f32::from_bits(node.grid.y) + 3.0).to_bits()),
    ];
    for (name, breakage) in breakages {
        // The root over the instances, and the roots of all meshes.
        let roots = triangle_ranges(&sound).into_keys().collect::<Vec<_>>();
        for targets in [vec![0], roots] {
            let mut broken = sound.clone();
            targets.iter().for_each(|&root| breakage(&mut broken.nodes[root as usize]));
            let scene = bindings(&broken);
            let ranges = triangle_ranges(&sound);
            let different = rays.iter().filter(|ray| {
                let mut tally = Tally::default();
                let hit = scene_intersect(&scene, ray.origin, ray.direction, ray.t_max, &mut tally);
                hit.t != brute_force(&bindings(&sound), &ranges, **ray).0
            });
            let count = different.count();
            println!("{name} at {targets:?}: {count} of {} rays differ", rays.len());
            assert!(count > 10, "{name} at {targets:?} went unnoticed");
        }
    }
}

/// Bounds along an axis of eight children that fill the grid.
const WHOLE: UVec4 = UVec4::new(0, 0, u32::MAX, u32::MAX);

/// A hierarchy that leads back to itself, as no scene makes: the bounds end the loop, and say so.
#[test]
fn loop_and_stack_bounds_are_reported() {
    let mut buffers = flattened(&scene_of((0..200).map(|i| {
        (Shape::Sphere, DAffine3::from_translation(DVec3::new(f64::from(i % 20), f64::from(i / 20), 0.0) * 3.0))
    })));
    let ray = Ray { origin: Vec3::new(-9.0, -9.0, 0.0), direction: Vec3::new(3.0, 2.9, 0.0), t_max: 1e30 };
    assert_same("sound", &buffers, &[ray]);
    for node in &mut buffers.nodes {
        // Three children, all of them inner nodes, fill the box; there is no way out.
        node.grid.w = node.grid.w & 0x00ff_ffff | 0x0300_0000;
        node.children = UVec4::new(0, node.children.y, 0, 0);
        (node.x, node.y, node.z) = (WHOLE, WHOLE, WHOLE);
    }
    assert!(buffers.nodes.len() >= 3);
    let mut tally = Tally::default();
    let hit = scene_intersect(&bindings(&buffers), ray.origin, ray.direction, ray.t_max, &mut tally);
    assert_eq!((hit.t, tally.flags), (MISS, STATUS_LOOP_BOUND | STATUS_STACK_FULL));
}

/// One mesh alone is entered without a hierarchy over it, several by one.
#[test]
fn meshes_that_cast_no_shadow_are_seen_and_occlude_nothing() {
    let quad = Arc::new(quad());
    for count in [1, 2, 20] {
        let place = |i| DAffine3::from_translation(DVec3::new(0.0, -f64::from(i), 0.0));
        let mut buffers = flattened(&scene_of((0..count).map(|i| (Shape::Mesh(quad.clone()), place(i)))));
        let met = |buffers: &SceneBuffers| {
            let (scene, origin, mut tally) = (bindings(buffers), Vec3::new(0.3, 1.0, 0.6), Tally::default());
            let seen = scene_intersect(&scene, origin, Vec3::NEG_Y, 100.0, &mut tally).t > 0.0;
            (seen, scene_occluded(&scene, origin, Vec3::NEG_Y, 100.0, &mut tally))
        };
        assert_eq!(met(&buffers), (true, true), "{count} meshes");
        buffers.instances.iter_mut().for_each(|instance| instance.flags &= !INSTANCE_SHADES);
        assert_eq!(met(&buffers), (true, false), "{count} meshes without shadow");
    }
}

/// An instance's box is put together of many; each end of a turned row of triangles has to be in it.
#[test]
fn turned_meshes_are_met_at_every_triangle() {
    let count = 150;
    let corner = |i: u32| 2.0 * i as f32;
    let mesh = Arc::new(Mesh {
        positions: (0..count)
            .flat_map(|i| [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, z)| Vec3::new(corner(i) + x, 0.0, z)))
            .collect(),
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Mesh::default()
    });
    // Two instances, since one alone is entered without its box; and a crowd, whose rows are in parts with own boxes.
    for (instances, distance, in_parts) in [(2, 50.0, false), (6, 2.0, true)] {
        let lifted = |i: u32| DAffine3::from_translation(DVec3::Y * distance * f64::from(i));
        let maps: Vec<DAffine3> = (0..instances).map(|i| lifted(i) * DAffine3::from_rotation_y(0.7)).collect();
        let buffers = flattened(&scene_of(maps.iter().map(|map| (Shape::Mesh(mesh.clone()), *map))));
        assert_eq!(buffers.instances.len() > maps.len(), in_parts, "{} members", buffers.instances.len());
        for map in maps {
            for i in 0..count {
                let target = map.transform_point3(DVec3::new(f64::from(corner(i)) + 0.25, 0.0, 0.25)).as_vec3();
                let (origin, mut tally) = (target + Vec3::Y, Tally::default());
                let hit = scene_intersect(&bindings(&buffers), origin, Vec3::NEG_Y, 10.0, &mut tally);
                assert!((hit.t - 1.0).abs() < 1e-4, "triangle {i}: {hit:?}");
            }
        }
    }
}
