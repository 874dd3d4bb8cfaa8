//! Texture coordinates and tangents of the surface at a hit; twin of `shaders/geometry/parameterisation.wgsl`. v = 0 is
//! the image's top row, so that in a space that is not mirrored dpdu × dpdv points into the shape.

use super::cone::cone_parameterise;
use super::cube::cube_parameterise;
use super::cylinder::cylinder_parameterise;
use super::hit::{Hit, Parameterisation, Surface};
use super::instance::{transform_point, transform_vector};
use super::plane::plane_parameterise;
use super::revolution::revolution;
use super::sphere::sphere_parameterise;
use super::torus::torus_parameterise;
use super::triangle::triangle_parameterise;
use crate::cpu::bindings::Bindings;
use crate::layout::{
    SHAPE_CONE, SHAPE_CUBE, SHAPE_CYLINDER, SHAPE_MESH, SHAPE_PLANE, SHAPE_SPHERE, SHAPE_TORUS, Triangle,
};
use glam::{Vec2, Vec3, Vec4Swizzles};

/// In world space; the tangents are not of unit length, but the true derivatives of the point.
pub fn parameterise_at(scene: &Bindings, hit: Hit, surface: Surface) -> Parameterisation {
    let instance = &scene.instances[hit.instance as usize];
    let point = transform_point(&instance.object_from_world, surface.point);
    let around = revolution(point);
    let result = match instance.shape {
        SHAPE_SPHERE => sphere_parameterise(point, hit.primitive, around),
        SHAPE_CUBE => cube_parameterise(point, hit.primitive),
        SHAPE_CYLINDER => cylinder_parameterise(point, hit.primitive, around),
        SHAPE_CONE => cone_parameterise(point, hit.primitive, around),
        SHAPE_TORUS => torus_parameterise(point, hit.primitive, around, instance.parameters.xy()),
        SHAPE_PLANE => plane_parameterise(point, hit.primitive),
        SHAPE_MESH => {
            let Triangle { p0, p1, p2, uv0, uv1, uv2, .. } = scene.triangles[hit.primitive as usize];
            triangle_parameterise([p0, p1, p2], [uv0, uv1, uv2], hit.b1, hit.b2, instance.parameters)
        }
        _ => Parameterisation { uv: Vec2::ZERO, dpdu: Vec3::X, dpdv: Vec3::Z },
    };
    Parameterisation {
        uv: result.uv,
        dpdu: transform_vector(&instance.world_from_object, result.dpdu),
        dpdv: transform_vector(&instance.world_from_object, result.dpdv),
    }
}
