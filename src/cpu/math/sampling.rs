//! Directions and points from uniform numbers; twin of `shaders/math/sampling.wgsl`.

use crate::cpu::math::elementary::unit_vector;
use glam::{Vec2, Vec3};

/// Two unit vectors that make a right-handed frame (tangent, bitangent, n) with a unit vector n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    pub tangent: Vec3,
    pub bitangent: Vec3,
}

/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
pub fn orthonormal_basis(n: Vec3) -> Basis {
    let sign = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    Basis {
        tangent: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        bitangent: Vec3::new(b, sign + n.y * n.y * a, -n.y),
    }
}

/// The direction turned to the side that the unit normal points to, by reflection in the surface.
pub fn keep_above(direction: Vec3, normal: Vec3) -> Vec3 {
    let height = direction.dot(normal);
    direction - (2.0 * height).min(0.0) * normal
}

/// A direction through the square of edge `edge` that stands at distance 1 across the unit direction r
/// (Cook, Porter, Carpenter 1984, section 3). Unit length.
pub fn sample_glossy(r: Vec3, edge: f32, xi: Vec2) -> Vec3 {
    let basis = orthonormal_basis(r);
    unit_vector(r + edge * (xi.x - 0.5) * basis.tangent + edge * (xi.y - 0.5) * basis.bitangent)
}

/// A direction uniform in the cone about the unit axis whose half angle has 1 - cosine = one_minus_cos
/// (pbrt-v4, section A.5.4; 1 - cosine keeps its precision for narrow cones).
pub fn sample_cone(axis: Vec3, one_minus_cos: f32, xi: Vec2) -> Vec3 {
    let h = xi.x * one_minus_cos;
    let sine = (h * (2.0 - h)).max(0.0).sqrt();
    let phi = std::f32::consts::TAU * xi.y;
    let basis = orthonormal_basis(axis);
    (1.0 - h) * axis + sine * phi.cos() * basis.tangent + sine * phi.sin() * basis.bitangent
}
