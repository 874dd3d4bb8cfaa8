//! Shapes placed in the world; twin of `shaders/geometry/instance.wgsl`.

use super::cone::{cone_intersect, cone_normal, cone_project};
use super::cube::{cube_intersect, cube_normal, cube_project};
use super::cylinder::{cylinder_intersect, cylinder_normal, cylinder_project};
use super::hit::{Hit, MISS, ShapeHit, Surface};
use super::plane::{plane_normal, plane_project};
use super::sphere::{sphere_intersect, sphere_normal, sphere_project};
use super::torus::{torus_intersect, torus_normal, torus_project};
use super::triangle::{triangle_geometric_normal, triangle_shading_normal};
use crate::cpu::bindings::Bindings;
use crate::layout::{
    AffineRows, SHAPE_CONE, SHAPE_CUBE, SHAPE_CYLINDER, SHAPE_MESH, SHAPE_PLANE, SHAPE_SPHERE, SHAPE_TORUS,
    TRIANGLE_SMOOTH,
};
use glam::{Vec3, Vec4Swizzles};

#[inline]
pub fn transform_point(m: &AffineRows, p: Vec3) -> Vec3 {
    Vec3::new(
        m[0].x * p.x + m[0].y * p.y + m[0].z * p.z + m[0].w,
        m[1].x * p.x + m[1].y * p.y + m[1].z * p.z + m[1].w,
        m[2].x * p.x + m[2].y * p.y + m[2].z * p.z + m[2].w,
    )
}

#[inline]
pub fn transform_vector(m: &AffineRows, v: Vec3) -> Vec3 {
    Vec3::new(
        m[0].x * v.x + m[0].y * v.y + m[0].z * v.z,
        m[1].x * v.x + m[1].y * v.y + m[1].z * v.z,
        m[2].x * v.x + m[2].y * v.y + m[2].z * v.z,
    )
}

/// Normals go by the inverse transpose: `inverse` is the map back, whose transpose is applied. Unit length.
#[inline]
pub fn transform_normal(inverse: &AffineRows, n: Vec3) -> Vec3 {
    unit_vector_of_any_size(Vec3::new(
        inverse[0].x * n.x + inverse[1].x * n.y + inverse[2].x * n.z,
        inverse[0].y * n.x + inverse[1].y * n.y + inverse[2].y * n.z,
        inverse[0].z * n.x + inverse[1].z * n.y + inverse[2].z * n.z,
    ))
}

/// Scales by the largest component first, so that the squares of tiny and huge vectors stay in range.
#[inline]
pub fn unit_vector_of_any_size(v: Vec3) -> Vec3 {
    let scaled = v / v.x.abs().max(v.y.abs()).max(v.z.abs());
    scaled / (scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z).sqrt()
}

/// Nearest hit of an instance of this shape, neither plane nor mesh, by a ray in the instance's object space. The
/// direction is not normalised there, so that t is the same in the world.
pub fn instance_intersect(
    scene: &Bindings,
    index: u32,
    shape: u32,
    origin: Vec3,
    direction: Vec3,
    t_max: f32,
) -> ShapeHit {
    match shape {
        SHAPE_SPHERE => sphere_intersect(origin, direction, t_max),
        SHAPE_CUBE => cube_intersect(origin, direction, t_max),
        SHAPE_CYLINDER => cylinder_intersect(origin, direction, t_max),
        SHAPE_CONE => cone_intersect(origin, direction, t_max),
        SHAPE_TORUS => torus_intersect(origin, direction, t_max, scene.instances[index as usize].parameters.xy()),
        _ => ShapeHit { t: MISS, face: 0 },
    }
}

/// The surface at a hit of the world-space ray (origin, direction).
pub fn surface_at(scene: &Bindings, hit: Hit, origin: Vec3, direction: Vec3) -> Surface {
    let instance = &scene.instances[hit.instance as usize];
    let object_from_world = &instance.object_from_world;
    let object_direction = transform_vector(object_from_world, direction);
    let mut point = transform_point(object_from_world, origin) + hit.t * object_direction;
    let mut normal = Vec3::Y;
    let mut is_smooth = false;
    let mut smooth_normal = Vec3::Y;
    match instance.shape {
        SHAPE_SPHERE => {
            point = sphere_project(point, hit.primitive);
            normal = sphere_normal(point, hit.primitive);
        }
        SHAPE_CUBE => {
            point = cube_project(point, hit.primitive);
            normal = cube_normal(point, hit.primitive);
        }
        SHAPE_CYLINDER => {
            point = cylinder_project(point, hit.primitive);
            normal = cylinder_normal(point, hit.primitive);
        }
        SHAPE_CONE => {
            point = cone_project(point, hit.primitive);
            normal = cone_normal(point, hit.primitive);
        }
        SHAPE_TORUS => {
            let radii = instance.parameters.xy();
            point = torus_project(point, hit.primitive, radii);
            normal = torus_normal(point, hit.primitive, radii);
        }
        SHAPE_PLANE => {
            point = plane_project(point, hit.primitive);
            normal = plane_normal(point, hit.primitive);
        }
        SHAPE_MESH => {
            let triangle = &scene.triangles[hit.primitive as usize];
            let b0 = 1.0 - hit.b1 - hit.b2;
            point = b0 * triangle.p0 + hit.b1 * triangle.p1 + hit.b2 * triangle.p2;
            normal = triangle_geometric_normal(triangle.p0, triangle.p1, triangle.p2);
            is_smooth = triangle.flags & TRIANGLE_SMOOTH != 0;
            smooth_normal = triangle_shading_normal(triangle.n0, triangle.n1, triangle.n2, hit.b1, hit.b2);
        }
        _ => {}
    }

    let cosine = normal.x * object_direction.x + normal.y * object_direction.y + normal.z * object_direction.z;
    let entering = cosine < 0.0;
    let mut geometric_normal = transform_normal(object_from_world, normal);
    geometric_normal = if entering { geometric_normal } else { -geometric_normal };
    let mut shading_normal = geometric_normal;
    if is_smooth {
        shading_normal = transform_normal(object_from_world, smooth_normal);
        let side = shading_normal.x * geometric_normal.x
            + shading_normal.y * geometric_normal.y
            + shading_normal.z * geometric_normal.z;
        shading_normal = if side < 0.0 { -shading_normal } else { shading_normal };
    }
    Surface {
        point: transform_point(&instance.world_from_object, point),
        geometric_normal,
        shading_normal,
        entering,
        material: instance.material,
        diffuse: scene.materials[instance.material as usize].diffuse,
    }
}
