//! Meshes, from OBJ files and from tables.

use super::Function;
use super::nodes::make_node;
use crate::scene::{Geometry, Mesh, PolygonMesh, Shape, load_obj};
use crate::script::arguments::{BadElement, Call, Failure, Outcome, finite, tuple};
use glam::DVec3;
use mlua::{Table, Value};
use std::sync::Arc;

pub(super) const FUNCTIONS: &[Function] = &[("gr.mesh", 3, mesh)];

/// `gr.mesh(name, 'file.obj')` or `gr.mesh(name, vertices, faces)`.
fn mesh(call: &Call) -> Outcome<Value> {
    let name = call.name(0)?;
    let mesh = match call.value(1) {
        Value::String(file) => from_file(call, &file.to_string_lossy())?,
        Value::Table(vertices) => from_tables(call, name, vertices)?,
        _ => return Err(call.unexpected(1, "the name of an OBJ file or a table of vertices")),
    };
    make_node(call, Some(Geometry::new(Shape::Mesh(mesh))), None)
}

/// Reads a file once; the second time the same mesh is shared.
fn from_file(call: &Call, name: &str) -> Outcome<Arc<Mesh>> {
    let fail = |message: String| Failure::Argument { index: 1, message };
    let path = call.state().files.find(name).map_err(|missing| fail(missing.message(name)))?;
    let real = std::fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
    if let Some(mesh) = call.state().meshes.get(&real) {
        return Ok(Arc::clone(mesh));
    }
    let (library, run) = (Arc::clone(&call.state().library), call.state().run);
    let mesh = library.meshes.get(&real, run, || load_obj(&path)).map_err(|error| fail(error.to_string()))?;
    charge(call, &mesh)?;
    call.state_mut().meshes.insert(real, Arc::clone(&mesh));
    Ok(mesh)
}

fn from_tables(call: &Call, name: String, vertices: &Table) -> Outcome<Arc<Mesh>> {
    let faces = call.table(2, "a table of faces, each a table of vertex numbers counted from 0")?;
    call.state_mut().recognise_old_skeleton(call.lua, "a mesh of tables");
    let mut polygons = PolygonMesh::new(name);
    for number in 1..=vertices.raw_len() {
        let position = vertex(call, vertices, number)?;
        polygons.add_vertex(position);
    }
    let mut corners = Vec::new();
    for number in 1..=faces.raw_len() {
        face(call, faces, number, &mut corners)?;
        polygons
            .add_face(&corners)
            .map_err(|message| Failure::Argument { index: 2, message: format!("face [{number}]: {message}") })?;
    }
    let mesh = polygons.finish().map_err(|message| Failure::Argument { index: 2, message })?;
    charge(call, &mesh)?;
    Ok(Arc::new(mesh))
}

fn vertex(call: &Call, vertices: &Table, number: usize) -> Outcome<DVec3> {
    let value = vertices.raw_get::<Value>(number)?;
    let read = match &value {
        Value::Table(numbers) => tuple(call.lua, numbers),
        _ => Err(BadElement::Value(number, value)),
    };
    read.map(DVec3::from_array).map_err(|got| Failure::Argument {
        index: 1,
        message: format!("vertex [{number}]: expected a table of 3 numbers, got {}", call.describe_element(got)),
    })
}

/// Reads the vertex numbers of a face.
fn face(call: &Call, faces: &Table, number: usize, corners: &mut Vec<u32>) -> Outcome<()> {
    corners.clear();
    let fail = |got: String| Failure::Argument {
        index: 2,
        message: format!("face [{number}]: expected a table of vertex numbers counted from 0, got {got}"),
    };
    let value = faces.raw_get::<Value>(number)?;
    let Value::Table(indices) = &value else { return Err(fail(call.describe(&value))) };
    for position in 1..=indices.raw_len() {
        let value = indices.raw_get::<Value>(position)?;
        let index = finite(call.lua, &value).filter(|index| index.fract() == 0.0 && (0.0..=4e9).contains(index));
        match index {
            Some(index) => corners.push(index as u32),
            None => return Err(fail(format!("{} at [{position}]", call.describe(&value)))),
        }
    }
    Ok(())
}

fn charge(call: &Call, mesh: &Mesh) -> Outcome<()> {
    let bytes = size_of_val(mesh.positions.as_slice())
        + size_of_val(mesh.normals.as_slice())
        + size_of_val(mesh.uvs.as_slice())
        + size_of_val(mesh.triangles.as_slice());
    Ok(call.context.guard.charge_memory(call.lua, bytes)?)
}
