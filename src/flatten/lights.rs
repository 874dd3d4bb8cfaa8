//! Lights of the scene as the kernel samples them.

use crate::layout::{LIGHT_PARALLELOGRAM, LIGHT_POINT, LIGHT_SPHERE, Light};
use crate::scene::{LightExtent, Scene};
use crate::{Error, Result};
use glam::Vec3;

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
