//! The typed description of a scene: what the script says, with no packed data and no GPU types.
//!
//! World space is right-handed; lengths are in world units, angles in degrees, colours linear.

mod camera;
mod frame_rate;
mod geometry;
mod graph;
mod image;
mod light;
mod load_image;
mod material;
mod mesh;
mod obj;
mod polygons;
mod smooth;

pub use camera::Camera;
pub use frame_rate::FrameRate;
pub use geometry::{Geometry, Shape};
pub use graph::{MaterialId, Node, NodeId, SceneGraph};
pub use image::{Image, Texels};
pub use light::{Light, LightExtent};
pub use load_image::load_image;
pub use material::{Bump, Material};
pub use mesh::Mesh;
pub use obj::load_obj;
pub use polygons::PolygonMesh;

use glam::Vec3;
use std::path::PathBuf;
use std::sync::Arc;

/// One picture that a script asked for: a subtree of the graph, seen by a camera.
#[derive(Clone, Debug)]
pub struct Scene {
    pub graph: Arc<SceneGraph>,
    pub root: NodeId,
    pub camera: Camera,
    /// Radiance that reaches every point from everywhere, linear rgb.
    pub ambient: Vec3,
    pub lights: Vec<Light>,
    pub background: Background,
    pub sampling: Sampling,
    pub conventions: Conventions,
    /// Where the picture goes, relative to the working folder.
    pub output: PathBuf,
    /// Width and height, pixels; both at least 1.
    pub size: [u32; 2],
    pub transfer: Transfer,
}

/// How many rays a picture takes, and from which random numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Camera samples a pixel: AA squared times the depth-of-field count.
    pub camera: u32,
    /// Shadow rays for each light at a hit of a camera ray; with 1 a classic light is a point.
    pub shadow: u32,
    /// Glossy reflection rays at a hit of a camera ray.
    pub glossy: u32,
    /// Reflected and refracted rays one after another; 0 shows direct light alone.
    pub max_depth: u32,
    pub seed: u32,
}

impl Default for Sampling {
    fn default() -> Self {
        Sampling { camera: 1, shadow: 1, glossy: 1, max_depth: 8, seed: 0 }
    }
}

/// What a ray that leaves the scene sees.
#[derive(Clone, Debug, PartialEq)]
pub struct Background {
    /// Linear radiance straight down and straight up (+y), blended by the height of the direction.
    pub bottom: Vec3,
    pub top: Vec3,
    /// A picture all around in place of the colours: equirectangular, its middle towards -z, its top row straight up.
    pub image: Option<Arc<Image>>,
    /// Camera rays that miss leave the pixel transparent; reflected and refracted ones see the colours above.
    pub transparent: bool,
}

impl Default for Background {
    fn default() -> Self {
        Background {
            bottom: Vec3::new(0.82, 0.86, 0.90),
            top: Vec3::new(0.30, 0.46, 0.72),
            image: None,
            transparent: false,
        }
    }
}

/// Highlight of the direct light: Phong's (r.v)^p or Blinn's (n.h)^p.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Specular {
    #[default]
    Phong,
    Blinn,
}

/// Where in the pixel square the samples lie: about its centre, or about its upper left corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelOrigin {
    #[default]
    Centre,
    Corner,
}

/// The conventions that still matter when a picture is rendered; the others are the script's affair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Conventions {
    pub specular: Specular,
    pub sample: PixelOrigin,
}

/// From linear radiance to the written value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transfer {
    /// Values are written as they are.
    #[default]
    Linear,
    /// IEC 61966-2-1.
    Srgb,
}
