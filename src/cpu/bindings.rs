//! What the kernel binds, as the CPU functions take it; twin of `shaders/bindings.wgsl`.

use crate::flatten::SceneBuffers;
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
    /// `HAS_MIST` of the kernel.
    pub has_mist: bool,
}

impl<'a> Bindings<'a> {
    /// The buffers of a scene with constants of their own.
    pub fn new(scene: &'a SceneBuffers, frame: &'a Frame) -> Self {
        Bindings {
            frame,
            nodes: &scene.nodes,
            instances: &scene.instances,
            triangles: &scene.triangles,
            materials: &scene.materials,
            lights: &scene.lights,
            texels: &scene.texels,
            has_mist: scene.features.mist,
        }
    }
}
