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

/// Up to so many primitives are sorted along each axis and split at the best of all places, which takes less time than
/// bins: most nodes are as small as that.
const SWEPT_PRIMITIVES: usize = 8;

/// Below this many primitives a subtree is not worth a task of its own.
const PARALLEL_PRIMITIVES: usize = 4096;

#[derive(Clone, Copy)]
struct Primitive {
    bounds: Aabb,
    index: u32,
}

impl Primitive {
    /// Sum of the corners, twice the centre.
    fn centre(&self) -> Vec3A {
        self.bounds.min + self.bounds.max
    }
}

/// What encloses some primitives, and their centres.
#[derive(Clone, Copy)]
struct Extent {
    bounds: Aabb,
    low: Vec3A,
    high: Vec3A,
}

impl Extent {
    const NOTHING: Extent = Extent { bounds: Aabb::INVALID, low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    fn of(primitives: &[Primitive]) -> Extent {
        primitives.iter().fold(Extent::NOTHING, Extent::with)
    }

    fn with(self, primitive: &Primitive) -> Extent {
        let centre = primitive.centre();
        Extent { bounds: self.bounds.union(&primitive.bounds), low: self.low.min(centre), high: self.high.max(centre) }
    }
}

/// Nodes still to be filled: the first child pair of a subtree, then what lies below them.
struct Below<'a> {
    nodes: &'a mut [Bvh2Node],
    /// Where `nodes` begin in the tree.
    start: u32,
}

/// Where the far side begins, and what encloses the sides.
struct Split {
    middle: usize,
    near: Extent,
    far: Extent,
}

/// Builds the tree, one primitive a leaf. Below `sah_levels` levels, nodes are halved by number, so that no tree is
/// deeper than `sah_levels` + log2 of the number of boxes.
pub fn build(boxes: &[Aabb], sah_levels: u32) -> Bvh2 {
    let mut primitives: Vec<Primitive> =
        boxes.iter().zip(0..).map(|(bounds, index)| Primitive { bounds: *bounds, index }).collect();
    let mut tree = Bvh2::zeroed(boxes.len());
    if let Some((root, rest)) = tree.nodes.split_first_mut() {
        let extent = Extent::of(&primitives);
        split(root, Below { nodes: rest, start: 1 }, &mut primitives, extent, 0, sah_levels);
    }
    tree.primitive_indices = primitives.iter().map(|primitive| primitive.index).collect();
    tree
}

