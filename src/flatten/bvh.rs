//! Compressed wide hierarchies, built by obvhs, in the kernel's layout.

use crate::layout::Node;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::builder::build_cwbvh;
use std::time::Duration;

/// Groups of nodes that a ray can put aside; `shaders/geometry/bvh.wgsl` has the same constant. A ray puts aside at
/// most one group a level, and one more where it enters a mesh.
pub const TRAVERSAL_STACK: u32 = 32;

/// Eight-way hierarchy; indices count from its own first node and primitive.
#[derive(Debug, Default)]
pub struct Hierarchy {
    pub nodes: Vec<Node>,
    /// The primitives as the leaves have them: place i holds primitive `order[i]`.
    pub order: Vec<u32>,
    /// Levels of nodes.
    pub depth: u32,
}

/// Builds the hierarchy over some boxes, which must be finite and small enough that their areas are too.
pub fn build(boxes: &[Aabb]) -> Hierarchy {
    if boxes.is_empty() {
        return Hierarchy::default();
    }
    let built = build_cwbvh(boxes, BvhBuildParams::medium_build(), &mut Duration::default());
    let nodes: Vec<Node> = built.nodes.iter().map(|node| bytemuck::cast(*node)).collect();
    let depth = depth(&nodes);
    Hierarchy { nodes, order: built.primitive_indices, depth }
}

/// Appends a hierarchy whose primitives begin at `first_primitive` of their buffer.
pub fn append(nodes: &mut Vec<Node>, hierarchy: &[Node], first_primitive: u32) {
    let first_node = nodes.len() as u32;
    nodes.extend(hierarchy.iter().map(|node| Node {
        child_base: node.child_base + first_node,
        primitive_base: node.primitive_base + first_primitive,
        ..*node
    }));
}

fn depth(nodes: &[Node]) -> u32 {
    let mut deepest = 0;
    let mut pending = vec![(0u32, 1u32)];
    while let Some((index, level)) = pending.pop() {
        deepest = deepest.max(level);
        let node = &nodes[index as usize];
        let inner_children = (node.exponents_imask >> 24).count_ones();
        pending.extend((0..inner_children).map(|i| (node.child_base + i, level + 1)));
    }
    deepest
}
