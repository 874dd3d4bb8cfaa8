//! Scenes built in a few lines, and pictures of them from either renderer.

pub mod function_table;
pub mod kernel;
pub mod oracle;
pub mod placed;
pub mod rays;

use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::device::{DeviceChoice, open_renderer};
use gpu_trace::film::Film;
use gpu_trace::flatten::flatten;
use gpu_trace::render::{RenderOptions, Rendered, Unattended, render};
use gpu_trace::scene::{
    Background, Camera, Conventions, Geometry, Light, LightExtent, Material, MaterialId, Node, NodeId, Sampling, Scene,
    SceneGraph, Shape, Transfer,
};
use std::sync::Arc;

/// Both renderers, by the names that `--device` takes.
pub const BOTH: [DeviceChoice; 2] = [DeviceChoice::Cpu, DeviceChoice::Gpu];

/// A black, unlit scene with a camera at the origin that looks down -z: add to it what the test is about.
pub struct Stage {
    pub scene: Scene,
    graph: SceneGraph,
    root: NodeId,
}

impl Stage {
    pub fn new(width: u32, height: u32) -> Self {
        let mut graph = SceneGraph::default();
        let root = graph.add_node(Node::new("root", None));
        let scene = Scene {
            graph: Arc::new(SceneGraph::default()),
            root,
            camera: Camera {
                eye: DVec3::ZERO,
                forward: DVec3::NEG_Z,
                up: DVec3::Y,
                fov: 60.0,
                lens_edge: 0.0,
                focus_distance: 1.0,
            },
            ambient: Vec3::ZERO,
            lights: Vec::new(),
            background: Background { bottom: Vec3::ZERO, top: Vec3::ZERO, ..Background::default() },
            sampling: Sampling::default(),
            conventions: Conventions::default(),
            output: "unused.png".into(),
            size: [width, height],
            transfer: Transfer::Linear,
        };
        Stage { scene, graph, root }
    }

    pub fn add(&mut self, shape: Shape, transform: DAffine3, material: Material) -> &mut Self {
        let material = self.add_material(material);
        self.add_with(shape, transform, material)
    }

    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.graph.add_material(material)
    }

    /// Adds a shape whose material others may share.
    pub fn add_with(&mut self, shape: Shape, transform: DAffine3, material: MaterialId) -> &mut Self {
        let mut node = Node::new("shape", Some(Geometry::new(shape)));
        node.transform = transform;
        node.material = Some(material);
        let id = self.graph.add_node(node);
        self.graph.node_mut(self.root).children.push(id);
        self
    }

    /// An axis-aligned box between two corners.
    pub fn add_box(&mut self, low: DVec3, high: DVec3, material: Material) -> &mut Self {
        let placed = DAffine3::from_translation(low) * DAffine3::from_scale(high - low);
        self.add(Shape::Cube, placed, material)
    }

    pub fn add_light(&mut self, position: DVec3, colour: Vec3, extent: LightExtent) -> &mut Self {
        self.scene.lights.push(Light { position, colour, falloff: Vec3::X, extent, visible: false });
        self
    }

    pub fn finish(self) -> Scene {
        Scene { graph: Arc::new(self.graph), ..self.scene }
    }

    pub fn film(self, device: &DeviceChoice) -> Film {
        render_whole(&self.finish(), device).film
    }
}

/// A material that shows its colour under ambient light of 1, and nothing else.
pub fn paint(red: f32, green: f32, blue: f32) -> Material {
    Material { diffuse: Vec3::new(red, green, blue), ..Material::default() }
}

pub fn render_whole(scene: &Scene, device: &DeviceChoice) -> Rendered {
    render_with(scene, device, |_| ())
}

/// Renders with changed options. A missing device is a failure that says how to install one.
pub fn render_with(scene: &Scene, device: &DeviceChoice, change: impl FnOnce(&mut RenderOptions)) -> Rendered {
    let buffers = Arc::new(flatten(scene).unwrap_or_else(|error| panic!("{error}")));
    let (mut renderer, _) = open_renderer(device, false).unwrap_or_else(|error| panic!("{error}"));
    let mut options = RenderOptions::whole(&buffers);
    change(&mut options);
    render(buffers, renderer.as_mut(), &options, &mut Unattended).unwrap_or_else(|error| panic!("{error}"))
}

/// Direction of the ray through the middle of a pixel of a [`Stage`]'s camera, in f64.
pub fn pixel_direction(scene: &Scene, x: u32, y: u32, offset: [f64; 2]) -> DVec3 {
    let [width, height] = scene.size.map(f64::from);
    let scale = (scene.camera.fov.to_radians() / 2.0).tan();
    let forward = scene.camera.forward.normalize();
    let right = forward.cross(scene.camera.up).normalize();
    let up = right.cross(forward);
    let u = (2.0 * (f64::from(x) + offset[0]) / width - 1.0) * scale * width / height;
    let v = (1.0 - 2.0 * (f64::from(y) + offset[1]) / height) * scale;
    (forward + u * right + v * up).normalize()
}

/// Chi-square of counts against expectations as a standard normal deviate (Wilson and Hilferty 1931): beyond ±4 the
/// counts do not fit, or fit too well to be independent.
pub fn chi_square_deviate(counts: &[u64], expected: &[f64]) -> f64 {
    let chi_square: f64 = counts.iter().zip(expected).map(|(count, mean)| (*count as f64 - mean).powi(2) / mean).sum();
    let freedom = (counts.len() - 1) as f64;
    let spread = 2.0 / (9.0 * freedom);
    ((chi_square / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}
