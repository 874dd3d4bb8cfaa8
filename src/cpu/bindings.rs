//! What the kernel binds, as the CPU functions take it; twin of `shaders/bindings.wgsl`.

use crate::layout::{Frame, Instance, Light, Material, Node, Triangle};

#[derive(Clone, Copy)]
pub struct Bindings<'a> {
    pub frame: &'a Frame,
    pub nodes: &'a [Node],
    pub instances: &'a [Instance],
    pub triangles: &'a [Triangle],
    pub materials: &'a [Material],
    pub lights: &'a [Light],
    pub texels: &'a [u32],
}
