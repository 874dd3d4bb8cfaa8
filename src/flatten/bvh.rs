//! Compressed wide hierarchies in the kernel's layout: binary trees, collapsed by obvhs.

use super::binned;
use crate::layout::Node;
use glam::UVec4;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;

/// Groups that a ray can put aside; `shaders/geometry/bvh.wgsl` has the same constant. Where it enters a mesh it puts
/// two aside, and `build` keeps each level of the hierarchy within half of the rest.
pub const TRAVERSAL_STACK: u32 = 32;
const MAX_STACK: u32 = (TRAVERSAL_STACK - 2) / 2;

/// Primitives in a leaf, the most that the nodes can say.
const MAX_LEAF: u32 = 3;

/// Levels of surface-area splits; a tree that is so deep has boxes within boxes within boxes.
const SAH_LEVELS: u32 = 48;

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
    let hierarchy = collapse(boxes, SAH_LEVELS);
    // Halving by number makes trees whose depth is the logarithm of their size: 24 levels of two, 8 of eight.
    if stack_need(&hierarchy.nodes) > MAX_STACK { collapse(boxes, 0) } else { hierarchy }
}

fn collapse(boxes: &[Aabb], sah_levels: u32) -> Hierarchy {
    let wide = bvh2_to_cwbvh(&binned::build(boxes, sah_levels), MAX_LEAF, true, false);
    let nodes: Vec<Node> = wide.nodes.iter().map(|node| bytemuck::cast(*node)).collect();
    Hierarchy { depth: levels(&nodes).len() as u32, nodes, order: wide.primitive_indices }
}

/// Appends a hierarchy whose primitives begin at `first_primitive` of their buffer.
pub fn append(nodes: &mut Vec<Node>, hierarchy: &[Node], first_primitive: u32) {
    let first_node = nodes.len() as u32;
    nodes.extend(
        hierarchy
            .iter()
            .map(|node| Node { children: node.children + UVec4::new(first_node, first_primitive, 0, 0), ..*node }),
    );
}

/// The inner children of a node, which lie side by side.
fn inner_children(node: &Node) -> std::ops::Range<u32> {
    node.children.x..node.children.x + (node.grid.w >> 24).count_ones()
}

/// Node indices, level by level.
fn levels(nodes: &[Node]) -> Vec<Vec<u32>> {
    let mut levels = Vec::new();
    let mut level: Vec<u32> = (0..nodes.len().min(1) as u32).collect();
    while !level.is_empty() {
        let next = level.iter().flat_map(|&i| inner_children(&nodes[i as usize])).collect();
        levels.push(std::mem::replace(&mut level, next));
    }
    levels
}

/// The most groups that a ray puts aside, in whatever order it visits the children: one at each node whose remaining
/// inner children have to wait.
fn stack_need(nodes: &[Node]) -> u32 {
    let mut needs = vec![0; nodes.len()];
    for &i in levels(nodes).iter().rev().flatten() {
        let children = inner_children(&nodes[i as usize]);
        let waiting = u32::from(children.len() > 1);
        needs[i as usize] = children.map(|child| needs[child as usize] + waiting).max().unwrap_or(0);
    }
    needs.first().copied().unwrap_or(0)
}
