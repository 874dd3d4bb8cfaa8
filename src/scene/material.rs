use glam::Vec3;

/// Whitted's surface with Cook's glossy square and a refractive index. Colours are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
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
}

impl Default for Material {
    fn default() -> Self {
        Material {
            diffuse: Vec3::splat(0.5),
            specular: Vec3::ZERO,
            shininess: 1.0,
            reflection: 0.0,
            glossy: 0.0,
            ior: None,
        }
    }
}
