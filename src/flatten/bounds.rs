//! Boxes around placed shapes, in world space.

use crate::scene::Shape;
use glam::{DAffine3, DVec3, Vec3A};
use obvhs::aabb::Aabb;

/// An axis-aligned box in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

impl Bounds {
    pub const EMPTY: Bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    pub fn extended(self, point: DVec3) -> Self {
        Bounds { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The box around this one after a map.
    pub fn transformed(self, map: &DAffine3) -> Self {
        let centre = map.transform_point3((self.min + self.max) * 0.5);
        let half = (self.max - self.min) * 0.5;
        let axes = map.matrix3;
        let reach = axes.x_axis.abs() * half.x + axes.y_axis.abs() * half.y + axes.z_axis.abs() * half.z;
        Bounds { min: centre - reach, max: centre + reach }
    }

    /// The box for the hierarchy: larger by more than what the single-precision transform of a ray can be off, and
    /// without flat sides.
    pub fn padded(self) -> Aabb {
        let extent = (self.max - self.min).max_element();
        let distance = self.min.abs().max(self.max.abs()).max_element();
        let pad = extent / f64::from(1 << 20) + distance / f64::from(1 << 21) + f64::from(f32::MIN_POSITIVE);
        Aabb::new(
            Vec3A::from_array((self.min - pad).to_array().map(|v| v as f32)),
            Vec3A::from_array((self.max + pad).to_array().map(|v| v as f32)),
        )
    }
}

/// The smallest box around an analytic shape, from the reach of its image along each world axis; `None` for planes,
/// which have no bounds, and for meshes, whose own box is to be transformed.
pub fn shape_bounds(shape: &Shape, map: &DAffine3) -> Option<Bounds> {
    let rows = map.matrix3.transpose();
    // For each world axis, the (most negative, most positive) reach from the image of the origin. An affine map's
    // row is the direction in object space along which that axis grows.
    let reach = |row: DVec3| match shape {
        Shape::Sphere => Some((-row.length(), row.length())),
        Shape::Cube => Some((row.min(DVec3::ZERO).element_sum(), row.max(DVec3::ZERO).element_sum())),
        Shape::Cylinder => {
            let reach = row.x.hypot(row.z) + row.y.abs();
            Some((-reach, reach))
        }
        // The hull of the apex and the circle at y = -1.
        Shape::Cone => {
            let circle = row.x.hypot(row.z);
            Some(((-row.y - circle).min(0.0), (-row.y + circle).max(0.0)))
        }
        // A ball swept along a circle.
        Shape::Torus { major, minor } => {
            let reach = major * row.x.hypot(row.z) + minor * row.length();
            Some((-reach, reach))
        }
        Shape::Plane | Shape::Mesh(_) => None,
    };
    let (x, y, z) = (reach(rows.x_axis)?, reach(rows.y_axis)?, reach(rows.z_axis)?);
    Some(Bounds { min: map.translation + DVec3::new(x.0, y.0, z.0), max: map.translation + DVec3::new(x.1, y.1, z.1) })
}
