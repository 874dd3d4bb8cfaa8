//! Compressed wide hierarchies in the kernel's layout: binary trees, collapsed by obvhs, whose nodes' children are then
//! put in the order of their kinds.

use super::binned;
use crate::layout::Node;
use glam::UVec4;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::cwbvh::node::CwBvhNode;
use std::ops::Range;

/// Groups that a ray can put aside; `shaders/geometry/bvh.wgsl` has the same constant. Where it enters a mesh it puts
/// one aside, and `build` keeps each level of the hierarchy within half of the rest.
pub const TRAVERSAL_STACK: u32 = 32;
const MAX_STACK: u32 = (TRAVERSAL_STACK - 1) / 2;

/// Triangles in a leaf, the most that the nodes can say, and in all leaves of a node.
const MAX_TRIANGLES: u32 = 3;
const MAX_MEMBERS: usize = 8 * MAX_TRIANGLES as usize;

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

impl Hierarchy {
    /// The children of the root, each with the places in `order` of the primitives below it; none if some are leaves.
    pub fn root_children(&self) -> Vec<(u32, Range<usize>)> {
        let Some(root) = self.nodes.first() else { return Vec::new() };
        let nodes = inner_children(root);
        // Nodes lie in the order of their primitives: those of the root's own leaves, then those of each child.
        let start = |node: u32| self.nodes[node as usize].children.y as usize;
        if nodes.is_empty() || start(nodes.start) > 0 {
            return Vec::new();
        }
        let ends = nodes.clone().skip(1).map(start).chain([self.order.len()]);
        nodes.clone().zip(ends).map(|(node, end)| (node, start(node)..end)).collect()
    }
}

/// Builds the hierarchy over the boxes of triangles, which must be finite and small enough that their areas are too.
pub fn over_triangles(boxes: &[Aabb]) -> Hierarchy {
    build(boxes, MAX_TRIANGLES, |_| false)
}

/// Builds the hierarchy over the boxes of instances, likewise. A leaf holds one, so that a ray meets the box of each.
pub fn over_instances(boxes: &[Aabb], is_mesh: impl Fn(u32) -> bool) -> Hierarchy {
    build(boxes, 1, is_mesh)
}

fn build(boxes: &[Aabb], max_leaf: u32, is_mesh: impl Fn(u32) -> bool) -> Hierarchy {
    let hierarchy = collapse(boxes, SAH_LEVELS, max_leaf, &is_mesh);
    // Halving by number makes trees whose depth is the logarithm of their size: 24 levels of two, 8 of eight.
    if stack_need(&hierarchy.nodes) > MAX_STACK { collapse(boxes, 0, max_leaf, &is_mesh) } else { hierarchy }
}

fn collapse(boxes: &[Aabb], sah_levels: u32, max_leaf: u32, is_mesh: &impl Fn(u32) -> bool) -> Hierarchy {
    let wide = bvh2_to_cwbvh(&binned::build(boxes, sah_levels), max_leaf, false, false);
    let mut order = wide.primitive_indices;
    let nodes: Vec<Node> = wide.nodes.into_iter().map(|node| children_by_kind(node, &mut order, is_mesh)).collect();
    Hierarchy { depth: levels(&nodes).len() as u32, nodes, order }
}

/// A node in the kernel's layout: obvhs's, with the inner children in front, so that child i is node i from the first,
/// then the leaves of meshes, and their numbers in place of a mask.
fn children_by_kind(mut node: CwBvhNode, order: &mut [u32], is_mesh: &impl Fn(u32) -> bool) -> Node {
    let base = node.primitive_base_idx as usize;
    let primitives = |meta: u8| {
        let first = base + usize::from(meta & 0x1f);
        first..first + (meta >> 5).count_ones() as usize
    };
    let is_inner = |child: usize| node.imask >> child & 1 == 1;
    let leads_to_mesh = |child: usize| order[primitives(node.child_meta[child])].iter().any(|&i| is_mesh(i));
    let kind = |&child: &usize| match child {
        child if is_inner(child) => 0,
        child if leads_to_mesh(child) => 1,
        _ => 2,
    };
    let mut children = [0, 1, 2, 3, 4, 5, 6, 7];
    // Stable, so that inner children stay in the order of their nodes.
    children.sort_by_key(kind);
    let inner_count = node.imask.count_ones() as u8;
    let mesh_count = children.iter().filter(|child| kind(child) == 1).count() as u8;

    for bytes in [
        &mut node.child_meta,
        &mut node.child_min_x,
        &mut node.child_max_x,
        &mut node.child_min_y,
        &mut node.child_max_y,
        &mut node.child_min_z,
        &mut node.child_max_z,
    ] {
        *bytes = children.map(|child| bytes[child]);
    }
    let (inner, leaves) = node.child_meta.split_at_mut(usize::from(inner_count));
    inner.fill(0);
    // The primitives in the order of their leaves.
    let mut members = Vec::with_capacity(MAX_MEMBERS);
    for meta in leaves {
        let first = members.len() as u8;
        members.extend_from_slice(&order[primitives(*meta)]);
        if *meta != 0 {
            *meta = *meta & 0xe0 | first;
        }
    }
    order[base..base + members.len()].copy_from_slice(&members);
    node.imask = inner_count | mesh_count << 4;
    let [grid, children, x, y, z] = bytemuck::cast(node);
    Node { grid, children, x, y, z, unused: UVec4::ZERO }
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
fn inner_children(node: &Node) -> Range<u32> {
    node.children.x..node.children.x + (node.grid.w >> 24 & 15)
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
