//! Triangles: the watertight test of Woop, Benthin and Wald (JCGT 2013), normals, and the packing of normals; twin of
//! `shaders/geometry/triangle.wgsl`, where the method is explained.

use super::hit::{MISS, Parameterisation};
use crate::cpu::math::roots::{TINY, safe_reciprocal};
use glam::{Vec2, Vec3, Vec4};

/// What a ray contributes to the tests: its origin, and the shear that turns its direction into `axis`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleRay {
    pub origin: Vec3,
    pub axis: u32,
    /// Direction / its largest component for the two others, and 1 / the largest.
    pub shear: Vec3,
}

/// b1 and b2 weigh p1 and p2; t is [`MISS`] where there is no hit, which `is_hit` says without a detour over t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    pub is_hit: bool,
    pub t: f32,
    pub b1: f32,
    pub b2: f32,
}

/// The cyclic permutation of v that brings the coordinate `axis` to the last place.
#[inline]
fn axis_last(v: Vec3, axis: u32) -> Vec3 {
    match axis {
        0 => Vec3::new(v.y, v.z, v.x),
        1 => Vec3::new(v.z, v.x, v.y),
        _ => v,
    }
}

/// Prepares a ray in object space; once for all triangles that it is tested against.
#[inline]
pub fn triangle_ray(origin: Vec3, direction: Vec3) -> TriangleRay {
    let size = direction.abs();
    let axis = match (size.x >= size.y, size.z > size.x, size.z > size.y) {
        (true, false, _) => 0,
        (false, _, false) => 1,
        _ => 2,
    };
    let d = axis_last(direction, axis);
    let inverse = safe_reciprocal(d.z);
    TriangleRay { origin, axis, shear: Vec3::new(d.x * inverse, d.y * inverse, inverse) }
}

/// Hit in (0, t_max), from either side.
#[inline]
pub fn triangle_intersect(ray: &TriangleRay, p0: Vec3, p1: Vec3, p2: Vec3, t_max: f32) -> TriangleHit {
    let a = axis_last(p0 - ray.origin, ray.axis);
    let b = axis_last(p1 - ray.origin, ray.axis);
    let c = axis_last(p2 - ray.origin, ray.axis);
    let ax = a.x - ray.shear.x * a.z;
    let ay = a.y - ray.shear.y * a.z;
    let bx = b.x - ray.shear.x * b.z;
    let by = b.y - ray.shear.y * b.z;
    let cx = c.x - ray.shear.x * c.z;
    let cy = c.y - ray.shear.y * c.z;
    // An edge of zero belongs to both triangles that share it.
    let u = cx * by - cy * bx;
    let v = ax * cy - ay * cx;
    let w = bx * ay - by * ax;
    let inside = none_positive(u, v, w) || none_positive(-u, -v, -w);
    let determinant = u + v + w;
    let inverse = 1.0 / if determinant == 0.0 { 1.0 } else { determinant };
    let t = (u * a.z + v * b.z + w * c.z) * ray.shear.z * inverse;
    let hit = inside && determinant != 0.0 && t > 0.0 && t < t_max;
    TriangleHit { is_hit: hit, t: if hit { t } else { MISS }, b1: v * inverse, b2: w * inverse }
}

/// Of numbers, not NaN.
#[inline]
fn none_positive(u: f32, v: f32, w: f32) -> bool {
    let [u, v, w] = [u, v, w].map(|number| number.to_bits() as i32);
    u.max(v).max(w) <= 0
}

/// A unit vector from its octahedral packing (Cigolle et al., JCGT 2014): two 16-bit snorms, x in the low half.
#[inline]
pub fn decode_octahedral(packed: u32) -> Vec3 {
    let x = f32::from(packed as u16 as i16) / 32767.0;
    let y = f32::from((packed >> 16) as u16 as i16) / 32767.0;
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let vx = x + if x >= 0.0 { -fold } else { fold };
    let vy = y + if y >= 0.0 { -fold } else { fold };
    Vec3::new(vx, vy, z) / (vx * vx + vy * vy + z * z).sqrt()
}

/// Unit normal of the triangle's plane, on the side from which the corners run counterclockwise; +y where it has no
/// area.
#[inline]
pub fn triangle_geometric_normal(p0: Vec3, p1: Vec3, p2: Vec3) -> Vec3 {
    let e1 = p1 - p0;
    let e2 = p2 - p0;
    // Edges are brought to size 1 first: the squares of a small triangle's area underflow.
    let size = e1.x.abs().max(e1.y.abs()).max(e1.z.abs()).max(e2.x.abs().max(e2.y.abs()).max(e2.z.abs()));
    let scale = 1.0 / size.max(TINY);
    let a = e1 * scale;
    let b = e2 * scale;
    let x = a.y * b.z - a.z * b.y;
    let y = a.z * b.x - a.x * b.z;
    let z = a.x * b.y - a.y * b.x;
    let length = (x * x + y * y + z * z).sqrt();
    if length > 0.0 { Vec3::new(x, y, z) / length.max(TINY) } else { Vec3::Y }
}

