//! Meshes, from OBJ files and from tables.

use super::Function;
use super::nodes::make_named_node;
use crate::scene::{Geometry, Mesh, PolygonMesh, Shape, load_obj};
use crate::script::arguments::{Call, Outcome, finite};
use crate::script::fields::Fields;
use crate::script::given::Given;
use crate::script::sequences::{for_each, is_nested, vectors};
use glam::{DVec3, Vec2, Vec3};
use mlua::{Table, Value};
use std::sync::Arc;

pub(super) const FUNCTIONS: &[Function] = &[("gr.mesh", 3, mesh)];

/// The table's keys.
const KEYS: &[&str] = &["name", "file", "same_as", "positions", "faces", "normals", "uvs", "smooth"];

/// `gr.mesh{…}` with [`KEYS`], `gr.mesh(name, 'file.obj')` or `gr.mesh(name, vertices, faces)`.
fn mesh(call: &Call) -> Outcome<Value> {
    let (name, mesh) = match Fields::of_only_argument(call, KEYS) {
        Some(fields) => from_fields(call, &fields?)?,
        None => positional(call)?,
    };
    make_named_node(call, name, Some(Geometry::new(Shape::Mesh(mesh))), None)
}

fn positional(call: &Call) -> Outcome<(String, Arc<Mesh>)> {
    let name = call.name(0)?;
    let mesh = match call.value(1) {
        Value::String(_) => from_file(call, &call.given(1))?,
        Value::Table(_) => {
            call.table(2, FACES_NESTED)?;
            call.state_mut().recognise_old_skeleton(call.lua, "a mesh of tables");
            let positions = positions(&call.given(1))?;
            from_tables(call, &name, Vertices { positions, ..Vertices::default() }, &call.given(2), false)?
        }
        _ => return Err(call.unexpected(1, "the name of an OBJ file or a table of vertices")),
    };
    Ok((name, mesh))
}

fn from_fields(call: &Call, fields: &Fields) -> Outcome<(String, Arc<Mesh>)> {
    fields.exclude(&[&["file"], &["same_as"], &["positions", "faces", "normals", "uvs", "smooth"]])?;
    fields.exclude(&[&["normals"], &["smooth"]])?;
    let name = fields.get("name").or("mesh".to_owned(), |given| given.text("a name"))?;
    let mesh = match fields.get("file") {
        file if !file.absent() => from_file(call, &file)?,
        _ if fields.has("same_as") => of_node(&fields.get("same_as"))?,
        _ => {
            let positions = positions(&fields.get("positions"))?;
            let count = positions.len();
            let normals = fields.get("normals").or(Vec::new(), |given| normals(given, count))?;
            let uvs = fields.get("uvs").or(Vec::new(), |given| uvs(given, count))?;
            let smooth = fields.get("smooth").or(false, Given::flag)?;
            from_tables(call, &name, Vertices { positions, normals, uvs }, &fields.get("faces"), smooth)?
        }
    };
    Ok((name, mesh))
}

/// Reads a file once; the second time the same mesh is shared.
fn from_file(call: &Call, given: &Given) -> Outcome<Arc<Mesh>> {
    let name = given.text("the name of an OBJ file")?;
    let path = call.state().files.find(&name).map_err(|missing| given.fail(missing.message(&name)))?;
    let real = std::fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
    if let Some(mesh) = call.state().meshes.get(&real) {
        return Ok(Arc::clone(mesh));
    }
    let (library, run) = (Arc::clone(&call.state().library), call.state().run);
    let mesh = library.meshes.get(&real, run, || load_obj(&path)).map_err(|error| given.fail(error.to_string()))?;
    charge(call, &mesh)?;
    call.state_mut().meshes.insert(real, Arc::clone(&mesh));
    Ok(mesh)
}

/// The mesh of another node, shared: the new node may have a material of its own.
fn of_node(given: &Given) -> Outcome<Arc<Mesh>> {
    let node = given.node()?;
    match &given.call.state().graph().node(node).geometry {
        Some(Geometry { shape: Shape::Mesh(mesh), .. }) => Ok(Arc::clone(mesh)),
        _ => Err(given.unexpected("a node with a mesh")),
    }
}

/// Of a [`Mesh`].
#[derive(Default)]
struct Vertices {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
}

