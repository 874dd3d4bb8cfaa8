//! What a scene uses; the rest is compiled out of the kernel.

use super::SceneBuffers;
use crate::layout;

/// Up to so many lights are told apart by constants: as many as `light_at` in `shaders/shading/light.wgsl` lists.
const FEW_LIGHTS: usize = 4;
/// Among up to so many instances of meshes, each part of an opened one (`rebraid.rs`) for itself, neighbouring rays
/// mostly visit the same nodes.
const FEW_MESHES: usize = 64;

/// One field for each `override` constant of `shaders/bindings.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FeatureSet {
    pub sphere: bool,
    pub cube: bool,
    pub cylinder: bool,
    pub cone: bool,
    pub torus: bool,
    pub plane: bool,
    pub mesh: bool,
    /// Any bounded shape but meshes.
    pub analytic: bool,
    /// Any bounded shape, mists included, beside one mesh.
    pub instances: bool,
    /// So many instances of meshes that neighbouring rays part among them.
    pub many_meshes: bool,
    /// A material that reflects, be it by total internal reflection.
    pub reflection: bool,
    /// A material with a refractive index.
    pub refraction: bool,
    /// A material that spreads its reflection.
    pub glossy: bool,
    /// A light that is not a point.
    pub area_light: bool,
    /// A camera whose lens is not a pinhole.
    pub lens: bool,
    /// A material whose diffuse colour comes from an image.
    pub texture: bool,
    /// A material with a bump map, of an image or of noise.
    pub bump: bool,
    /// A volume of mist.
    pub mist: bool,
    /// A surface that casts no shadow.
    pub shadowless: bool,
    /// More lights than the few that are told apart by constants.
    pub many_lights: bool,
    /// A picture around the scene.
    pub background_image: bool,
}

impl FeatureSet {
    pub const ALL_OFF: FeatureSet = FeatureSet {
        sphere: false,
        cube: false,
        cylinder: false,
        cone: false,
        torus: false,
        plane: false,
        mesh: false,
        analytic: false,
        instances: false,
        many_meshes: false,
        reflection: false,
        refraction: false,
        glossy: false,
        area_light: false,
        lens: false,
        texture: false,
        bump: false,
        mist: false,
        shadowless: false,
        many_lights: false,
        background_image: false,
    };

    pub const ALL_ON: FeatureSet = FeatureSet {
        sphere: true,
        cube: true,
        cylinder: true,
        cone: true,
        torus: true,
        plane: true,
        mesh: true,
        analytic: true,
        instances: true,
        many_meshes: true,
        reflection: true,
        refraction: true,
        glossy: true,
        area_light: true,
        lens: true,
        texture: true,
        bump: true,
        mist: true,
        shadowless: true,
        many_lights: true,
        background_image: true,
    };

    /// What these buffers need.
    pub fn of(buffers: &SceneBuffers) -> Self {
        let mut shapes = [false; layout::SHAPE_MESH as usize + 1];
        for instance in &buffers.instances {
            if let Some(used) = shapes.get_mut(instance.shape as usize) {
                *used = true;
            }
        }
        let has = |shape: u32| shapes[shape as usize];
        let bounded = || buffers.instances.iter().filter(|instance| instance.shape != layout::SHAPE_PLANE);
        let materials = &buffers.materials;
        FeatureSet {
            sphere: has(layout::SHAPE_SPHERE),
            cube: has(layout::SHAPE_CUBE),
            cylinder: has(layout::SHAPE_CYLINDER),
            cone: has(layout::SHAPE_CONE),
            torus: has(layout::SHAPE_TORUS),
            plane: has(layout::SHAPE_PLANE),
            mesh: has(layout::SHAPE_MESH),
            analytic: bounded().any(|instance| instance.shape != layout::SHAPE_MESH),
            instances: bounded().any(|instance| instance.shape != layout::SHAPE_MESH) || bounded().count() > 1,
            many_meshes: bounded().filter(|instance| instance.shape == layout::SHAPE_MESH).count() > FEW_MESHES,
            reflection: materials.iter().any(|material| material.reflection != 0.0 || material.ior != 0.0),
            refraction: materials.iter().any(|material| material.ior != 0.0),
            glossy: materials.iter().any(|material| material.reflection != 0.0 && material.glossy != 0.0),
            area_light: buffers.lights.iter().any(|light| light.kind != layout::LIGHT_POINT),
            lens: buffers.frame.lens_edge != 0.0,
            texture: materials.iter().any(|material| material.texture != layout::NONE),
            bump: materials
                .iter()
                .any(|material| material.bump != layout::NONE || material.flags & layout::MATERIAL_NOISE_BUMP != 0),
            mist: materials.iter().any(|material| material.flags & layout::MATERIAL_MIST != 0),
            shadowless: buffers
                .instances
                .iter()
                .any(|instance| instance.flags & (layout::INSTANCE_SHADES | layout::INSTANCE_MIST) == 0),
            many_lights: buffers.lights.len() > FEW_LIGHTS,
            background_image: buffers.frame.background_image != layout::NONE,
        }
    }

    /// The `override` constants of the kernel and their values.
    pub fn overrides(&self) -> Vec<(&'static str, bool)> {
        vec![
            ("HAS_SPHERE", self.sphere),
            ("HAS_CUBE", self.cube),
            ("HAS_CYLINDER", self.cylinder),
            ("HAS_CONE", self.cone),
            ("HAS_TORUS", self.torus),
            ("HAS_PLANE", self.plane),
            ("HAS_MESH", self.mesh),
            ("HAS_ANALYTIC", self.analytic),
            ("HAS_INSTANCES", self.instances),
            ("HAS_MANY_MESHES", self.many_meshes),
            ("HAS_REFLECTION", self.reflection),
            ("HAS_REFRACTION", self.refraction),
            ("HAS_GLOSSY", self.glossy),
            ("HAS_AREA_LIGHT", self.area_light),
            ("HAS_LENS", self.lens),
            ("HAS_TEXTURE", self.texture),
            ("HAS_BUMP", self.bump),
            ("HAS_MIST", self.mist),
            ("HAS_SHADOWLESS", self.shadowless),
            ("HAS_MANY_LIGHTS", self.many_lights),
            ("HAS_BACKGROUND_IMAGE", self.background_image),
        ]
    }
}