fn split(node: &mut Bvh2Node, below: Below, primitives: &mut [Primitive], extent: Extent, first: u32, sah_levels: u32) {
    let ([left, right, rest @ ..], 2..) = (below.nodes, primitives.len()) else {
        *node = Bvh2Node::new(extent.bounds, primitives.len() as u32, first);
        return;
    };
    *node = Bvh2Node::new(extent.bounds, 0, below.start);

    let Split { middle, near, far } = match (sah_levels, primitives.len()) {
        (0, _) => halve(primitives, &extent),
        (_, ..=SWEPT_PRIMITIVES) => swept_split(primitives),
        _ => binned_split(primitives, &extent).unwrap_or_else(|| halve(primitives, &extent)),
    };
    let levels = sah_levels.saturating_sub(1);
    let parallel = primitives.len() >= PARALLEL_PRIMITIVES;
    let (left_primitives, right_primitives) = primitives.split_at_mut(middle);
    let (left_nodes, right_nodes) = rest.split_at_mut(2 * middle - 2);
    let right_start = below.start + 2 * middle as u32;
    let left_below = Below { nodes: left_nodes, start: below.start + 2 };
    let right_below = Below { nodes: right_nodes, start: right_start };
    let build_left = || split(left, left_below, left_primitives, near, first, levels);
    let build_right = || split(right, right_below, right_primitives, far, first + middle as u32, levels);
    if parallel {
        rayon::join(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
}

/// Puts the half with the lesser centres along the longest axis first.
fn halve(primitives: &mut [Primitive], extent: &Extent) -> Split {
    let axis = longest_axis(extent.high - extent.low);
    let middle = primitives.len() / 2;
    primitives.select_nth_unstable_by(middle, |a, b| {
        a.centre()[axis].total_cmp(&b.centre()[axis]).then(a.index.cmp(&b.index))
    });
    let (near, far) = primitives.split_at(middle);
    Split { middle, near: Extent::of(near), far: Extent::of(far) }
}

/// Sorts a few primitives along the axis, and to the two sides of the place, where the split is cheapest.
fn swept_split(primitives: &mut [Primitive]) -> Split {
    let count = primitives.len();
    let mut best = (f32::INFINITY, 1);
    let mut best_order = [primitives[0]; SWEPT_PRIMITIVES];
    best_order[..count].copy_from_slice(primitives);
    if count > 2 {
        for axis in 0..3 {
            let mut order = [primitives[0]; SWEPT_PRIMITIVES];
            order[..count].copy_from_slice(primitives);
            let order = &mut order[..count];
            order.sort_unstable_by(|a, b| a.centre()[axis].total_cmp(&b.centre()[axis]).then(a.index.cmp(&b.index)));
            let mut far_costs = [0.0; SWEPT_PRIMITIVES];
            let mut far = Aabb::INVALID;
            for i in (1..count).rev() {
                far = far.union(&order[i].bounds);
                far_costs[i] = far.half_area() * (count - i) as f32;
            }
            let mut near = Aabb::INVALID;
            let mut is_best = false;
            for i in 1..count {
                near = near.union(&order[i - 1].bounds);
                let cost = near.half_area() * i as f32 + far_costs[i];
                if cost < best.0 {
                    best = (cost, i);
                    is_best = true;
                }
            }
            if is_best {
                best_order[..count].copy_from_slice(order);
            }
        }
    }
    let (_, middle) = best;
    primitives.copy_from_slice(&best_order[..count]);
    let (near, far) = primitives.split_at(middle);
    Split { middle, near: Extent::of(near), far: Extent::of(far) }
}

/// Sorts the primitives to the two sides of the cheapest plane between bins; `None` where the centres coincide.
fn binned_split(primitives: &mut [Primitive], extent: &Extent) -> Option<Split> {
    let low = extent.low;
    // A little less than the number of bins, so that the last centre is still in the last bin.
    let scale = Vec3A::splat(BINS as f32 * (1.0 - 1e-6)) / (extent.high - low);
    let bin_of = |primitive: &Primitive, axis: usize| {
        (((primitive.centre()[axis] - low[axis]) * scale[axis]) as usize).min(BINS - 1)
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

/// Moves the primitives that are near to the front.
fn partition(primitives: &mut [Primitive], is_near: impl Fn(&Primitive) -> bool) -> Split {
    let mut split = Split { middle: 0, near: Extent::NOTHING, far: Extent::NOTHING };
    for i in 0..primitives.len() {
        let primitive = primitives[i];
        if is_near(&primitive) {
            split.near = split.near.with(&primitive);
            primitives.swap(split.middle, i);
            split.middle += 1;
        } else {
            split.far = split.far.with(&primitive);
        }
    }
    split
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Two heaps of boxes, far apart along one axis and mixed along the others, come apart at the root.
    #[test]
    fn heaps_are_told_apart_by_sorting_and_by_bins() {
        for count in [3, 5, SWEPT_PRIMITIVES, SWEPT_PRIMITIVES + 1, 100] {
            for axis in 0..3 {
                let boxes = (0..count).map(|i| {
                    let mut corner = Vec3A::splat((i * 7 % count) as f32 / count as f32);
                    corner[axis] = if i % 3 == 0 { 100.0 } else { 0.0 };
                    Aabb::new(corner, corner + 0.1)
                });
                let tree = build(&boxes.collect::<Vec<_>>(), 48);
                let children = tree.nodes[0].first_index as usize;
                for side in &tree.nodes[children..children + 2] {
                    let extent = side.aabb().max - side.aabb().min;
                    assert!(extent.max_element() < 2.0, "{count} boxes along axis {axis}: {extent}");
                }
            }
        }
    }
}
