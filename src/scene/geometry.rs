use super::Mesh;
use glam::DAffine3;
use std::sync::Arc;

/// A shape in the space of its node. `placement` is the shape's own (the `nh_` forms); children do not inherit it.
#[derive(Clone, Debug)]
pub struct Geometry {
    pub shape: Shape,
    pub placement: DAffine3,
}

impl Geometry {
    pub fn new(shape: Shape) -> Self {
        Geometry { shape, placement: DAffine3::IDENTITY }
    }
}

/// The primitives, each in its canonical position.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Radius 1 about the origin.
    Sphere,
    /// [0, 1] on each axis.
    Cube,
    /// x² + z² = 1 for y in [-1, 1], with caps.
    Cylinder,
    /// Apex at the origin, opening to y = -1 with radius 1, with a cap.
    Cone,
    /// About the y axis: `major` from the axis to the centre of the tube, `minor` the tube's radius; both > 0.
    Torus {
        major: f64,
        minor: f64,
    },
    /// y = 0, infinite, normal +y.
    Plane,
    Mesh(Arc<Mesh>),
}
