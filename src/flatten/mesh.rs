//! Meshes: triangles in the kernel's layout, each mesh with its own hierarchy.

use super::bounds::Bounds;
use super::bvh::{self, Hierarchy};
use super::cache::FlattenCache;
use super::support::Support;
use super::walk::Placement;
use crate::layout::{TRIANGLE_SMOOTH, Triangle};
use crate::scene::{Mesh, Shape};
use crate::{Error, Result};
use glam::{DAffine3, DVec3, Vec2, Vec3, Vec3A, Vec4};
use obvhs::aabb::Aabb;
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// A mesh ready for the buffers.
#[derive(Debug)]
pub struct BuiltMesh {
    /// In the order of the hierarchy's leaves.
    pub triangles: Vec<Triangle>,
    pub hierarchy: Hierarchy,
    /// In object space.
    pub bounds: Bounds,
    /// The children of the hierarchy's root; none where some of these are leaves.
    pub children: Vec<RootChild>,
    /// Least texture coordinates and their extent.
    pub uv_rectangle: Vec4,
    /// Triangles without an area, left out.
    pub degenerate: usize,
    /// Found out once an instance is turned.
    support: OnceLock<Support>,
}

impl BuiltMesh {
    /// The box around the mesh, which has triangles, in another space.
    pub fn bounds_in(&self, map: &DAffine3) -> Bounds {
        let columns = map.matrix3.to_cols_array_2d();
        let is_turned = columns.iter().any(|column| column.iter().filter(|component| **component != 0.0).count() > 1);
        if !is_turned {
            return self.bounds.transformed(map);
        }
        self.support.get_or_init(|| Support::of(&self.triangles)).bounds_in(map)
    }

    /// The box around what one of its root's children leads to in another space.
    pub fn child_bounds_in(&self, child: &RootChild, map: &DAffine3) -> Bounds {
        child.support.get_or_init(|| Support::of(&self.triangles[child.triangles.clone()])).bounds_in(map)
    }
}

/// A node that rays can enter a mesh at in place of the root.
#[derive(Debug)]
pub struct RootChild {
    pub node: u32,
    /// What it leads to, by places in the mesh's triangles.
    triangles: Range<usize>,
    /// Found out once an instance is opened.
    support: OnceLock<Support>,
}

/// The different meshes of a scene, in the order of their first use.
pub struct Meshes {
    pub built: Vec<Arc<BuiltMesh>>,
    indices: HashMap<*const Mesh, usize>,
}

impl Meshes {
    /// Where the mesh is in `built`. A mesh is the same mesh only if it is the same allocation.
    pub fn index_of(&self, mesh: &Arc<Mesh>) -> Option<usize> {
        self.indices.get(&Arc::as_ptr(mesh)).copied()
    }
}

/// Builds each mesh of the placements that the cache lacks once, in parallel.
pub fn build_all(placements: &[Placement], cache: &FlattenCache) -> Result<Meshes> {
    let mut indices = HashMap::new();
    let mut meshes = Vec::new();
    for placement in placements {
        if let Shape::Mesh(mesh) = &placement.geometry.shape {
            indices.entry(Arc::as_ptr(mesh)).or_insert_with(|| {
                meshes.push(mesh);
                meshes.len() - 1
            });
        }
    }
    let built = cache.built(&meshes, build)?;
    let total: usize = built.iter().map(|mesh| mesh.triangles.len()).sum();
    if u32::try_from(total).is_err() {
        return Err(Error::Scene(format!("the scene has {total} triangles; at most {} are possible", u32::MAX)));
    }
    Ok(Meshes { built, indices })
}

/// Positions beyond this have areas that single precision cannot add up.
const MAX_COORDINATE: f32 = 1e12;

/// Triangles whose edges are shorter than this, or whose corners lie on a line to within this share of their edges,
/// have no normal that single precision can find.
const MIN_EDGE: f32 = 1e-18;

/// Triangles that one task takes on: whatever is summed up is so in these portions, however many threads there are.
const PORTION: usize = 4096;

