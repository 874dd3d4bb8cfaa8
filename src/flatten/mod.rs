//! From the scene graph to the buffers that both renderers read.

use crate::layout::{Frame, Instance, Light, Material, Node, Triangle};

/// Everything that the renderers read; `layout` says what each field holds.
#[derive(Clone, Debug, Default)]
pub struct SceneBuffers {
    pub frame: Frame,
    pub nodes: Vec<Node>,
    pub instances: Vec<Instance>,
    pub triangles: Vec<Triangle>,
    pub materials: Vec<Material>,
    pub lights: Vec<Light>,
    pub texels: Vec<u32>,
}
