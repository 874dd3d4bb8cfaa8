//! Scenes of placed shapes from random numbers, and their buffers.

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot, Vec3};
use gpu_trace::cpu::bindings::Bindings;
use gpu_trace::cpu::geometry::instance::transform_point;
use gpu_trace::flatten::{SceneBuffers, flatten};
use gpu_trace::layout::SHAPE_MESH;
use gpu_trace::scene::{Geometry, Mesh, Node, NodeId, Scene, SceneGraph, Shape};
use std::sync::Arc;

use super::Stage;

/// A small generator of uniform numbers (O'Neill's PCG-XSH-RR), so that a test's scenes are the same everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u32 {
        let state = self.0;
        self.0 = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let shifted = ((state ^ (state >> 18)) >> 27) as u32;
        shifted.rotate_right((state >> 59) as u32)
    }

    /// In [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.bits()) / 4_294_967_296.0
    }

    pub fn below(&mut self, count: usize) -> usize {
        self.between(0.0, count as f64) as usize
    }

    pub fn point(&mut self, reach: f64) -> DVec3 {
        DVec3::new(self.between(-reach, reach), self.between(-reach, reach), self.between(-reach, reach))
    }

    /// Rotation, translation and scale by factors of up to 4 that differ between the axes; one in three is mirrored.
    pub fn transform(&mut self, reach: f64) -> DAffine3 {
        let angles = self.point(3.0);
        let rotation = DQuat::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
        let mut scale = DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0)).exp2();
        if self.below(3) == 0 {
            scale.x = -scale.x;
        }
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(self.between(-0.5, 0.5), 1.0, 0.0), DVec3::Z);
        let linear = DMat3::from_quat(rotation) * shear * DMat3::from_diagonal(scale);
        DAffine3::from_mat3_translation(linear, self.point(reach))
    }
}

/// A scene with these shapes below the root.
pub fn scene_of(shapes: impl IntoIterator<Item = (Shape, DAffine3)>) -> Scene {
    let mut graph = SceneGraph::default();
    let root = graph.add_node(Node::new("root", None));
    for (shape, transform) in shapes {
        add_child(&mut graph, root, transform, Some(shape));
    }
    scene_with(graph, root)
}

/// Adds a node below another.
pub fn add_child(graph: &mut SceneGraph, parent: NodeId, transform: DAffine3, shape: Option<Shape>) -> NodeId {
    let mut node = Node::new(format!("node {}", graph.nodes.len()), shape.map(Geometry::new));
    node.transform = transform;
    let id = graph.add_node(node);
    graph.node_mut(parent).children.push(id);
    id
}

pub fn scene_with(graph: SceneGraph, root: NodeId) -> Scene {
    Scene { graph: Arc::new(graph), root, ..Stage::new(64, 64).scene }
}

pub fn flattened(scene: &Scene) -> SceneBuffers {
    flatten(scene).unwrap_or_else(|error| panic!("{error}"))
}

/// Why a scene is refused.
pub fn refusal(scene: &Scene) -> String {
    match flatten(scene) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("the scene was not refused"),
    }
}

pub fn bindings(buffers: &SceneBuffers) -> Bindings<'_> {
    Bindings {
        frame: &buffers.frame,
        nodes: &buffers.nodes,
        instances: &buffers.instances,
        triangles: &buffers.triangles,
        materials: &buffers.materials,
        lights: &buffers.lights,
        texels: &buffers.texels,
        has_mist: buffers.features.mist,
    }
}

/// A closed bumpy ball of 4 * `rings`² triangles about the origin, radius about 1.
pub fn bumpy_ball(rings: u32) -> Mesh {
    let mut mesh = Mesh { name: "ball".into(), ..Mesh::default() };
    let across = 2 * rings;
    for row in 0..=rings {
        for column in 0..across {
            let theta = f64::from(row) / f64::from(rings) * std::f64::consts::PI;
            let phi = f64::from(column) / f64::from(rings) * std::f64::consts::PI;
            let radius = 1.0 + 0.1 * (5.0 * theta).sin() * (4.0 * phi).cos();
            let direction = DVec3::new(theta.sin() * phi.cos(), theta.cos(), -theta.sin() * phi.sin());
            mesh.positions.push((radius * direction).as_vec3());
        }
    }
    for row in 0..rings {
        for column in 0..across {
            let (next, left, right) = (row + 1, column, (column + 1) % across);
            mesh.triangles.push([row * across + left, next * across + left, row * across + right]);
            mesh.triangles.push([row * across + right, next * across + left, next * across + right]);
        }
    }
    mesh
}

