//! Lights of the scene as the kernel samples them.

use crate::layout::{LIGHT_PARALLELOGRAM, LIGHT_POINT, LIGHT_SPHERE, Light};
use crate::scene::{Geometry, LightExtent, Material, Mesh, Node, Scene, Shape};
use crate::{Error, Result};
use glam::{DAffine3, DVec3, Vec3};
use std::borrow::Cow;
use std::sync::Arc;

/// The scene with its visible lights as surfaces that send out their colour and reflect nothing. Such a surface does
/// not shade its own light, since shadow rays end just before it, but it does shade the others.
pub fn with_visible_lights(scene: &Scene) -> Cow<'_, Scene> {
    let visible: Vec<_> = (1..).zip(&scene.lights).filter(|(_, light)| light.visible).collect();
    let shapes: Vec<_> =
        visible.into_iter().filter_map(|(number, light)| Some((number, light, shape(light)?))).collect();
    if shapes.is_empty() {
        return Cow::Borrowed(scene);
    }
    let mut graph = (*scene.graph).clone();
    let mut root = Node::new("scene with lights", None);
    root.children.push(scene.root);
    for (number, light, (shape, transform)) in shapes {
        let mut node = Node::new(format!("light {number}"), Some(Geometry::new(shape)));
        node.transform = transform;
        // A light may be negative, to darken; what it looks like may not.
        let emission = light.colour.max(Vec3::ZERO);
        node.material = Some(graph.add_material(Material { diffuse: Vec3::ZERO, emission, ..Material::default() }));
        root.children.push(graph.add_node(node));
    }
    let root = graph.add_node(root);
    Cow::Owned(Scene { graph: Arc::new(graph), root, ..scene.clone() })
}

/// The surface of a light that has one, and where it stands.
fn shape(light: &crate::scene::Light) -> Option<(Shape, DAffine3)> {
    let at = DAffine3::from_translation(light.position);
    match light.extent {
        LightExtent::Classic => None,
        LightExtent::Sphere { radius } => Some((Shape::Sphere, at * DAffine3::from_scale(DVec3::splat(radius)))),
        LightExtent::Parallelogram { u, v } => {
            let corners = [-u - v, u - v, u + v, v - u].map(|diagonal| (diagonal * 0.5).as_vec3());
            let mesh = Mesh {
                name: "light".into(),
                positions: corners.to_vec(),
                triangles: vec![[0, 1, 2], [0, 2, 3]],
                ..Mesh::default()
            };
            Some((Shape::Mesh(Arc::new(mesh)), at))
        }
    }
}

pub fn lights(scene: &Scene) -> Result<Vec<Light>> {
    scene.lights.iter().enumerate().map(|(i, light)| pack(light, i, scene.sampling.shadow)).collect()
}

fn pack(light: &crate::scene::Light, index: usize, shadow: u32) -> Result<Light> {
    let mut packed = Light {
        position: light.position.as_vec3(),
        kind: LIGHT_POINT,
        colour: light.colour,
        falloff: light.falloff,
        ..Light::default()
    };
    match light.extent {
        // With one shadow ray the classic light casts hard shadows.
        LightExtent::Classic if shadow <= 1 => {}
        LightExtent::Classic => {
            packed.kind = LIGHT_PARALLELOGRAM;
            packed.u = Vec3::X;
            packed.v = Vec3::Z;
        }
        LightExtent::Parallelogram { u, v } => {
            packed.kind = LIGHT_PARALLELOGRAM;
            packed.u = u.as_vec3();
            packed.v = v.as_vec3();
        }
        LightExtent::Sphere { radius } => {
            packed.kind = LIGHT_SPHERE;
            packed.radius = radius as f32;
        }
    }
    let vectors = [packed.position, packed.colour, packed.falloff, packed.u, packed.v];
    if vectors.iter().all(|vector| vector.is_finite()) && packed.radius.is_finite() {
        return Ok(packed);
    }
    Err(Error::Scene(format!("light {} of the scene has numbers outside the range of single precision", index + 1)))
}