fn from_tables(call: &Call, name: &str, vertices: Vertices, faces: &Given, smooth: bool) -> Outcome<Arc<Mesh>> {
    let mut polygons = PolygonMesh::new(name);
    polygons.set_vertices(vertices.positions, vertices.normals, vertices.uvs);
    let table = faces.table(if faces.is_argument() { FACES_NESTED } else { FACES })?;
    if is_nested(table)? || faces.is_argument() {
        add_polygons(faces, table, &mut polygons)?;
    } else {
        add_triangles(faces, table, &mut polygons)?;
    }
    let mut mesh = polygons.finish().map_err(|message| faces.fail(message))?;
    if smooth {
        mesh.smooth_normals();
    }
    charge(call, &mesh)?;
    Ok(Arc::new(mesh))
}

const FACES_NESTED: &str = "a table of faces, each a table of vertex numbers counted from 0";
const FACES: &str = "a table of faces, each a table of vertex numbers counted from 0, or of such numbers, 3 a triangle";

fn add_polygons(faces: &Given, table: &Table, polygons: &mut PolygonMesh) -> Outcome<()> {
    let mut corners = Vec::new();
    for_each(table, |number, value| {
        let fail = |got: String| {
            let expected = "a table of vertex numbers counted from 0";
            faces.fail(format!("face [{number}]: expected {expected}, got {got}"))
        };
        let Value::Table(indices) = &value else { return Err(fail(faces.call.describe(&value))) };
        corners.clear();
        for_each(indices, |position, value| {
            let index = vertex_number(faces, &value);
            corners.push(index.ok_or_else(|| fail(format!("{} at [{position}]", faces.call.describe(&value))))?);
            Ok(())
        })?;
        polygons.add_face(&corners).map_err(|message| faces.fail(format!("face [{number}]: {message}")))
    })
}

fn add_triangles(faces: &Given, table: &Table, polygons: &mut PolygonMesh) -> Outcome<()> {
    let mut corners = [0; 3];
    let mut count = 0;
    for_each(table, |position, value| {
        corners[count % 3] = vertex_number(faces, &value).ok_or_else(|| {
            let got = faces.call.describe(&value);
            faces.fail(format!("expected a vertex number counted from 0 at [{position}], got {got}"))
        })?;
        count += 1;
        if !count.is_multiple_of(3) {
            return Ok(());
        }
        let fail = |message| faces.fail(format!("triangle at [{}] to [{position}]: {message}", position - 2));
        polygons.add_face(&corners).map_err(fail)
    })?;
    if !count.is_multiple_of(3) {
        return Err(faces.fail(format!("expected 3 vertex numbers for each triangle, got {count} in all")));
    }
    Ok(())
}

fn vertex_number(faces: &Given, value: &Value) -> Option<u32> {
    let number = finite(faces.call.lua, value)?;
    (number.fract() == 0.0 && (0.0..=4e9).contains(&number)).then_some(number as u32)
}

fn positions(given: &Given) -> Outcome<Vec<Vec3>> {
    Ok(vectors(given, "vertex")?.into_iter().map(Vec3::from_array).collect())
}

fn normals(given: &Given, vertices: usize) -> Outcome<Vec<Vec3>> {
    let normals = vectors(given, "normal")?;
    check_count(given, normals.len(), vertices)?;
    // In double precision, where no square leaves the range.
    let unit = |normal| Vec3::from_array(normal).as_dvec3().try_normalize().unwrap_or(DVec3::ZERO).as_vec3();
    Ok(normals.into_iter().map(unit).collect())
}

/// Scripts count v from the image's top row, as for all shapes; a [`Mesh`] as OBJ files do, from the bottom.
fn uvs(given: &Given, vertices: usize) -> Outcome<Vec<Vec2>> {
    let uvs = vectors(given, "uv")?;
    check_count(given, uvs.len(), vertices)?;
    Ok(uvs.into_iter().map(|[u, v]| Vec2::new(u, 1.0 - v)).collect())
}

fn check_count(given: &Given, count: usize, vertices: usize) -> Outcome<()> {
    match count == vertices {
        true => Ok(()),
        false => Err(given.fail(format!("expected one for each of the {vertices} vertices, got {count}"))),
    }
}

fn charge(call: &Call, mesh: &Mesh) -> Outcome<()> {
    let bytes = size_of_val(mesh.positions.as_slice())
        + size_of_val(mesh.normals.as_slice())
        + size_of_val(mesh.uvs.as_slice())
        + size_of_val(mesh.triangles.as_slice());
    Ok(call.context.guard.charge_memory(call.lua, bytes)?)
}
