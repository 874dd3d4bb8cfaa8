use glam::{Vec2, Vec3};

/// Triangles over shared vertices, in the space of the node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// For messages: the file or the node it came from.
    pub name: String,
    pub positions: Vec<Vec3>,
    /// One a vertex, or empty: faces are then flat. A zero normal marks a vertex without one.
    pub normals: Vec<Vec3>,
    /// One a vertex, or empty. (0, 0) is the image's lower left corner, as in OBJ.
    pub uvs: Vec<Vec2>,
    /// Indices of corners into the arrays above, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}
