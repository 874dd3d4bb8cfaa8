//! Walks the scene graph: one placement for each path from the root to a geometry node.

use crate::scene::{Geometry, MaterialId, NodeId, Scene, SceneGraph};
use crate::{Error, Result};
use glam::{DAffine3, DMat3};

/// More instances than this are refused: their buffer alone would take 2 GiB.
pub const MAX_INSTANCES: u64 = 1 << 24;

/// The volume that an invertible map leaves of a unit cube, as a share of the product of the cube's edges: less is
/// the rounding of a map that flattens.
const MIN_RELATIVE_DETERMINANT: f64 = 1e-12;

/// A shape where one path through the graph puts it.
pub struct Placement<'a> {
    pub geometry: &'a Geometry,
    pub material: Option<MaterialId>,
    pub node: NodeId,
    pub world_from_object: DAffine3,
}

/// The placements in depth-first order, children in the order in which they were added.
pub fn placements(scene: &Scene) -> Result<Vec<Placement<'_>>> {
    let graph = &*scene.graph;
    let paths = count_paths(graph, scene.root)?;
    let total = paths[scene.root.0 as usize];
    if total > MAX_INSTANCES {
        return Err(Error::Scene(format!(
            "the scene below '{}' has {total} instances; at most {MAX_INSTANCES} are possible",
            graph.node(scene.root).name
        )));
    }
    let mut result = Vec::with_capacity(total as usize);
    let mut pending = vec![(scene.root, DAffine3::IDENTITY)];
    while let Some((id, world_from_parent)) = pending.pop() {
        let node = graph.node(id);
        let world_from_node = world_from_parent * node.transform;
        if let Some(geometry) = &node.geometry {
            let world_from_object = world_from_node * geometry.placement;
            check_invertible(&world_from_object, &node.name, "the transforms down to it, taken together,")?;
            result.push(Placement { geometry, material: node.material, node: id, world_from_object });
        }
        let used = node.children.iter().rev().filter(|child| paths[child.0 as usize] > 0);
        pending.extend(used.map(|&child| (child, world_from_node)));
    }
    Ok(result)
}

/// For each node that the root reaches, how many paths lead from it to geometry; checks their transforms.
fn count_paths(graph: &SceneGraph, root: NodeId) -> Result<Vec<u64>> {
    #[derive(Clone, Copy, PartialEq)]
    enum Visit {
        Not,
        Begun,
        Done,
    }
    let mut visits = vec![Visit::Not; graph.nodes.len()];
    let mut paths = vec![0u64; graph.nodes.len()];
    let mut pending = vec![root];
    while let Some(&id) = pending.last() {
        let node = graph.node(id);
        match visits[id.0 as usize] {
            Visit::Not => {
                visits[id.0 as usize] = Visit::Begun;
                for &child in &node.children {
                    match visits[child.0 as usize] {
                        Visit::Not => pending.push(child),
                        Visit::Begun => {
                            return Err(Error::Scene(format!(
                                "node '{}' is its own descendant, through '{}'",
                                graph.node(child).name,
                                node.name
                            )));
                        }
                        Visit::Done => {}
                    }
                }
            }
            Visit::Begun => {
                pending.pop();
                visits[id.0 as usize] = Visit::Done;
                let own = u64::from(node.geometry.is_some());
                let below = node.children.iter().map(|child| paths[child.0 as usize]);
                let count = below.fold(own, u64::saturating_add);
                paths[id.0 as usize] = count;
                if count > 0 {
                    check_invertible(&node.transform, &node.name, "its transform")?;
                }
                if let Some(geometry) = &node.geometry {
                    check_invertible(&geometry.placement, &node.name, "the placement of its shape")?;
                }
            }
            Visit::Done => {
                pending.pop();
            }
        }
    }
    Ok(paths)
}

fn check_invertible(map: &DAffine3, name: &str, what: &str) -> Result<()> {
    if !map.is_finite() {
        return Err(Error::Scene(format!("node '{name}': {what} has entries that are not finite")));
    }
    let DMat3 { x_axis, y_axis, z_axis } = map.matrix3;
    let edges = x_axis.length() * y_axis.length() * z_axis.length();
    // Written so that NaN, from entries near the end of the range, fails too.
    if edges > 0.0 && map.matrix3.determinant().abs() > MIN_RELATIVE_DETERMINANT * edges {
        return Ok(());
    }
    Err(Error::Scene(format!("node '{name}': {what} cannot be inverted (is it scaled by 0?)")))
}