/// Unit normal interpolated between those of the corners (packed), b1 and b2 weighing the second and third.
#[inline]
pub fn triangle_shading_normal(n0: u32, n1: u32, n2: u32, b1: f32, b2: f32) -> Vec3 {
    let first = decode_octahedral(n0);
    let n = first * (1.0 - b1 - b2) + decode_octahedral(n1) * b1 + decode_octahedral(n2) * b2;
    let length = (n.x * n.x + n.y * n.y + n.z * n.z).sqrt();
    // Opposite normals cancel: then the first corner's stands.
    if length > 1.0e-6 { n / length.max(TINY) } else { first }
}

/// Texture coordinates of a corner: two 16-bit unorms within the rectangle (least corner, extent). The image's rows
/// count downwards, OBJ's v upwards.
#[inline]
fn decode_uv(packed: u32, rectangle: Vec4) -> Vec2 {
    let share = Vec2::new((packed & 0xffff) as f32, (packed >> 16) as f32) / 65535.0;
    Vec2::new(share.x * rectangle.z + rectangle.x, 1.0 - (share.y * rectangle.w + rectangle.y))
}

/// The direction in the plane with normal n that moves as `along` does across `axis`.
#[inline]
fn tangent_over(along: Vec3, axis: Vec3, n: Vec3) -> Vec3 {
    let slope = (n.x * along.x + n.y * along.y + n.z * along.z) / (n.x * axis.x + n.y * axis.y + n.z * axis.z);
    along - axis * slope
}

/// Coordinates of the mesh's own where it has any (a rectangle with an extent), b1 and b2 weighing the second and third
/// corner. Otherwise one image a unit square, projected along the largest axis of the normal and upright as seen from
/// outside, as on the faces of the cube; those are also the tangents where a triangle has no area in the image.
///
/// `uvs` are the corners' packed coordinates; `rectangle` is (least corner, extent).
pub fn triangle_parameterise(
    [p0, p1, p2]: [Vec3; 3],
    uvs: [u32; 3],
    b1: f32,
    b2: f32,
    rectangle: Vec4,
) -> Parameterisation {
    let own = rectangle.z != 0.0 || rectangle.w != 0.0;
    let [first, second, third] = uvs.map(|uv| decode_uv(uv, rectangle));
    let d1 = second - first;
    let d2 = third - first;
    let determinant = d1.x * d2.y - d1.y * d2.x;
    let has_area = own && determinant.abs() > TINY;
    let inverse = 1.0 / if has_area { determinant } else { 1.0 };
    let e1 = p1 - p0;
    let e2 = p2 - p0;
    let own_uv = first + d1 * b1 + d2 * b2;
    if has_area {
        let dpdu = (e1 * d2.y - e2 * d1.y) * inverse;
        let dpdv = (e2 * d1.x - e1 * d2.x) * inverse;
        return Parameterisation { uv: own_uv, dpdu, dpdv };
    }

    let n = triangle_geometric_normal(p0, p1, p2);
    let size = n.abs();
    let over_x = size.x >= size.y && size.x >= size.z;
    let over_y = !over_x && size.y >= size.z;
    let (axis, along) = match (over_x, over_y) {
        (true, _) => (Vec3::X, n.x),
        (_, true) => (Vec3::Y, n.y),
        _ => (Vec3::Z, n.z),
    };
    let outward = if along < 0.0 { -1.0 } else { 1.0 };
    let right = match (over_x, over_y) {
        (true, _) => Vec3::new(0.0, 0.0, -outward),
        (_, true) => Vec3::X,
        _ => Vec3::new(outward, 0.0, 0.0),
    };
    let down = if over_y { Vec3::new(0.0, 0.0, outward) } else { Vec3::NEG_Y };
    let point = p0 * (1.0 - b1 - b2) + p1 * b1 + p2 * b2;
    let across = Vec2::new(point.x * right.x + point.z * right.z, point.y * down.y + point.z * down.z);
    Parameterisation {
        uv: if own { own_uv } else { across },
        dpdu: tangent_over(right, axis, n),
        dpdv: tangent_over(down, axis, n),
    }
}
