//! Meshes, from OBJ files and from tables.

use super::Function;
use super::nodes::{make_named_node, make_node};
use crate::scene::{Geometry, Mesh, PolygonMesh, Shape, load_obj};
use crate::script::api::mesh_arrays::{faces, texture_coordinates, vectors};
use crate::script::arguments::{Call, Failure, Outcome};
use crate::script::fields::Fields;
use crate::script::given::Given;
use mlua::Value;
use std::sync::Arc;

pub(super) const FUNCTIONS: &[Function] = &[("gr.mesh", 5, mesh)];

const KEYS: &[&str] = &["name", "file", "same_as", "positions", "faces", "normals", "uvs", "smooth"];

/// `gr.mesh(name, 'file.obj')`, `gr.mesh(name, positions, faces[, normals[, uvs]])`, or `gr.mesh{…}` with [`KEYS`].
fn mesh(call: &Call) -> Outcome<Value> {
    if let Some(fields) = Fields::of_only_argument(call, KEYS) {
        return from_fields(call, &fields?);
    }
    let name = call.name(0)?;
    let mesh = match call.value(1) {
        Value::String(_) => from_file(&call.given(1))?,
        Value::Table(_) => {
            let fields = Fields::of_arguments(call, &["name", "positions", "faces", "normals", "uvs"], 3);
            fields.get("faces").table("a table of faces, each a table of vertex numbers counted from 0")?;
            call.state_mut().recognise_old_skeleton(call.lua, "a mesh of tables");
            from_tables(call, name, &fields)?
        }
        _ => return Err(call.unexpected(1, "the name of an OBJ file or a table of vertices")),
    };
    make_node(call, Some(Geometry::new(Shape::Mesh(mesh))), None)
}

fn from_fields(call: &Call, fields: &Fields) -> Outcome<Value> {
    fields.exclude(&[&["file"], &["same_as"], &["positions", "faces", "normals", "uvs", "smooth"]])?;
    let name = fields.get("name").or("mesh".to_owned(), |given| given.text("a name"))?;
    let mesh = if fields.has("file") {
        from_file(&fields.get("file"))?
    } else if fields.has("same_as") {
        of_node(&fields.get("same_as"))?
    } else {
        from_tables(call, name.clone(), fields)?
    };
    make_named_node(call, name, Some(Geometry::new(Shape::Mesh(mesh))), None)
}

/// The mesh of another node, shared: the new node may have a material of its own.
fn of_node(given: &Given) -> Outcome<Arc<Mesh>> {
    let node = given.node()?;
    match &given.call.state().graph().node(node).geometry {
        Some(Geometry { shape: Shape::Mesh(mesh), .. }) => Ok(Arc::clone(mesh)),
        _ => Err(given.unexpected("a node with a mesh")),
    }
}

/// Reads a file once; the second time the same mesh is shared.
fn from_file(given: &Given) -> Outcome<Arc<Mesh>> {
    let call = given.call;
    let name = given.text("the name of an OBJ file")?;
    let path = call.state().files.find(&name).map_err(|missing| given.fail(missing.message(&name)))?;
    let real = std::fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
    if let Some(mesh) = call.state().meshes.get(&real) {
        return Ok(Arc::clone(mesh));
    }
    let mesh = Arc::new(load_obj(&path).map_err(|error| given.fail(error.to_string()))?);
    charge(call, &mesh)?;
    call.state_mut().meshes.insert(real, Arc::clone(&mesh));
    Ok(mesh)
}

fn from_tables(call: &Call, name: String, fields: &Fields) -> Outcome<Arc<Mesh>> {
    let mut polygons = PolygonMesh::new(name);
    for position in vectors(&fields.get("positions"), "vertex")? {
        polygons.add_vertex(position);
    }
    if fields.has("normals") {
        let given = fields.get("normals");
        polygons.set_normals(&vectors(&given, "normal")?).map_err(|message| given.fail(message))?;
    }
    if fields.has("uvs") {
        let given = fields.get("uvs");
        polygons.set_uvs(&texture_coordinates(&given)?).map_err(|message| given.fail(message))?;
    }
    let given = fields.get("faces");
    faces(&given, &mut polygons)?;
    if fields.get("smooth").or(false, Given::flag)? && !fields.has("normals") {
        polygons.smooth();
    }
    let mesh = polygons.finish().map_err(|message| given.fail(message))?;
    charge(call, &mesh)?;
    Ok(Arc::new(mesh))
}

fn charge(call: &Call, mesh: &Mesh) -> Outcome<()> {
    let bytes = size_of_val(mesh.positions.as_slice())
        + size_of_val(mesh.normals.as_slice())
        + size_of_val(mesh.uvs.as_slice())
        + size_of_val(mesh.triangles.as_slice());
    call.context.guard.charge_memory(call.lua, bytes).map_err(Failure::Lua)
}
