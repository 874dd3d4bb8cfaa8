use super::Mesh;
use glam::{DVec2, DVec3, Vec2, Vec3};

/// A mesh in the making: vertices and convex planar polygons, each split into a fan of triangles.
#[derive(Debug, Default)]
pub struct PolygonMesh {
    mesh: Mesh,
}

impl PolygonMesh {
    pub fn new(name: impl Into<String>) -> Self {
        PolygonMesh { mesh: Mesh { name: name.into(), ..Mesh::default() } }
    }

    /// Vertices are numbered from 0 in the order in which they are added. Coordinates must be finite in `f32`.
    pub fn add_vertex(&mut self, position: DVec3) {
        self.mesh.positions.push(position.as_vec3());
    }

    /// Gives every vertex a normal, of any length; one of length 0 leaves its vertex without.
    ///
    /// # Errors
    /// A message, if there are not as many as vertices.
    pub fn set_normals(&mut self, normals: &[DVec3]) -> Result<(), String> {
        self.check_count(normals.len(), "normals")?;
        self.mesh.normals = normals.iter().map(|normal| normal.normalize_or_zero().as_vec3()).collect();
        Ok(())
    }

    /// Gives every vertex a texture coordinate, whose v = 0 is the image's top row as on the other shapes.
    ///
    /// # Errors
    /// A message, if there are not as many as vertices.
    pub fn set_uvs(&mut self, uvs: &[DVec2]) -> Result<(), String> {
        self.check_count(uvs.len(), "texture coordinates")?;
        self.mesh.uvs = uvs.iter().map(|uv| Vec2::new(uv.x as f32, (1.0 - uv.y) as f32)).collect();
        Ok(())
    }

    fn check_count(&self, count: usize, what: &str) -> Result<(), String> {
        match self.mesh.positions.len() {
            vertices if vertices == count => Ok(()),
            vertices => Err(format!("{count} {what} for {vertices} vertices")),
        }
    }

    /// Gives every vertex the mean normal of its triangles, weighted by their areas; vertices of none get none.
    pub fn smooth(&mut self) {
        let mut sums = vec![DVec3::ZERO; self.mesh.positions.len()];
        for triangle in &self.mesh.triangles {
            let [p0, p1, p2] = triangle.map(|corner| self.mesh.positions[corner as usize].as_dvec3());
            let area = (p1 - p0).cross(p2 - p0);
            for corner in triangle {
                sums[*corner as usize] += area;
            }
        }
        self.mesh.normals = sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()).collect();
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
