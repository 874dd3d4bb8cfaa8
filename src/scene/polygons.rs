use super::Mesh;
use glam::{DVec3, Vec2, Vec3};

/// A mesh in the making: vertices and convex planar polygons, each split into a fan of triangles.
#[derive(Debug, Default)]
pub struct PolygonMesh {
    mesh: Mesh,
}

impl PolygonMesh {
    pub fn new(name: impl Into<String>) -> Self {
        PolygonMesh { mesh: Mesh { name: name.into(), ..Mesh::default() } }
    }

    /// Sets the positions, normals and texture coordinates of all vertices, which are numbered from 0 and must be finite,
    /// in the terms of [`Mesh`].
    pub fn set_vertices(&mut self, positions: Vec<Vec3>, normals: Vec<Vec3>, uvs: Vec<Vec2>) {
        self.mesh = Mesh { positions, normals, uvs, ..std::mem::take(&mut self.mesh) };
    }

    /// Adds a polygon with these vertices, counter-clockwise seen from outside. Triangles without area are left out.
    ///
    /// # Errors
    /// A message, if there are fewer than three corners or a vertex does not exist.
    pub fn add_face(&mut self, corners: &[u32]) -> Result<(), String> {
        let count = self.mesh.positions.len();
        if corners.len() < 3 {
            return Err(format!("a face needs at least 3 vertices, got {}", corners.len()));
        }
        if let Some(corner) = corners.iter().find(|corner| **corner as usize >= count) {
            return Err(format!("there is no vertex {corner}; the {count} vertices are counted from 0"));
        }
        for pair in corners[1..].windows(2) {
            let triangle = [corners[0], pair[0], pair[1]];
            if has_area(triangle.map(|corner| self.mesh.positions[corner as usize])) {
                self.mesh.triangles.push(triangle);
            }
        }
        Ok(())
    }

    /// # Errors
    /// A message, if no triangle is left.
    pub fn finish(self) -> Result<Mesh, String> {
        if self.mesh.triangles.is_empty() {
            return Err("the mesh has no face with an area".to_owned());
        }
        Ok(self.mesh)
    }
}

/// Whether three points span an area, in double precision.
pub(super) fn has_area([p0, p1, p2]: [Vec3; 3]) -> bool {
    let [p0, p1, p2] = [p0, p1, p2].map(|p| p.as_dvec3());
    (p1 - p0).cross(p2 - p0) != DVec3::ZERO
}
