//! Two small scenes that `gpu-trace doctor` renders on every device: one whose answer is known in closed form, and
//! one with every kind of ray, which a GPU must render as the CPU does.

use glam::{DAffine3, DVec3, Vec3};
use gpu_trace::Result;
use gpu_trace::film::{Comparison, Film, compare_images};
use gpu_trace::flatten::flatten;
use gpu_trace::render::{RenderOptions, Rendered, Unattended, render};
use gpu_trace::renderer::Renderer;
use gpu_trace::scene::{
    Background, Camera, Conventions, Geometry, Light, LightExtent, Material, Node, Sampling, Scene, SceneGraph, Shape,
    Transfer,
};
use std::sync::Arc;

/// Edge of the tile in pixels.
const TILE: u32 = 64;
/// Camera samples a pixel of the tile.
const TILE_SAMPLES: u32 = 4;

/// Two devices agree where the tiles' FLIP mean and share of differing pixels are no larger.
const FLIP_TOLERANCE: f64 = 0.002;
const SHARE_TOLERANCE: f64 = 0.001;

pub fn agrees(comparison: &Comparison) -> bool {
    comparison.flip_mean <= FLIP_TOLERANCE && comparison.differing_share <= SHARE_TOLERANCE
}

/// Compares the pictures of two films of the tile, the CPU's first.
pub fn compare_tiles(reference: &Film, test: &Film) -> Result<Comparison> {
    let [reference, test] = [reference, test].map(|film| film.resolve(Transfer::Linear, false));
    compare_images(&reference, &test)
}

/// A matt ball above a mirror-like floor, a glass ball, and a soft-edged light: shadow, reflected and refracted rays.
pub fn render_tile(renderer: &mut dyn Renderer) -> Result<Rendered> {
    let mut graph = SceneGraph::default();
    let floor = Material { reflection: 0.3, glossy: 0.1, diffuse: Vec3::new(0.5, 0.5, 0.4), ..Material::default() };
    let glass = Material { diffuse: Vec3::ZERO, reflection: 1.0, ior: Some(1.5), ..Material::default() };
    let paint = Material {
        diffuse: Vec3::new(0.7, 0.25, 0.1),
        specular: Vec3::splat(0.4),
        shininess: 30.0,
        ..Material::default()
    };
    let shapes = [
        (Shape::Plane, floor, DAffine3::from_translation(DVec3::NEG_Y)),
        (Shape::Sphere, paint.clone(), DAffine3::from_translation(DVec3::new(-1.1, 0.0, 0.0))),
        (Shape::Sphere, glass, DAffine3::from_translation(DVec3::new(1.1, 0.0, 0.4))),
        (
            Shape::Torus { major: 1.0, minor: 0.3 },
            paint,
            DAffine3::from_scale_rotation_translation(
                DVec3::new(1.0, 0.8, 1.2),
                glam::DQuat::from_rotation_x(1.0),
                DVec3::new(0.0, 0.3, -2.0),
            ),
        ),
    ];
    let mut root = Node::new("reference", None);
    for (shape, material, transform) in shapes {
        let material = graph.add_material(material);
        let node = Node { transform, material: Some(material), ..Node::new("shape", Some(Geometry::new(shape))) };
        root.children.push(graph.add_node(node));
    }
    let scene = Scene {
        root: graph.add_node(root),
        graph: Arc::new(graph),
        camera: camera(DVec3::new(0.0, 1.0, 6.0), DVec3::new(0.0, -0.15, -1.0).normalize(), 40.0),
        ambient: Vec3::splat(0.2),
        lights: vec![Light {
            position: DVec3::new(3.0, 5.0, 4.0),
            colour: Vec3::splat(0.9),
            falloff: Vec3::X,
            extent: LightExtent::Classic,
            visible: false,
        }],
        background: Background::default(),
        sampling: Sampling { camera: TILE_SAMPLES, shadow: 4, glossy: 2, max_depth: 4, seed: 1 },
        conventions: Conventions::default(),
        output: "reference.png".into(),
        size: [TILE; 2],
        transfer: Transfer::Linear,
    };
    render_scene(&scene, renderer)
}

/// What a device made of the scene whose answer is known.
pub struct KnownAnswer {
    pub expected: [f32; 3],
    pub found: [f32; 3],
}

impl KnownAnswer {
    /// Steps of the film are 2^-20, and the pole of the ball is met within a few roundings.
    pub fn is_right(&self) -> bool {
        self.expected.iter().zip(self.found).all(|(expected, found)| (expected - found).abs() < 1e-4)
    }
}

