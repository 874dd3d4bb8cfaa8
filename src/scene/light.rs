use glam::{DVec3, Vec3};

/// A light, attenuated by 1 / (c0 + c1 d + c2 d²) over the distance d to it in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    pub position: DVec3,
    /// Linear rgb; may be negative, as some scenes use it to darken.
    pub colour: Vec3,
    /// (c0, c1, c2).
    pub falloff: Vec3,
    pub extent: LightExtent,
    /// Cameras and reflections see the light itself, as a surface of its colour; for extents but `Classic`.
    pub visible: bool,
}

/// What shadow rays aim at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightExtent {
    /// `gr.light`: a point with one shadow ray, a unit square in x and z about the position with more.
    Classic,
    /// A parallelogram centred on the position with these edges, world units.
    Parallelogram { u: DVec3, v: DVec3 },
    /// A ball about the position.
    Sphere { radius: f64 },
}
