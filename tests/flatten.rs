//! The geometry that scenes become: paths of the graph, transforms, meshes, and what is refused.

use crate::support::placed::*;
use glam::{DAffine3, DVec3, Vec2, Vec3, Vec4};
use gpu_trace::cpu::geometry::bvh::scene_intersect;
use gpu_trace::cpu::geometry::instance::{transform_point, transform_vector};
use gpu_trace::cpu::geometry::triangle::decode_octahedral;
use gpu_trace::flatten::{SceneBuffers, Statistics, TRAVERSAL_STACK, encode_octahedral};
use gpu_trace::layout::{Instance, SHAPE_CUBE, SHAPE_PLANE, SHAPE_SPHERE, TRIANGLE_SMOOTH};
use gpu_trace::renderer::Tally;
use gpu_trace::scene::{Mesh, Node, NodeId, SceneGraph, Shape};
use gpu_trace::shader::part;
use std::collections::HashSet;
use std::sync::Arc;
use std::time::Instant;

fn translation(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// Images of the origin under each instance's transform, sorted.
fn origins(buffers: &SceneBuffers) -> Vec<[f32; 3]> {
    let origin = |instance: &Instance| instance.world_from_object.map(|row| row.w);
    let mut origins: Vec<_> = buffers.instances.iter().map(origin).collect();
    origins.sort_by(|a, b| a.partial_cmp(b).unwrap());
    origins
}

#[test]
fn instancing_copies_no_triangles() {
    let mesh = Arc::new(bumpy_ball(8));
    let one = flattened(&scene_of([(Shape::Mesh(mesh.clone()), DAffine3::IDENTITY)]));
    let many = (0..1000).map(|i| (Shape::Mesh(mesh.clone()), translation(3.0 * f64::from(i), 0.0, 0.0)));
    let many = flattened(&scene_of(many));
    assert_eq!(one.triangles.len(), mesh.triangles.len() - one.statistics.degenerate_triangles);
    assert_eq!(many.triangles, one.triangles);
    assert_eq!(many.instances.len(), 1000);
    assert_eq!(many.statistics.meshes, 1);
    assert_eq!(many.statistics.instanced_triangles, 1000 * one.triangles.len() as u64);
    let roots: HashSet<u32> = many.instances.iter().map(|instance| instance.root).collect();
    assert_eq!(roots.len(), 1);
}

#[test]
fn the_same_mesh_is_the_same_allocation() {
    // Equal meshes in different places are two: scripts share by reference.
    let shapes = [Shape::Mesh(Arc::new(quad())), Shape::Mesh(Arc::new(quad()))];
    let buffers = flattened(&scene_of(shapes.map(|shape| (shape, DAffine3::IDENTITY))));
    assert_eq!((buffers.statistics.meshes, buffers.triangles.len()), (2, 4));
}

#[test]
fn each_path_is_an_instance_with_the_product_of_its_transforms() {
    // Two parents share an arm, the arm holds two balls and the upper ball has a child: 2 * 3 paths.
    let mut graph = SceneGraph::default();
    let root = graph.add_node(Node::new("root", None));
    let left = add_child(&mut graph, root, translation(-10.0, 0.0, 0.0), None);
    let right = add_child(&mut graph, root, DAffine3::from_scale(DVec3::new(-2.0, 1.0, 1.0)), None);
    let arm = add_child(&mut graph, left, translation(1.0, 0.0, 0.0), None);
    graph.node_mut(right).children.push(arm);
    add_child(&mut graph, arm, translation(0.0, 2.0, 0.0), Some(Shape::Sphere));
    let upper = add_child(&mut graph, arm, translation(0.0, 3.0, 0.0), Some(Shape::Cube));
    // A shape's own placement does not reach its node's children.
    graph.node_mut(upper).geometry.as_mut().unwrap().placement = translation(100.0, 0.0, 0.0);
    add_child(&mut graph, upper, translation(0.0, 0.0, 4.0), Some(Shape::Sphere));
    let buffers = flattened(&scene_with(graph, root));
    let expected =
        [[-202.0, 3.0, 0.0], [-9.0, 2.0, 0.0], [-9.0, 3.0, 4.0], [-2.0, 2.0, 0.0], [-2.0, 3.0, 4.0], [91.0, 3.0, 0.0]];
    assert_eq!(origins(&buffers), expected);
}

#[test]
fn both_transforms_are_the_double_precision_ones_rounded() {
    let mut random = Random(1);
    for _ in 0..300 {
        // Three transforms one below the other, and the worst of them undone by hand in double precision.
        let chain = [random.transform(50.0), random.transform(5.0), random.transform(500.0)];
        let mut graph = SceneGraph::default();
        let root = graph.add_node(Node::new("root", None));
        let mut parent = root;
        for (i, transform) in chain.iter().enumerate() {
            parent = add_child(&mut graph, parent, *transform, (i == 2).then_some(Shape::Sphere));
        }
        let buffers = flattened(&scene_with(graph, root));
        let exact = chain[0] * chain[1] * chain[2];
        for (rows, exact) in
            [(buffers.instances[0].world_from_object, exact), (buffers.instances[0].object_from_world, exact.inverse())]
        {
            for _ in 0..10 {
                let point = random.point(10.0);
                let single = point.as_vec3();
                let size = exact.matrix3.abs() * point.abs() + exact.translation.abs();
                let error =
                    (transform_point(&rows, single).as_dvec3() - exact.transform_point3(single.as_dvec3())).abs();
                assert!(error.cmple(size * 4e-7).all(), "{error} of {size}");
                let image = exact.transform_vector3(single.as_dvec3());
                let error = (transform_vector(&rows, single).as_dvec3() - image).abs();
                assert!(error.cmple(size * 4e-7).all(), "{error} of {size}");
            }
        }
    }
}

#[test]
fn transforms_that_cannot_be_inverted_name_their_node() {
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let rotation = DAffine3::from_rotation_x(0.7);
    // Rounding makes the determinant of the second one 1e-17 or so, not 0.
    for transform in [flat, rotation * flat * DAffine3::from_rotation_z(1.1), DAffine3::from_scale(DVec3::splat(0.0))] {
        let mut graph = SceneGraph::default();
        let root = graph.add_node(Node::new("root", None));
        let inner = add_child(&mut graph, root, transform, None);
        graph.node_mut(inner).name = "flattened".into();
        add_child(&mut graph, inner, DAffine3::IDENTITY, Some(Shape::Sphere));
        let message = refusal(&scene_with(graph, root));
        assert!(message.contains("'flattened'") && message.contains("inverted"), "{message}");
    }
    for bad in [f64::NAN, f64::INFINITY] {
        let message = refusal(&scene_of([(Shape::Cube, translation(bad, 0.0, 0.0))]));
        assert!(message.contains("'node 1'") && message.contains("not finite"), "{message}");
    }
    for size in [1e-200, 1e200] {
        let message = refusal(&scene_of([(Shape::Cube, DAffine3::from_scale(DVec3::splat(size)))]));
        assert!(message.contains("'node 1'"), "{message}");
    }
    let message = refusal(&scene_of([(Shape::Cube, translation(1e13, 0.0, 0.0))]));
    assert!(message.contains("'node 1'") && message.contains("1e12"), "{message}");
    // Thin, but not flat; and a flat group without a shape is nobody's concern.
    let thin = rotation * DAffine3::from_scale(DVec3::new(1.0, 1e-6, 1.0));
    assert_eq!(flattened(&scene_of([(Shape::Cube, thin)])).instances.len(), 1);
    let mut graph = SceneGraph::default();
    let root = graph.add_node(Node::new("root", None));
    add_child(&mut graph, root, flat, None);
    assert!(flattened(&scene_with(graph, root)).instances.is_empty());
}

#[test]
fn deep_graphs_cycles_and_explosions_of_paths_end_well() {
    let mut graph = SceneGraph::default();
    let root = graph.add_node(Node::new("root", None));
    let mut parent = root;
    for _ in 0..100_000 {
        parent = add_child(&mut graph, parent, translation(0.0, 1e-3, 0.0), None);
    }
    add_child(&mut graph, parent, DAffine3::IDENTITY, Some(Shape::Sphere));
    let last = parent;
    let deep = flattened(&scene_with(graph.clone(), root));
    assert!((deep.instances[0].world_from_object[1].w - 100.0).abs() < 1e-4);

    graph.node_mut(last).children.push(NodeId(50));
    let message = refusal(&scene_with(graph, root));
    assert!(message.contains("its own descendant"), "{message}");

    // Each of 60 groups holds the next one twice.
    for shape in [None, Some(Shape::Sphere)] {
        let mut graph = SceneGraph::default();
        let root = graph.add_node(Node::new("root", None));
        let mut parent = root;
        for _ in 0..60 {
            let child = add_child(&mut graph, parent, translation(1.0, 0.0, 0.0), None);
            graph.node_mut(parent).children.push(child);
            parent = child;
        }
        let explosive = shape.is_some();
        add_child(&mut graph, parent, DAffine3::IDENTITY, shape);
        let scene = scene_with(graph, root);
        if explosive {
            let message = refusal(&scene);
            assert!(message.contains("1152921504606846976 instances"), "{message}");
        } else {
            assert!(flattened(&scene).instances.is_empty());
        }
    }
}

#[test]
fn planes_come_first_and_stay_outside_the_hierarchy() {
    let shapes = [Shape::Sphere, Shape::Plane, Shape::Cube, Shape::Plane];
    let buffers = flattened(&scene_of(shapes.map(|shape| (shape, DAffine3::IDENTITY))));
    let kinds: Vec<u32> = buffers.instances.iter().map(|instance| instance.shape).collect();
    assert_eq!(kinds[..2], [SHAPE_PLANE, SHAPE_PLANE]);
    assert_eq!(kinds[2..].iter().collect::<HashSet<_>>(), HashSet::from([&SHAPE_SPHERE, &SHAPE_CUBE]));
    assert_eq!((buffers.frame.plane_count, buffers.frame.bounded_count), (2, 2));
    let planes = flattened(&scene_of([(Shape::Plane, DAffine3::IDENTITY)]));
    assert_eq!((planes.frame.plane_count, planes.frame.bounded_count, planes.nodes.len()), (1, 0, 0));
    let nothing = flattened(&scene_of([]));
    assert_eq!((nothing.frame.plane_count, nothing.frame.bounded_count, nothing.instances.len()), (0, 0, 0));
}

#[test]
fn triangles_without_an_area_are_left_out() {
    let mut mesh = quad();
    mesh.positions.push(Vec3::new(2.0, 0.0, 2.0));
    mesh.triangles.extend([[0, 0, 1], [1, 1, 1], [0, 2, 4], [3, 1, 3]]);
    let buffers = flattened(&scene_of([(Shape::Mesh(Arc::new(mesh)), DAffine3::IDENTITY)]));
    assert_eq!((buffers.triangles.len(), buffers.statistics.degenerate_triangles), (2, 4));

    // A mesh of nothing else leaves no instance.
    let line = Mesh { positions: vec![Vec3::ZERO, Vec3::X], triangles: vec![[0, 1, 0]], ..Mesh::default() };
    let shapes = [Shape::Mesh(Arc::new(line)), Shape::Mesh(Arc::new(Mesh::default())), Shape::Sphere];
    let buffers = flattened(&scene_of(shapes.map(|shape| (shape, DAffine3::IDENTITY))));
    assert_eq!((buffers.instances.len(), buffers.triangles.len()), (1, 0));

    // Tiny triangles are triangles.
    let mut tiny = quad();
    tiny.positions.iter_mut().for_each(|position| *position *= 1e-12);
    let buffers = flattened(&scene_of([(Shape::Mesh(Arc::new(tiny)), DAffine3::from_scale(DVec3::splat(1e12)))]));
    assert_eq!(buffers.triangles.len(), 2);
}

#[test]
fn meshes_that_contradict_themselves_are_refused() {
    let refused = |change: &dyn Fn(&mut Mesh), part: &str| {
        let mut mesh = quad();
        change(&mut mesh);
        let message = refusal(&scene_of([(Shape::Mesh(Arc::new(mesh)), DAffine3::IDENTITY)]));
        assert!(message.contains("mesh 'quad'") && message.contains(part), "{message}");
    };
    refused(&|mesh| mesh.triangles.push([0, 1, 4]), "vertex 4");
    refused(&|mesh| mesh.positions[2].y = f32::NAN, "vertex 2");
    refused(&|mesh| mesh.positions[1].x = 1e13, "vertex 1");
    refused(&|mesh| mesh.normals = vec![Vec3::Y; 3], "3 normals for 4 vertices");
    refused(&|mesh| mesh.uvs = vec![Vec2::ZERO; 5], "5 texture coordinates");
    refused(&|mesh| mesh.uvs = vec![Vec2::NAN; 4], "texture coordinate");
}

#[test]
fn the_builder_and_the_kernel_agree_on_the_stack() {
    let kernel = part("shaders/geometry/bvh.wgsl").unwrap().text;
    assert!(kernel.contains(&format!("const TRAVERSAL_STACK: u32 = {TRAVERSAL_STACK}u;")));
}

#[test]
fn octahedral_normals_come_back() {
    let mut random = Random(2);
    let mut worst = 0.0f64;
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    let directions = (0..20_000).map(|_| random.point(1.0).as_vec3().normalize());
    for direction in axes.into_iter().chain(directions) {
        let decoded = decode_octahedral(encode_octahedral(direction));
        worst = worst.max((decoded.as_dvec3() - direction.as_dvec3()).length());
    }
    println!("worst error of an octahedral normal: {worst:.2e}");
    assert!(worst < 7e-5, "{worst}");
}

#[test]
fn corners_keep_their_normals_and_texture_coordinates() {
    let mut mesh = quad();
    mesh.normals = vec![Vec3::new(0.6, 0.8, 0.0), Vec3::ZERO, Vec3::new(0.0, 3.0, 4.0), -Vec3::X];
    mesh.uvs = vec![Vec2::new(-1.0, 0.5), Vec2::new(3.0, 0.5), Vec2::new(3.0, 0.75), Vec2::new(0.0, 0.5)];
    let buffers = flattened(&scene_of([(Shape::Mesh(Arc::new(mesh.clone())), DAffine3::IDENTITY)]));
    assert_eq!(buffers.instances[0].parameters, Vec4::new(-1.0, 0.5, 4.0, 0.25));
    let rectangle = buffers.instances[0].parameters;
    let decode_uv = |packed: u32| {
        let unit = Vec2::new((packed & 0xffff) as f32, (packed >> 16) as f32) / 65535.0;
        Vec2::new(rectangle.x, rectangle.y) + unit * Vec2::new(rectangle.z, rectangle.w)
    };
    for triangle in &buffers.triangles {
        assert_eq!(triangle.flags, TRIANGLE_SMOOTH);
        let corners = [
            (triangle.p0, triangle.n0, triangle.uv0),
            (triangle.p1, triangle.n1, triangle.uv1),
            (triangle.p2, triangle.n2, triangle.uv2),
        ];
        for (position, normal, uv) in corners {
            let vertex = mesh.positions.iter().position(|p| *p == position).unwrap();
            // Vertex 1 has no normal, so it has the face's.
            let expected = mesh.normals[vertex].try_normalize().unwrap_or(Vec3::Y);
            assert!((decode_octahedral(normal) - expected).length() < 1e-4, "vertex {vertex}");
            assert!((decode_uv(uv) - mesh.uvs[vertex]).abs().max_element() < 1e-4, "vertex {vertex}");
        }
    }
    // Without normals, or with none that has a length, the mesh is flat.
    for normals in [vec![], vec![Vec3::ZERO; 4]] {
        let mesh = Mesh { normals, ..quad() };
        let buffers = flattened(&scene_of([(Shape::Mesh(Arc::new(mesh)), DAffine3::IDENTITY)]));
        assert!(buffers.triangles.iter().all(|triangle| triangle.flags == 0));
    }
}

/// Boxes that make builders quadratic, or trees as deep as they are large.
#[test]
fn many_and_awkward_instances_are_flattened_in_seconds() {
    let ball = |radius: f64, centre: DVec3| {
        (Shape::Sphere, DAffine3::from_translation(centre) * DAffine3::from_scale(DVec3::splat(radius)))
    };
    let count = 100_000;
    let numbers = || (0..count).map(f64::from);
    let mut random = Random(4);
    let scenes: [(&str, Vec<(Shape, DAffine3)>); 7] = [
        ("scattered", (0..count).map(|_| ball(random.between(0.01, 1.0), random.point(100.0))).collect()),
        ("in one place", numbers().map(|_| ball(1.0, DVec3::ZERO)).collect()),
        ("in a row", numbers().map(|i| ball(1.0, DVec3::X * 2.0 * i)).collect()),
        ("nested", numbers().map(|i| ball(1.0 + i, DVec3::ZERO)).collect()),
        ("halving", (0..50).map(|i| ball(0.5f64.powi(i), DVec3::ZERO)).collect()),
        ("halving in a corner", (0..50).map(|i| ball(0.5f64.powi(i), DVec3::splat(0.5f64.powi(i)))).collect()),
        (
            "in a square",
            numbers().map(|i| ball(1.0, DVec3::new(2.0 * (i % 300.0), 0.0, 2.0 * (i / 300.0).floor()))).collect(),
        ),
    ];
    for (name, shapes) in scenes {
        let start = Instant::now();
        let expected = shapes.len();
        let buffers = flattened(&scene_of(shapes));
        let seconds = start.elapsed().as_secs_f64();
        let Statistics { depth, .. } = buffers.statistics;
        println!("{expected} balls {name}: {} nodes, {depth} levels, {seconds:.2} s", buffers.nodes.len());
        assert_eq!(buffers.instances.len(), expected);
        assert!(depth <= 40, "{depth} levels");
        // A ray from afar to each of some balls, and one from its centre, within all the bounds.
        let scene = bindings(&buffers);
        for instance in buffers.instances.iter().step_by(expected / 10) {
            let centre = transform_point(&instance.world_from_object, Vec3::ZERO);
            let outside = Vec3::new(3e5, 2e5, 1e5);
            for (origin, direction) in [(outside, (centre - outside).normalize()), (centre, Vec3::new(0.6, 0.7, -0.3))]
            {
                let mut tally = Tally::default();
                let hit = scene_intersect(&scene, origin, direction, 1e30, &mut tally);
                assert!(hit.t > 0.0 && tally.flags == 0, "{name}: {hit:?}, flags {}", tally.flags);
            }
        }
    }
}
