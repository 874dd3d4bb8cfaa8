//! `gr.node`, `gr.joint`, and what hangs nodes together.

use super::Function;
use crate::scene::{Bump, Geometry, Image, MaterialId, NodeId};
use crate::script::arguments::{Call, Failure, NodeHandle, Outcome};
use crate::script::state::State;
use glam::{DQuat, DVec3};
use mlua::Value;
use std::sync::Arc;

pub(super) const FUNCTIONS: &[Function] = &[
    ("gr.node", 1, node),
    ("gr.joint", 3, joint),
    ("gr.add_child", 2, add_child),
    ("gr.set_material", 2, set_material),
    ("gr.set_texture", 2, set_texture),
    ("gr.set_bump", 2, set_bump),
];

/// Makes a node that is named by argument 1, and its handle.
pub(super) fn make_node(call: &Call, geometry: Option<Geometry>, joint: Option<DQuat>) -> Outcome<Value> {
    make_named_node(call, call.name(0)?, geometry, joint)
}

pub(super) fn make_named_node(
    call: &Call,
    name: String,
    geometry: Option<Geometry>,
    joint: Option<DQuat>,
) -> Outcome<Value> {
    call.context.guard.charge_memory(call.lua, State::NODE_BYTES + name.len())?;
    let id = call.state_mut().add_node(name, geometry, joint);
    Ok(Value::UserData(call.lua.create_userdata(NodeHandle(id))?))
}

/// `gr.node(name)`: a transform without a shape.
fn node(call: &Call) -> Outcome<Value> {
    make_node(call, None, None)
}

/// `gr.joint(name, {min, init, max}, {min, init, max})`: a node turned by its two init angles, in degrees, about x and
/// then y. The ranges are for programs that move joints.
fn joint(call: &Call) -> Outcome<Value> {
    call.name(0)?;
    let [_, about_x, _] = call.tuple::<3>(1)?;
    let [_, about_y, _] = call.tuple::<3>(2)?;
    let x = DQuat::from_axis_angle(DVec3::X, about_x.to_radians());
    let y = DQuat::from_axis_angle(DVec3::Y, about_y.to_radians());
    make_node(call, None, Some(y * x))
}

/// `parent:add_child(child)`. A node may have several parents: each is an instance of it.
fn add_child(call: &Call) -> Outcome<Value> {
    let parent = call.node(0)?;
    let child = call.node(1)?;
    call.context.guard.charge_memory(call.lua, size_of::<NodeId>())?;
    if !call.state_mut().add_child(parent, child) {
        let state = call.state();
        let [parent, child] = [parent, child].map(|id| state.graph().node(id).name.clone());
        let message =
            format!("'{child}' already has '{parent}' below it, or is the same node; a node cannot contain itself");
        return Err(Failure::Argument { index: 1, message });
    }
    Ok(Value::Nil)
}

/// `node:set_material(material)`, on nodes with a shape. Children do not inherit it.
fn set_material(call: &Call) -> Outcome<Value> {
    let node = call.node(0)?;
    let material = call.given(1).material()?;
    check_shape(call, node, "a material")?;
    call.state_mut().set_material(node, material);
    warn_of_texture_in_mist(call, node);
    Ok(Value::Nil)
}

/// `node:set_texture(texture)`, on nodes with a shape: in place of the material's; nil gives that back.
fn set_texture(call: &Call) -> Outcome<Value> {
    let node = call.node(0)?;
    let texture = image_or_nil(call, 1)?;
    check_shape(call, node, "a texture")?;
    call.state_mut().set_texture(node, texture);
    warn_of_texture_in_mist(call, node);
    Ok(Value::Nil)
}

/// `node:set_bump(texture)`, on nodes with a shape: in place of the material's; nil gives that back.
fn set_bump(call: &Call) -> Outcome<Value> {
    let node = call.node(0)?;
    let bump = image_or_nil(call, 1)?.map(Bump::Image);
    check_shape(call, node, "a bump map")?;
    call.state_mut().set_bump(node, bump);
    Ok(Value::Nil)
}

/// Mist has no surface that could show an image.
fn warn_of_texture_in_mist(call: &Call, node: NodeId) {
    let idle = {
        let state = call.state();
        let node = state.graph().node(node);
        let is_mist = |id: MaterialId| state.graph().materials[id.0 as usize].density.is_some();
        (node.texture.is_some() && node.material.is_some_and(is_mist)).then(|| node.name.clone())
    };
    if let Some(name) = idle {
        call.state_mut().warn(call.lua, &format!("'{name}' is mist, which has no surface: its texture does nothing"));
    }
}

fn image_or_nil(call: &Call, index: usize) -> Outcome<Option<Arc<Image>>> {
    if call.absent(index) { Ok(None) } else { call.given(index).image().map(Some) }
}

fn check_shape(call: &Call, node: NodeId, what: &str) -> Outcome<()> {
    let state = call.state();
    match state.graph().node(node) {
        node if node.geometry.is_some() => Ok(()),
        node => {
            let name = &node.name;
            Err(Failure::Call(format!("'{name}' has no shape that could have {what}; set it on the shapes")))
        }
    }
}
