use super::Mesh;
use glam::{DVec3, Vec3};

impl Mesh {
    /// Gives each vertex the mean of the normals of the triangles around it, each weighted by its angle there (Thürmer
    /// and Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 1998): how a surface is cut into triangles
    /// then does not matter. Vertices without triangles, or whose triangles cancel out, get zero.
    pub fn smooth_normals(&mut self) {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let corners = triangle.map(|corner| self.positions[corner as usize].as_dvec3());
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            for (place, &corner) in triangle.iter().enumerate() {
                let here = corners[place];
                let (to_next, to_previous) = (corners[(place + 1) % 3] - here, corners[(place + 2) % 3] - here);
                let angle = to_next.cross(to_previous).length().atan2(to_next.dot(to_previous));
                sums[corner as usize] += normal * angle;
            }
        }
        self.normals = sums.into_iter().map(|sum| sum.as_vec3().try_normalize().unwrap_or(Vec3::ZERO)).collect();
    }
}
