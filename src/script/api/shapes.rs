//! The primitives.

use super::Function;
use super::nodes::make_node;
use crate::scene::{Geometry, Shape};
use crate::script::arguments::{Call, Outcome};
use glam::{DAffine3, DVec3};
use mlua::Value;

pub(super) const FUNCTIONS: &[Function] = &[
    ("gr.sphere", 1, |call| shape(call, Shape::Sphere)),
    ("gr.cube", 1, |call| shape(call, Shape::Cube)),
    ("gr.cylinder", 1, |call| shape(call, Shape::Cylinder)),
    ("gr.cone", 1, |call| shape(call, Shape::Cone)),
    ("gr.plane", 1, |call| shape(call, Shape::Plane)),
    ("gr.torus", 3, torus),
    ("gr.nh_sphere", 3, nh_sphere),
    ("gr.nh_box", 3, nh_box),
];

fn shape(call: &Call, shape: Shape) -> Outcome<Value> {
    make_node(call, Some(Geometry::new(shape)), None)
}

/// `gr.torus(name)`: radii 1 and 0.5; `gr.torus(name, r)`: 1 and r; `gr.torus(name, R, r)`.
fn torus(call: &Call) -> Outcome<Value> {
    call.name(0)?;
    let radius = |index| call.number_where(index, "a radius above 0", |radius| radius > 0.0);
    let (major, minor) = match (call.absent(1), call.absent(2)) {
        (true, true) => (1.0, 0.5),
        (false, true) => (1.0, radius(1)?),
        (_, false) => (radius(1)?, radius(2)?),
    };
    shape(call, Shape::Torus { major, minor })
}

/// `gr.nh_sphere(name, {x, y, z}, r)`: centre and radius.
fn nh_sphere(call: &Call) -> Outcome<Value> {
    call.name(0)?;
    let centre = DVec3::from_array(call.tuple(1)?);
    let radius = call.number_where(2, "a radius above 0", |radius| radius > 0.0)?;
    placed(call, Shape::Sphere, centre, radius)
}

/// `gr.nh_box(name, {x, y, z}, size)`: the cube from that corner to the corner `size` further along each axis.
fn nh_box(call: &Call) -> Outcome<Value> {
    call.name(0)?;
    let corner = DVec3::from_array(call.tuple(1)?);
    let size = call.number_where(2, "a size other than 0", |size| size != 0.0)?;
    placed(call, Shape::Cube, corner, size)
}

fn placed(call: &Call, shape: Shape, position: DVec3, scale: f64) -> Outcome<Value> {
    let placement = DAffine3::from_translation(position) * DAffine3::from_scale(DVec3::splat(scale));
    make_node(call, Some(Geometry { shape, placement }), None)
}