/// A matt unit ball with a point light at the eye. The middle pixel sees its pole, where the light comes in along the
/// normal from distance 3: Lambert's law gives diffuse * (ambient + light / (1 + 3²)).
pub fn render_known_answer(renderer: &mut dyn Renderer) -> Result<KnownAnswer> {
    let (diffuse, ambient, light) = (Vec3::new(0.8, 0.5, 0.25), Vec3::new(0.1, 0.2, 0.3), Vec3::new(5.0, 6.0, 7.0));
    let mut graph = SceneGraph::default();
    let material = graph.add_material(Material { diffuse, ..Material::default() });
    let ball = Node { material: Some(material), ..Node::new("ball", Some(Geometry::new(Shape::Sphere))) };
    let eye = DVec3::new(0.0, 0.0, 4.0);
    // An odd size has a middle pixel, and its only sample lies in the pixel's centre.
    let size = 15;
    let scene = Scene {
        root: graph.add_node(ball),
        graph: Arc::new(graph),
        camera: camera(eye, DVec3::NEG_Z, 30.0),
        ambient,
        lights: vec![Light {
            position: eye,
            colour: light,
            falloff: Vec3::new(1.0, 0.0, 1.0),
            extent: LightExtent::Classic,
            visible: false,
        }],
        background: Background::default(),
        sampling: Sampling::default(),
        conventions: Conventions::default(),
        output: "known.png".into(),
        size: [size; 2],
        transfer: Transfer::Linear,
    };
    let film = render_scene(&scene, renderer)?.film;
    let [red, green, blue, _] = film.radiance(size / 2, size / 2);
    Ok(KnownAnswer { expected: (diffuse * (ambient + light / 10.0)).to_array(), found: [red, green, blue] })
}

fn camera(eye: DVec3, forward: DVec3, fov: f64) -> Camera {
    Camera { eye, forward, up: DVec3::Y, fov, lens_edge: 0.0, focus_distance: 1.0 }
}

fn render_scene(scene: &Scene, renderer: &mut dyn Renderer) -> Result<Rendered> {
    let buffers = Arc::new(flatten(scene)?);
    render(buffers.clone(), renderer, &RenderOptions::whole(&buffers), &mut Unattended)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gpu_trace::cpu::CpuRenderer;
    use gpu_trace::flatten::SceneBuffers;
    use gpu_trace::layout::{Dispatch, Frame};
    use gpu_trace::renderer::Tally;
    use std::ops::Range;

    /// The CPU's work with a change to the picture's constants: a device that computes something else.
    struct Wrong(CpuRenderer, fn(&mut Frame));

    impl Renderer for Wrong {
        fn prepare(&mut self, scene: Arc<SceneBuffers>) -> Result<()> {
            self.0.prepare(scene)
        }
        fn max_band_pixels(&self) -> u64 {
            self.0.max_band_pixels()
        }
        fn begin_band(&mut self, rows: Range<u32>) -> Result<()> {
            self.0.begin_band(rows)
        }
        fn submit(&mut self, frame: &Frame, dispatches: &[Dispatch]) -> Result<Tally> {
            let mut frame = *frame;
            (self.1)(&mut frame);
            self.0.submit(&frame, dispatches)
        }
        fn end_band(&mut self, film: &mut Film) -> Result<()> {
            self.0.end_band(film)
        }
    }

    #[test]
    fn a_wrong_answer_is_not_taken_for_right() -> Result<()> {
        assert!(render_known_answer(&mut Wrong(CpuRenderer::new(), |_| ()))?.is_right());
        let mut wrong = Wrong(CpuRenderer::new(), |frame| frame.ambient.x += 0.001);
        assert!(!render_known_answer(&mut wrong)?.is_right());
        Ok(())
    }

    #[test]
    fn a_wrong_tile_is_not_taken_for_right() -> Result<()> {
        let right = render_tile(&mut CpuRenderer::new())?.film;
        assert!(agrees(&compare_tiles(&right, &render_tile(&mut CpuRenderer::new())?.film)?));
        let wrong: [fn(&mut Frame); 3] =
            [|frame| frame.seed += 1, |frame| frame.max_depth = 0, |frame| frame.tan_half_fov *= 1.01];
        for change in wrong {
            let film = render_tile(&mut Wrong(CpuRenderer::new(), change))?.film;
            let comparison = compare_tiles(&right, &film)?;
            assert!(!agrees(&comparison), "{comparison}");
        }
        Ok(())
    }
}
