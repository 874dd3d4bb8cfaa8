use glam::DVec3;

/// A perspective camera with a square lens (Cook, Porter, Carpenter 1984, section 4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: DVec3,
    /// Direction of view, unit length.
    pub forward: DVec3,
    /// Need not be orthogonal to `forward`, nor of unit length, but not parallel to it.
    pub up: DVec3,
    /// Vertical angle of view in degrees, in (0, 180); pixels are square.
    pub fov: f64,
    /// Edge of the lens in world units; 0 is a pinhole.
    pub lens_edge: f64,
    /// Distance from the eye to the plane in focus, along `forward`.
    pub focus_distance: f64,
}