fn build(mesh: &Mesh) -> Result<BuiltMesh> {
    check(mesh)?;
    let corners: Vec<[u32; 3]> = mesh
        .triangles
        .par_iter()
        .with_min_len(PORTION)
        .filter(|corners| area_normal(positions(mesh, **corners)).is_some())
        .copied()
        .collect();
    let boxes: Vec<Aabb> = corners
        .par_iter()
        .with_min_len(PORTION)
        .map(|&corners| {
            let [p0, p1, p2] = positions(mesh, corners).map(Vec3A::from);
            Aabb::new(p0.min(p1).min(p2), p0.max(p1).max(p2))
        })
        .collect();
    // The collapse of the hierarchy is the work of one thread, which leaves the others free.
    let (hierarchy, vertices) = rayon::join(|| bvh::over_triangles(&boxes), || PackedVertices::of(mesh));
    let child = |(node, triangles)| RootChild { node, triangles, support: OnceLock::new() };
    let children = hierarchy.root_children().into_iter().map(child).collect();
    let pack = |&i: &u32| vertices.triangle(mesh, corners[i as usize]);
    Ok(BuiltMesh {
        children,
        triangles: hierarchy.order.par_iter().with_min_len(PORTION).map(pack).collect(),
        degenerate: mesh.triangles.len() - corners.len(),
        bounds: enclose(boxes.iter()),
        uv_rectangle: vertices.uv_rectangle(),
        hierarchy,
        support: OnceLock::new(),
    })
}

fn positions(mesh: &Mesh, corners: [u32; 3]) -> [Vec3; 3] {
    corners.map(|corner| mesh.positions[corner as usize])
}

fn enclose<'a>(boxes: impl Iterator<Item = &'a Aabb>) -> Bounds {
    boxes.fold(Bounds::EMPTY, |bounds, own| bounds.extended(own.min.as_dvec3()).extended(own.max.as_dvec3()))
}

fn check(mesh: &Mesh) -> Result<()> {
    let refuse = |message: String| Err(Error::Scene(format!("mesh '{}': {message}", mesh.name)));
    let count = mesh.positions.len();
    for (what, length) in [("normals", mesh.normals.len()), ("texture coordinates", mesh.uvs.len())] {
        if length != 0 && length != count {
            return refuse(format!("{length} {what} for {count} vertices"));
        }
    }
    // Portion by portion: a search that stops at the first fault is slow to pass over what is right.
    let first = |is_wrong: &(dyn Fn(u32) -> bool + Sync)| {
        let portions = mesh.triangles.par_chunks(PORTION);
        let wrong = portions.find_first(|portion| portion.as_flattened().iter().any(|&corner| is_wrong(corner)))?;
        wrong.as_flattened().iter().copied().find(|&corner| is_wrong(corner))
    };
    if let Some(corner) = first(&|corner| corner as usize >= count) {
        return refuse(format!("a triangle refers to vertex {corner}, but there are only {count}"));
    }
    let is_far_position = |corner| !mesh.positions[corner as usize].abs().cmple(Vec3::splat(MAX_COORDINATE)).all();
    let is_far_uv = |corner| !uv(mesh, corner).abs().cmple(Vec2::splat(MAX_COORDINATE)).all();
    match first(&|corner| is_far_position(corner) || is_far_uv(corner)) {
        None => Ok(()),
        Some(corner) if is_far_position(corner) => {
            let position = mesh.positions[corner as usize];
            refuse(format!("vertex {corner} is at {position}; coordinates must lie within ±1e12"))
        }
        Some(corner) => {
            let uv = uv(mesh, corner);
            refuse(format!("vertex {corner} has the texture coordinate {uv}; they must lie within ±1e12"))
        }
    }
}

fn uv(mesh: &Mesh, corner: u32) -> Vec2 {
    mesh.uvs.get(corner as usize).copied().unwrap_or(Vec2::ZERO)
}

/// A normal of the triangle, of no particular length; `None` where the corners lie on a line.
fn area_normal([p0, p1, p2]: [Vec3; 3]) -> Option<Vec3> {
    // In single precision, since that is how the renderers compute it.
    let (edge1, edge2) = (p1 - p0, p2 - p0);
    let size = edge1.abs().max(edge2.abs()).max_element();
    let normal = (edge1 / size).cross(edge2 / size);
    (size > MIN_EDGE && normal.abs().max_element() > MIN_EDGE).then_some(normal)
}

