//! A binary hierarchy by binned surface-area splits, from the root down (Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", IEEE RT 2007).
//!
//! obvhs's own builder merges neighbours from the leaves up, and where many merges cost the same (a row of equal
//! boxes, boxes in the same place) it merges one pair a pass: quadratic time, and trees as deep as they are large.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;

const BINS: usize = 16;

/// Below this many primitives a subtree is not worth a task of its own.
const PARALLEL_PRIMITIVES: usize = 4096;

#[derive(Clone, Copy)]
struct Primitive {
    bounds: Aabb,
    /// Sum of the corners, twice the centre.
    centre: Vec3A,
    index: u32,
}

/// Nodes still to be filled: the first child pair of a subtree, then what lies below them.
struct Below<'a> {
    nodes: &'a mut [Bvh2Node],
    /// Where `nodes` begin in the tree.
    start: u32,
}

/// Builds the tree, one primitive a leaf. Below `sah_levels` levels, nodes are halved by number, so that no tree is
/// deeper than `sah_levels` + log2 of the number of boxes.
pub fn build(boxes: &[Aabb], sah_levels: u32) -> Bvh2 {
    let mut primitives: Vec<Primitive> = boxes
        .iter()
        .zip(0..)
        .map(|(bounds, index)| Primitive { bounds: *bounds, centre: bounds.min + bounds.max, index })
        .collect();
    let mut tree = Bvh2::zeroed(boxes.len());
    if let Some((root, rest)) = tree.nodes.split_first_mut() {
        split(root, Below { nodes: rest, start: 1 }, &mut primitives, 0, sah_levels);
    }
    tree.primitive_indices = primitives.iter().map(|primitive| primitive.index).collect();
    tree
}

fn split(node: &mut Bvh2Node, below: Below, primitives: &mut [Primitive], first: u32, sah_levels: u32) {
    let bounds = primitives.iter().fold(Aabb::INVALID, |bounds, primitive| bounds.union(&primitive.bounds));
    let ([left, right, rest @ ..], 2..) = (below.nodes, primitives.len()) else {
        *node = Bvh2Node::new(bounds, primitives.len() as u32, first);
        return;
    };
    *node = Bvh2Node::new(bounds, 0, below.start);

    let middle = match sah_levels {
        0 => halve(primitives),
        _ => best_split(primitives).unwrap_or_else(|| halve(primitives)),
    };
    let levels = sah_levels.saturating_sub(1);
    let parallel = primitives.len() >= PARALLEL_PRIMITIVES;
    let (left_primitives, right_primitives) = primitives.split_at_mut(middle);
    let (left_nodes, right_nodes) = rest.split_at_mut(2 * middle - 2);
    let right_start = below.start + 2 * middle as u32;
    let left_below = Below { nodes: left_nodes, start: below.start + 2 };
    let right_below = Below { nodes: right_nodes, start: right_start };
    let build_left = || split(left, left_below, left_primitives, first, levels);
    let build_right = || split(right, right_below, right_primitives, first + middle as u32, levels);
    if parallel {
        rayon::join(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
}

/// Puts the half with the lesser centres along the longest axis first, and returns where the other half begins.
fn halve(primitives: &mut [Primitive]) -> usize {
    let (low, high) = centre_range(primitives);
    let axis = longest_axis(high - low);
    let middle = primitives.len() / 2;
    primitives
        .select_nth_unstable_by(middle, |a, b| a.centre[axis].total_cmp(&b.centre[axis]).then(a.index.cmp(&b.index)));
    middle
}

/// Sorts the primitives to the two sides of the cheapest plane between bins, and returns where the far side begins;
/// `None` where the centres coincide.
fn best_split(primitives: &mut [Primitive]) -> Option<usize> {
    let (low, high) = centre_range(primitives);
    let extent = high - low;
    // A little less than the number of bins, so that the last centre is still in the last bin.
    let scale = Vec3A::splat(BINS as f32 * (1.0 - 1e-6)) / extent;
    let bin_of = |primitive: &Primitive, axis: usize| {
        (((primitive.centre[axis] - low[axis]) * scale[axis]) as usize).min(BINS - 1)
    };

    let mut bins = [[(Aabb::INVALID, 0u32); BINS]; 3];
    for primitive in primitives.iter() {
        for (axis, bins) in bins.iter_mut().enumerate() {
            let (bounds, count) = &mut bins[bin_of(primitive, axis)];
            *bounds = bounds.union(&primitive.bounds);
            *count += 1;
        }
    }
    let mut best = (f32::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate().filter(|(axis, _)| scale[*axis].is_finite()) {
        let mut far_costs = [0.0; BINS];
        sweep(bins.iter().enumerate().rev(), |bin, cost, _| far_costs[bin] = cost);
        sweep(bins.iter().enumerate().take(BINS - 1), |bin, cost, count| {
            let total = cost + far_costs[bin + 1];
            if total < best.0 && count > 0 && (count as usize) < primitives.len() {
                best = (total, axis, bin);
            }
        });
    }
    let (cost, axis, last_near_bin) = best;
    cost.is_finite().then(|| partition(primitives, |primitive| bin_of(primitive, axis) <= last_near_bin))
}

/// Adds up bins, and reports for each what the bins so far cost (area times number) and their number of primitives.
fn sweep<'a>(bins: impl Iterator<Item = (usize, &'a (Aabb, u32))>, mut report: impl FnMut(usize, f32, u32)) {
    let (mut bounds, mut count) = (Aabb::INVALID, 0);
    for (bin, (bin_bounds, bin_count)) in bins {
        if *bin_count > 0 {
            bounds = bounds.union(bin_bounds);
            count += bin_count;
        }
        report(bin, if count > 0 { bounds.half_area() * count as f32 } else { 0.0 }, count);
    }
}

/// Moves the primitives that are near to the front, and returns their number.
fn partition(primitives: &mut [Primitive], is_near: impl Fn(&Primitive) -> bool) -> usize {
    let mut near = 0;
    for i in 0..primitives.len() {
        if is_near(&primitives[i]) {
            primitives.swap(near, i);
            near += 1;
        }
    }
    near
}

fn centre_range(primitives: &[Primitive]) -> (Vec3A, Vec3A) {
    primitives.iter().fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), primitive| {
        (low.min(primitive.centre), high.max(primitive.centre))
    })
}

fn longest_axis(extent: Vec3A) -> usize {
    if extent.x >= extent.y && extent.x >= extent.z {
        0
    } else if extent.y >= extent.z {
        1
    } else {
        2
    }
}
