use super::{Bump, Geometry, Image, Material};
use glam::DAffine3;
use std::sync::Arc;

/// Index into [`SceneGraph::nodes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NodeId(pub u32);

/// Index into [`SceneGraph::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// A node of the directed acyclic graph: a transform, its children, and a shape where it is a geometry node.
#[derive(Clone, Debug)]
pub struct Node {
    pub name: String,
    /// To the space of the parent from that of this node. Invertible.
    pub transform: DAffine3,
    pub children: Vec<NodeId>,
    pub geometry: Option<Geometry>,
    pub material: Option<MaterialId>,
    /// Replaces the material's texture on this node.
    pub texture: Option<Arc<Image>>,
    /// Replaces the material's bump map on this node.
    pub bump: Option<Bump>,
}

impl Node {
    pub fn new(name: impl Into<String>, geometry: Option<Geometry>) -> Self {
        Node {
            name: name.into(),
            transform: DAffine3::IDENTITY,
            children: Vec::new(),
            geometry,
            material: None,
            texture: None,
            bump: None,
        }
    }
}

/// All nodes and materials that a script has made. A node under several parents is an instance.
#[derive(Clone, Debug, Default)]
pub struct SceneGraph {
    pub nodes: Vec<Node>,
    pub materials: Vec<Material>,
}

impl SceneGraph {
    pub fn add_node(&mut self, node: Node) -> NodeId {
        self.nodes.push(node);
        NodeId((self.nodes.len() - 1) as u32)
    }

    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId((self.materials.len() - 1) as u32)
    }

    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0 as usize]
    }

    pub fn node_mut(&mut self, id: NodeId) -> &mut Node {
        &mut self.nodes[id.0 as usize]
    }

    /// Whether `target` can be reached from `start`, itself included: an edge target -> start would close a cycle.
    pub fn reaches(&self, start: NodeId, target: NodeId) -> bool {
        let mut seen = vec![false; self.nodes.len()];
        let mut pending = vec![start];
        while let Some(id) = pending.pop() {
            if id == target {
                return true;
            }
            if !std::mem::replace(&mut seen[id.0 as usize], true) {
                pending.extend(&self.node(id).children);
            }
        }
        false
    }
}
