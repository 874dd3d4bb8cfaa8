//! Strategies for rays, hard ones before all: far and close origins, inside starts, tangents, rays along the axes.

use super::oracle::Solid;
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
}

/// The raw choices that a ray is made of, independent of the shape.
#[derive(Clone, Copy, Debug)]
pub struct RayChoice {
    kind: u32,
    towards_origin: DVec3,
    /// Distance of the origin in radii of the bounding sphere.
    distance: f64,
    target: DVec3,
    turn: f64,
    /// Distance of a tangent from the surface, in radii; either sign.
    lift: f64,
    scale: f64,
    axis: usize,
}

pub fn unit_vector() -> impl Strategy<Value = DVec3> + Clone {
    (-1.0..1.0f64, 0.0..TAU).prop_map(|(z, phi)| {
        let rho = (1.0 - z * z).sqrt();
        DVec3::new(rho * phi.cos(), rho * phi.sin(), z)
    })
}

/// 10^u for u uniform in the range.
pub fn power_of_ten(low: f64, high: f64) -> impl Strategy<Value = f64> + Clone {
    (low..high).prop_map(|u| 10f64.powf(u))
}

pub fn ray_choice() -> impl Strategy<Value = RayChoice> {
    let lift = (any::<bool>(), power_of_ten(-8.0, -1.0)).prop_map(|(up, lift)| if up { lift } else { -lift });
    let target = (unit_vector(), 0.0..1.0f64).prop_map(|(d, u)| d * 1.2 * u.cbrt());
    (0..6u32, unit_vector(), power_of_ten(-2.0, 4.0), target, -PI..PI, lift, power_of_ten(-3.0, 3.0), 0..3usize)
        .prop_map(|(kind, towards_origin, distance, target, turn, lift, scale, axis)| RayChoice {
            kind,
            towards_origin,
            distance,
            target,
            turn,
            lift,
            scale,
            axis,
        })
}

impl RayChoice {
    /// The ray in f64, before rounding.
    pub fn exact_ray(&self, solid: &Solid) -> (DVec3, DVec3) {
        let near = solid.centre + self.target * solid.radius;
        let far = solid.centre + self.towards_origin * solid.radius * self.distance;
        let (origin, direction) = match self.kind {
            // From anywhere to anywhere near the shape.
            0 | 1 => (far, near - far),
            // Nearly tangent.
            2 | 3 => {
                let touched = solid.to_surface(near);
                let normal = solid.gradient(touched).normalize_or(DVec3::Y);
                let (tangent, bitangent) = normal.any_orthonormal_pair();
                let along = tangent * self.turn.cos() + bitangent * self.turn.sin();
                let touched = touched + normal * self.lift * solid.radius;
                (touched - along * solid.radius * self.distance, along)
            }
            // From the inside, or from close to the surface.
            4 => (near, self.towards_origin),
            // Parallel to an axis or to a coordinate plane, from a coordinate plane.
            _ => {
                let mut direction = near - far;
                direction[self.axis] = 0.0;
                if self.turn > 0.0 {
                    direction[(self.axis + 1) % 3] = 0.0;
                }
                (near - direction, direction)
            }
        };
        (origin, direction.normalize_or(DVec3::X) * self.scale)
    }

    pub fn ray(&self, solid: &Solid) -> Ray {
        let (origin, direction) = self.exact_ray(solid);
        Ray { origin: origin.as_vec3(), direction: direction.as_vec3() }
    }
}

/// Placements with non-uniform and mirrored scales from 0.01 to 100, turned and moved.
pub fn placement() -> impl Strategy<Value = DAffine3> {
    let factor = || (any::<bool>(), power_of_ten(-2.0, 2.0)).prop_map(|(flip, s)| if flip { -s } else { s });
    (unit_vector(), 0.0..TAU, factor(), factor(), factor(), unit_vector(), power_of_ten(-2.0, 3.0)).prop_map(
        |(axis, angle, x, y, z, away, distance)| {
            let turn = DMat3::from_quat(DQuat::from_axis_angle(axis, angle));
            DAffine3::from_mat3_translation(turn * DMat3::from_diagonal(DVec3::new(x, y, z)), away * distance)
        },
    )
}