/// Two triangles: the unit square of x and z, at y = 0, seen from above.
pub fn quad() -> Mesh {
    Mesh {
        name: "quad".into(),
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, 1.0), Vec3::Z],
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        ..Mesh::default()
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
    pub t_max: f32,
}

/// Rays from everywhere, from inside things, along axes, and at places where boxes and triangles end.
pub fn rays_into(buffers: &SceneBuffers, random: &mut Random, reach: f64, count: usize) -> Vec<Ray> {
    let mut targets: Vec<DVec3> = Vec::new();
    for instance in buffers.instances.iter().take(200) {
        let world = |p: Vec3| transform_point(&instance.world_from_object, p).as_dvec3();
        targets.extend([Vec3::ZERO, Vec3::ONE, Vec3::X, Vec3::Y, Vec3::new(0.5, 0.0, 0.5)].map(world));
        if instance.shape == SHAPE_MESH {
            let triangle = &buffers.triangles[random.below(buffers.triangles.len())];
            targets.extend([triangle.p0, triangle.p1, (triangle.p1 + triangle.p2) * 0.5].map(world));
        }
    }
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let mut rays = Vec::new();
    for i in 0..count {
        let target = match i % 4 {
            0 => random.point(reach),
            _ => targets[random.below(targets.len())],
        };
        let (origin, direction) = match i % 7 {
            0 => {
                let axis = axes[random.below(6)];
                // Adding zeros of either sign to the components.
                (target - axis * random.between(0.0, 2.0 * reach), axis * if i % 2 == 0 { 1.0 } else { -1.0 })
            }
            1 => (target, random.point(1.0)),
            2 => {
                let axis = random.below(3);
                let mut direction = random.point(1.0);
                direction[axis] = 0.0;
                (target - direction * reach, direction)
            }
            _ => {
                let origin = random.point(2.0 * reach);
                (origin, target - origin)
            }
        };
        let length = if i % 3 == 0 { 1.0 } else { direction.length().recip() };
        let direction = (direction * length).as_vec3();
        if direction != Vec3::ZERO {
            let t_max = if i % 11 == 0 { random.between(0.1, reach) as f32 } else { 1e30 };
            rays.push(Ray { origin: origin.as_vec3(), direction, t_max });
        }
    }
    rays
}

/// A graph with instancing at two levels, of every shape; some coordinates are whole, so that boxes touch.
pub fn random_scene(random: &mut Random, shapes: usize, with_planes: bool) -> Scene {
    let meshes = [Arc::new(bumpy_ball(6)), Arc::new(quad()), Arc::new(bumpy_ball(3))];
    let mut graph = SceneGraph::default();
    let root = graph.add_node(Node::new("root", None));
    let mut groups = vec![root];
    for i in 0..shapes {
        let shape = match random.below(if with_planes { 9 } else { 8 }) {
            0 => Shape::Sphere,
            1 => Shape::Cube,
            2 => Shape::Cylinder,
            3 => Shape::Cone,
            4 => Shape::Torus { major: 1.0, minor: random.between(0.05, 0.9) },
            8 => Shape::Plane,
            n => Shape::Mesh(meshes[n - 5].clone()),
        };
        let transform = if i % 3 == 0 {
            // Whole steps and quarter turns.
            let turn = DMat3::from_quat(DQuat::from_rotation_x(random.below(4) as f64 * std::f64::consts::FRAC_PI_2));
            let turn = DMat3::from_cols(turn.x_axis.round(), turn.y_axis.round(), turn.z_axis.round());
            DAffine3::from_mat3_translation(turn, random.point(6.0).round())
        } else {
            random.transform(6.0)
        };
        let parent = groups[random.below(groups.len())];
        let id = add_child(&mut graph, parent, transform, Some(shape));
        match random.below(6) {
            // A group that is used twice, and takes further children.
            0 => {
                let group = add_child(&mut graph, root, random.transform(3.0), None);
                let other = add_child(&mut graph, root, random.transform(3.0), None);
                graph.node_mut(other).children.push(group);
                groups.push(group);
            }
            1 => groups.push(id),
            _ => {}
        }
    }
    scene_with(graph, root)
}
