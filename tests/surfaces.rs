//! What `surface_at` says of hits on placed shapes, in double precision.

use crate::support::placed::*;
use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::cpu::geometry::bvh::scene_intersect;
use gpu_trace::cpu::geometry::instance::surface_at;
use gpu_trace::renderer::Tally;
use gpu_trace::scene::{Mesh, Shape};
use std::sync::Arc;

/// Points, normals and sides of balls and cubes under transforms that stretch, shear and mirror, in double precision.
#[test]
fn surfaces_of_transformed_shapes_are_where_double_precision_has_them() {
    let mut random = Random(16);
    let mut worst_point = 0.0f64;
    let mut worst_normal = 0.0f64;
    for round in 0..400 {
        let transform = random.transform(5.0);
        let shape = [Shape::Sphere, Shape::Cube, Shape::Mesh(Arc::new(unit_cube()))][round % 3].clone();
        let is_ball = round % 3 == 0;
        let buffers = flattened(&scene_of([(shape, transform)]));
        let scene = bindings(&buffers);
        for _ in 0..30 {
            let inside = random.below(2) == 0;
            // A point within the shape, and one that may be outside.
            let within = if is_ball { random.point(0.5) } else { random.point(0.45) + 0.5 };
            let outside = within + random.point(1.0).normalize() * 6.0;
            let (from, to) = if inside { (within, outside) } else { (outside, within) };
            let (origin, target) = (transform.transform_point3(from), transform.transform_point3(to));
            let (origin, direction) = (origin.as_vec3(), (target - origin).as_vec3().normalize());
            let mut tally = Tally::default();
            let hit = scene_intersect(&scene, origin, direction, 1e30, &mut tally);
            assert!(hit.t > 0.0);
            let surface = surface_at(&scene, hit, origin, direction);
            assert_eq!(surface.entering, !inside);

            // The nearest point of the surface, in object space, and the outward normal there.
            let point = transform.inverse().transform_point3(surface.point.as_dvec3());
            let (on_surface, normal) = if is_ball {
                (point.normalize(), point)
            } else {
                let centred = point - 0.5;
                let axis = (0..3).max_by(|&a, &b| centred[a].abs().total_cmp(&centred[b].abs())).unwrap();
                let mut face = DVec3::ZERO;
                face[axis] = centred[axis].signum();
                let mut on_face = point;
                on_face[axis] = 0.5 + 0.5 * face[axis];
                (on_face, face)
            };
            let distance = transform.transform_vector3(on_surface - point).length();
            worst_point = worst_point.max(distance / (1.0 + surface.point.length() as f64));
            let outward = (transform.matrix3.inverse().transpose() * normal).normalize();
            let expected = if inside { -outward } else { outward };
            worst_normal = worst_normal.max((surface.geometric_normal.as_dvec3() - expected).length());
            assert!(surface.geometric_normal.dot(direction) < 0.0);
            assert_eq!(surface.shading_normal, surface.geometric_normal);
        }
    }
    println!("worst error: point {worst_point:.2e} of its distance, normal {worst_normal:.2e}");
    assert!(worst_point < 2e-6 && worst_normal < 2e-5, "{worst_point} {worst_normal}");
}

/// The cube as a mesh, counter-clockwise seen from outside.
fn unit_cube() -> Mesh {
    let positions = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { name: "cube".into(), positions, triangles, ..Default::default() }
}

#[test]
fn smooth_normals_are_interpolated_on_the_side_of_the_ray() {
    let mut mesh = quad();
    let slanted = Vec3::new(0.6, 0.8, 0.0);
    mesh.normals = vec![Vec3::Y, slanted, slanted, Vec3::Y];
    // Mirrored in x: the normals lean the other way, and still point up.
    for (sign, mirror) in [(1.0f32, 1.0), (-1.0, -1.0)] {
        let transform = DAffine3::from_scale(DVec3::new(mirror, 1.0, 1.0));
        let buffers = flattened(&scene_of([(Shape::Mesh(Arc::new(mesh.clone())), transform)]));
        let scene = bindings(&buffers);
        for height in [2.0f32, -2.0] {
            for x in [0.1f32, 0.25, 0.5, 0.9] {
                let (origin, direction) = (Vec3::new(sign * x, height, 0.3), Vec3::new(0.0, -height, 0.0));
                let mut tally = Tally::default();
                let hit = scene_intersect(&scene, origin, direction, 1e30, &mut tally);
                assert!((hit.t - 1.0).abs() < 1e-6);
                let surface = surface_at(&scene, hit, origin, direction);
                let lean = (Vec3::Y * (1.0 - x) + slanted * x).normalize() * Vec3::new(sign, 1.0, 1.0);
                let expected = lean * height.signum();
                assert!((surface.shading_normal - expected).length() < 1e-4, "{surface:?} {expected}");
                assert_eq!(surface.geometric_normal, Vec3::Y * height.signum());
                assert_eq!(surface.entering, height > 0.0);
            }
        }
    }
}
