//! Wavefront OBJ files: `v`, `vt`, `vn` and `f`; groups and materials are not told apart.

use super::Mesh;
use super::polygons::has_area;
use crate::error::{Error, Result};
use glam::{Vec2, Vec3};
use std::borrow::Cow;
use std::cell::Cell;
use std::io::{self, BufRead, Read};
use std::path::Path;
use std::rc::Rc;

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
    parse_obj(&text, path.display().to_string()).map_err(|message| Error::Format { path: path.to_owned(), message })
}

fn parse_obj(text: &str, name: String) -> std::result::Result<Mesh, String> {
    let line = Rc::new(Cell::new(0));
    let mut reader = Cleaned { lines: text.lines(), line: Rc::clone(&line), form: None, pending: Vec::new(), read: 0 };
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut reader, &options, no_materials).map_err(|error| match error {
        tobj::LoadError::FaceVertexOutOfBounds
        | tobj::LoadError::FaceTexCoordOutOfBounds
        | tobj::LoadError::FaceNormalOutOfBounds => find_bad_index(text).unwrap_or_else(|| error.to_string()),
        _ => format!("line {}: {error}", line.get()),
    })?;
    let models: Vec<_> = models.into_iter().map(|model| model.mesh).collect();
    // tobj takes the index 0 for none at all.
    let complete = |model: &tobj::Mesh| {
        let count = model.positions.len() / 3;
        [0, 3 * count].contains(&model.normals.len()) && [0, 2 * count].contains(&model.texcoords.len())
    };
    if !models.iter().all(complete) {
        return Err(find_bad_index(text).unwrap_or_else(|| "some corners of faces lack an index".to_owned()));
    }
    let mesh = merge(name, models)?;
    if mesh.triangles.is_empty() {
        return Err("there is no face with an area in it".to_owned());
    }
    Ok(mesh)
}

/// Joins the models, in each of which all faces have normals or none, and all have texture coordinates or none.
fn merge(name: String, models: Vec<tobj::Mesh>) -> std::result::Result<Mesh, String> {
    let any_normals = models.iter().any(|model| !model.normals.is_empty());
    let any_uvs = models.iter().any(|model| !model.texcoords.is_empty());
    let mut mesh = Mesh { name, ..Mesh::default() };
    for model in models {
        let base = mesh.positions.len();
        let count = model.positions.len() / 3;
        if u32::try_from(base + count).is_err() {
            return Err("it has more vertices than 32 bits can number".to_owned());
        }
        mesh.positions.extend(triples(&model.positions));
        if any_normals {
            mesh.normals.extend(triples(&model.normals).map(|normal| normal.try_normalize().unwrap_or(Vec3::ZERO)));
            mesh.normals.resize(base + count, Vec3::ZERO);
        }
        if any_uvs {
            mesh.uvs.extend(model.texcoords.chunks_exact(2).map(Vec2::from_slice));
            mesh.uvs.resize(base + count, Vec2::ZERO);
        }
        mesh.triangles.extend(
            model
                .indices
                .chunks_exact(3)
                .map(|corners| [corners[0] as usize, corners[1] as usize, corners[2] as usize])
                .filter(|corners| has_area(corners.map(|corner| mesh.positions[base + corner])))
                .map(|corners| corners.map(|corner| (base + corner) as u32)),
        );
    }
    let finite = mesh.positions.iter().all(|position| position.is_finite()) && mesh.uvs.iter().all(|uv| uv.is_finite());
    if finite { Ok(mesh) } else { Err("it has coordinates that are not finite numbers".to_owned()) }
}

fn triples(numbers: &[f32]) -> impl Iterator<Item = Vec3> {
    numbers.chunks_exact(3).map(Vec3::from_slice)
}

/// Which of its parts the corners of a face have.
#[derive(Clone, Copy, PartialEq, Eq)]
struct CornerForm {
    texture: bool,
    normal: bool,
}

impl CornerForm {
    fn of(corner: &str) -> Self {
        let mut parts = corner.split('/').skip(1);
        let mut has_part = || parts.next().is_some_and(|part| !part.is_empty());
        CornerForm { texture: has_part(), normal: has_part() }
    }
}

/// The lines that matter, as tobj likes them: without comments and vertex colours, and in one model a run of faces of
/// the same form, since tobj would lose track of which vertex has a normal.
struct Cleaned<'a> {
    lines: std::str::Lines<'a>,
    /// Number of the line handed out last, shared with who reports errors.
    line: Rc<Cell<usize>>,
    form: Option<CornerForm>,
    pending: Vec<u8>,
    read: usize,
}

impl Cleaned<'_> {
    fn next_line(&mut self) -> Option<String> {
        let mut line = Cow::Borrowed(self.lines.next()?);
        self.line.set(self.line.get() + 1);
        while let Some(start) = line.trim_end().strip_suffix('\\') {
            let rest = self.lines.next().unwrap_or_default();
            self.line.set(self.line.get() + 1);
            line = Cow::Owned(format!("{start} {rest}"));
        }
        let content = line.split('#').next().unwrap_or_default();
        let mut words = content.split_whitespace();
        Some(match words.next() {
            Some("v") => {
                // Three coordinates and a weight; or three and a colour.
                let numbers: Vec<&str> = words.collect();
                let used = if numbers.len() == 4 { 4 } else { numbers.len().min(3) };
                format!("v {}\n", numbers[..used].join(" "))
            }
            Some("vt" | "vn") => format!("{content}\n"),
            Some("f") => {
                let form = words.next().map(CornerForm::of);
                let switch = form != self.form && self.form.is_some();
                self.form = form;
                if words.any(|corner| Some(CornerForm::of(corner)) != form) {
                    // No corner is spelled so: makes tobj report this line.
                    return Some("f mixed\n".to_owned());
                }
                format!("{}{content}\n", if switch { "o next\n" } else { "" })
            }
            _ => "\n".to_owned(),
        })
    }
}

impl Read for Cleaned<'_> {
    fn read(&mut self, target: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(target)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Cleaned<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.read == self.pending.len() {
            self.pending = self.next_line().unwrap_or_default().into_bytes();
            self.read = 0;
        }
        Ok(&self.pending[self.read..])
    }

    fn consume(&mut self, count: usize) {
        self.read += count;
    }
}

/// Finds the face that refers to something that is not there: tobj notices, but does not say where.
fn find_bad_index(text: &str) -> Option<String> {
    const KINDS: [(&str, &str); 3] = [("v", "vertex"), ("vt", "texture coordinate"), ("vn", "normal")];
    let keyword =
        |line: &str| line.split_whitespace().next().and_then(|word| KINDS.iter().position(|kind| kind.0 == word));
    let mut totals = [0; 3];
    for kind in text.lines().filter_map(keyword) {
        totals[kind] += 1;
    }
    let mut so_far = [0; 3];
    for (number, line) in (1..).zip(text.lines()) {
        if let Some(kind) = keyword(line) {
            so_far[kind] += 1;
        }
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        if words.next() != Some("f") {
            continue;
        }
        for corner in words {
            for (kind, part) in corner.split('/').take(3).enumerate() {
                // What is left out, as in i//k, is not bad.
                let Ok(index) = part.parse::<i64>() else { continue };
                if index == 0 || index > totals[kind] || index < -so_far[kind] {
                    let name = KINDS[kind].1;
                    return Some(format!(
                        "line {number}: the face refers to {name} {index}; there are {}, counted from 1 or back from -1",
                        if index < 0 { so_far[kind] } else { totals[kind] }
                    ));
                }
            }
        }
    }
    None
}
