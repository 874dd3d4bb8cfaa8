//! Wavefront OBJ files: `v`, `vt`, `vn` and `f`; groups and materials are not told apart.
//!
//! The text is read in portions side by side: what each holds is counted first, so that every portion knows how its
//! lines, vertices, texture coordinates and normals are numbered.

mod lines;
mod records;
#[cfg(test)]
mod tests;

use super::Mesh;
use super::polygons::has_area;
use crate::error::{Error, Result};
use glam::{Vec2, Vec3};
use lines::portions;
use rayon::prelude::*;
use records::{Corner, Counts, NONE, Records};
use std::path::Path;

/// Bytes of text that one task takes on.
const PORTION: usize = 1 << 18;

/// Loads all faces of an OBJ file as one mesh.
///
/// Corners may be `i`, `i/j`, `i//k` or `i/j/k`, counted from 1 or backwards from -1; polygons become fans of
/// triangles; triangles without area are left out. Faces without normals (or texture coordinates) in a file that has
/// some get zero normals (coordinates).
///
/// # Errors
/// [`Error::File`] if the file cannot be read, [`Error::Format`] with the line if it is not an OBJ file with faces.
pub fn load_obj(path: &Path) -> Result<Mesh> {
    let bytes = std::fs::read(path).map_err(|source| Error::file("read the mesh", path, source))?;
    // Comments and names may be in any encoding.
    let text = String::from_utf8_lossy(&bytes);
    let mesh = parse(&text, PORTION).map_err(|message| Error::Format { path: path.to_owned(), message })?;
    Ok(Mesh { name: path.display().to_string(), ..mesh })
}

fn parse(text: &str, portion: usize) -> std::result::Result<Mesh, String> {
    let portions = portions(text, portion);
    let counts: Vec<Counts> = portions.par_iter().map(|portion| Counts::of(portion)).collect();
    let total = counts.iter().copied().fold(Counts::default(), Counts::plus);
    let starts = counts.iter().scan(Counts::default(), |sum, own| Some(std::mem::replace(sum, sum.plus(*own))));
    let starts: Vec<Counts> = starts.collect();
    let records: Vec<_> =
        portions.into_par_iter().zip(starts).map(|(portion, start)| Records::parse(portion, start, &total)).collect();
    // The first error of the file, whichever was found first.
    let records = records.into_iter().collect::<std::result::Result<Vec<Records>, String>>()?;
    let mut mesh = weld(&records)?;
    drop(records);

    let is_finite = |corner: u32| {
        mesh.positions[corner as usize].is_finite() && mesh.uvs.get(corner as usize).is_none_or(|uv| uv.is_finite())
    };
    if !mesh.triangles.par_iter().all(|triangle| triangle.iter().all(|&corner| is_finite(corner))) {
        return Err("it has coordinates that are not finite numbers".to_owned());
    }
    let triangles = std::mem::take(&mut mesh.triangles);
    mesh.triangles = triangles
        .into_par_iter()
        .filter(|triangle| has_area(triangle.map(|corner| mesh.positions[corner as usize])))
        .collect();
    if mesh.triangles.is_empty() {
        return Err("there is no face with an area in it".to_owned());
    }
    Ok(mesh)
}

/// Makes vertices of the corners, in the order of their first use. A corner takes the latest vertex at its position, if
/// that has its texture coordinates and normal too: to look at no more than one keeps the time linear, and corners of
/// one kind mostly come in a row.
fn weld(records: &[Records]) -> std::result::Result<Mesh, String> {
    let positions: Vec<Vec3> = concatenated(records, |records| &records.positions);
    let uvs: Vec<Vec2> = concatenated(records, |records| &records.uvs);
    let normals: Vec<Vec3> = concatenated(records, |records| &records.normals);

    let mut latest = vec![NONE; positions.len()];
    let mut vertices: Vec<Corner> = Vec::with_capacity(positions.len());
    let mut vertex_of = |corner: Corner| {
        let latest = &mut latest[corner.position as usize];
        if *latest == NONE || vertices[*latest as usize] != corner {
            *latest = vertices.len() as u32;
            vertices.push(corner);
        }
        *latest
    };
    let count: usize = records.iter().map(|records| records.triangles.len()).sum();
    if count > (NONE / 3) as usize {
        return Err("it has more vertices than 32 bits can number".to_owned());
    }
    let mut triangles = Vec::with_capacity(count);
    triangles.extend(records.iter().flat_map(|records| &records.triangles).map(|corners| corners.map(&mut vertex_of)));

    let mut mesh = Mesh { triangles, ..Mesh::default() };
    mesh.positions = vertices.par_iter().map(|vertex| positions[vertex.position as usize]).collect();
    if vertices.par_iter().any(|vertex| vertex.uv != NONE) {
        mesh.uvs = vertices.par_iter().map(|vertex| uvs.get(vertex.uv as usize).copied().unwrap_or_default()).collect();
    }
    if vertices.par_iter().any(|vertex| vertex.normal != NONE) {
        let normal_of = |vertex: &Corner| normals.get(vertex.normal as usize).copied().unwrap_or_default();
        mesh.normals = vertices.par_iter().map(normal_of).collect();
    }
    Ok(mesh)
}

fn concatenated<T: Copy>(records: &[Records], part: impl Fn(&Records) -> &[T]) -> Vec<T> {
    records.iter().map(part).collect::<Vec<_>>().concat()
}