/// What triangles take from their vertices beside the positions.
struct PackedVertices {
    /// `None` for a vertex without a normal; shorter than the positions where there are no normals.
    normals: Vec<Option<u32>>,
    /// Likewise.
    uvs: Vec<u32>,
    uv_min: Vec2,
    uv_extent: Vec2,
}

impl PackedVertices {
    fn of(mesh: &Mesh) -> Self {
        let (uv_min, uv_extent) = uv_rectangle(mesh);
        let pack_normal = |normal: &Vec3| {
            let unit = normal.as_dvec3().try_normalize()?;
            Some(encode_octahedral(unit.as_vec3()))
        };
        let pack_uv = |uv: &Vec2| encode_uv(*uv, uv_min, uv_extent);
        PackedVertices {
            normals: mesh.normals.par_iter().with_min_len(PORTION).map(pack_normal).collect(),
            uvs: mesh.uvs.par_iter().with_min_len(PORTION).map(pack_uv).collect(),
            uv_min,
            uv_extent,
        }
    }

    /// Least texture coordinates and their extent.
    fn uv_rectangle(&self) -> Vec4 {
        Vec4::new(self.uv_min.x, self.uv_min.y, self.uv_extent.x, self.uv_extent.y)
    }

    /// A triangle that has an area.
    fn triangle(&self, mesh: &Mesh, corners: [u32; 3]) -> Triangle {
        let [p0, p1, p2] = positions(mesh, corners);
        let given = corners.map(|corner| self.normals.get(corner as usize).copied().flatten());
        let smooth = given.iter().any(Option::is_some);
        // A vertex without a normal of its own takes that of the face.
        let [n0, n1, n2] = match given {
            [Some(n0), Some(n1), Some(n2)] => [n0, n1, n2],
            _ => {
                let normal = area_normal([p0, p1, p2]).unwrap_or(Vec3::Y).as_dvec3().normalize();
                let face = encode_octahedral(normal.as_vec3());
                given.map(|normal| normal.unwrap_or(face))
            }
        };
        let [uv0, uv1, uv2] = corners.map(|corner| self.uvs.get(corner as usize).copied().unwrap_or(0));
        Triangle { p0, n0, p1, n1, p2, n2, uv0, uv1, uv2, flags: if smooth { TRIANGLE_SMOOTH } else { 0 } }
    }
}

/// Least texture coordinates of the corners, and their extent; zeros without any.
fn uv_rectangle(mesh: &Mesh) -> (Vec2, Vec2) {
    if mesh.uvs.is_empty() || mesh.triangles.is_empty() {
        return (Vec2::ZERO, Vec2::ZERO);
    }
    let join = |(min, max): (Vec2, Vec2), (low, high): (Vec2, Vec2)| (min.min(low), max.max(high));
    let none = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let of_portion = |triangles: &[[u32; 3]]| {
        let uvs = triangles.iter().flatten().map(|&corner| uv(mesh, corner));
        uvs.fold(none, |rectangle, uv| join(rectangle, (uv, uv)))
    };
    let portions: Vec<(Vec2, Vec2)> = mesh.triangles.par_chunks(PORTION).map(of_portion).collect();
    let (min, max) = portions.into_iter().fold(none, join);
    (min, max - min)
}

/// A unit vector as a point of the unfolded octahedron, two 16-bit snorms, x in the low half (Cigolle et al.,
/// "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014). Off by less than 7e-5.
pub fn encode_octahedral(normal: Vec3) -> u32 {
    let n = normal.as_dvec3();
    let n = n / (n.x.abs() + n.y.abs() + n.z.abs());
    let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
    let DVec3 { x, y, z } = n;
    let (x, y) = if z < 0.0 { ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)) } else { (x, y) };
    let snorm = |v: f64| u32::from((v * 32767.0).round() as i16 as u16);
    snorm(x) | (snorm(y) << 16)
}

/// Two 16-bit unorms within the rectangle of the mesh's texture coordinates, u in the low half.
fn encode_uv(uv: Vec2, min: Vec2, extent: Vec2) -> u32 {
    let unorm = |v: f32, min: f32, extent: f32| {
        if extent > 0.0 { ((f64::from(v) - f64::from(min)) / f64::from(extent) * 65535.0).round() as u16 } else { 0 }
    };
    u32::from(unorm(uv.x, min.x, extent.x)) | (u32::from(unorm(uv.y, min.y, extent.y)) << 16)
}
