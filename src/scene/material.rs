use super::Image;
use glam::Vec3;
use std::sync::Arc;

/// Whitted's surface with Cook's glossy square and a refractive index. Colours are linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub diffuse: Vec3,
    /// Not multiplied by `diffuse`.
    pub specular: Vec3,
    /// Phong exponent, at least 0.
    pub shininess: f32,
    /// Scale of the reflected light; 0 is not reflective.
    pub reflection: f32,
    /// Edge of the square about the mirror direction (at distance 1) that reflected rays fill; 0 is a mirror.
    pub glossy: f32,
    /// Refractive index, above 0; `None` is opaque.
    pub ior: Option<f32>,
    /// Where given, the diffuse colour comes from this image.
    pub texture: Option<Arc<Image>>,
    pub bump: Option<Bump>,
    /// Where given, the shape is a volume of mist: scattering events a world unit, in (0, 1]. Only `diffuse` counts
    /// beside it.
    pub density: Option<f32>,
    /// Radiance that the surface sends out by itself.
    pub emission: Vec3,
    /// Whether shadow rays stop at the surface.
    pub casts_shadow: bool,
}

/// The height field of a bump map (Blinn 1978).
#[derive(Clone, Debug, PartialEq)]
pub enum Bump {
    /// Height is the mean of the image's red, green and blue.
    Image(Arc<Image>),
    /// Five octaves of Perlin noise over (u, v, z).
    Noise { z: f32 },
}

impl Default for Material {
    fn default() -> Self {
        Material {
            diffuse: Vec3::splat(0.5),
            specular: Vec3::ZERO,
            shininess: 32.0,
            reflection: 0.0,
            glossy: 0.0,
            ior: None,
            texture: None,
            bump: None,
            density: None,
            emission: Vec3::ZERO,
            casts_shadow: true,
        }
    }
}
