//! Instances that stand close together, entered below the roots of their meshes (Benthin, Woop, Wald and Áfra, "Improved
//! Two-Level BVHs using Partial Re-Braiding", HPG 2017).
//!
//! Where the boxes of instances overlap, a ray enters many of them in vain. The upper level is then built over the
//! children of their roots, each of which is a member of its own: fewer are entered, at boxes that fit better. Beside
//! few others this costs more than it saves, as a ray then enters one mesh several times.

use super::instances::Member;
use super::mesh::{Meshes, RootChild};
use crate::layout::{INSTANCE_MIST, SHAPE_MESH};
use rayon::prelude::*;

/// Boxes of members that a ray meets on average, of the rays that meet the box around all, above which the meshes are
/// opened.
const CROWD: f64 = 2.0;

/// Members are opened, the largest first, as long as there are no more than so many: 32 MiB of instances.
const MAX_MEMBERS: usize = 1 << 18;

/// The members, of which those are opened that are worth it.
pub fn open(members: Vec<Member>, meshes: &Meshes) -> Vec<Member> {
    if crowding(&members) < CROWD {
        return members;
    }
    let children = |member: &Member| -> usize {
        let is_surface = member.instance.flags & INSTANCE_MIST == 0;
        let is_mesh = is_surface && member.instance.shape == SHAPE_MESH;
        if is_mesh { meshes.built[member.instance.root as usize].children.len() } else { 0 }
    };
    let mut largest_first: Vec<usize> = (0..members.len()).filter(|&i| children(&members[i]) > 0).collect();
    largest_first
        .sort_by(|&a, &b| members[b].bounds.half_area().total_cmp(&members[a].bounds.half_area()).then(a.cmp(&b)));
    let mut count = members.len();
    let mut is_opened = vec![false; members.len()];
    for i in largest_first {
        count += children(&members[i]) - 1;
        if count > MAX_MEMBERS {
            break;
        }
        is_opened[i] = true;
    }
    let built = &meshes.built;
    let parts = |(member, is_opened): (Member, bool)| {
        if !is_opened {
            return vec![member];
        }
        let mesh = &built[member.instance.root as usize];
        let part = |child: &RootChild| Member {
            bounds: mesh.child_bounds_in(child, &member.world_from_object).padded(),
            entry: child.node,
            ..member
        };
        mesh.children.iter().map(part).collect()
    };
    members.into_par_iter().zip(is_opened).flat_map_iter(parts).collect()
}

/// How many boxes a ray meets on average, if it meets the box around all: boxes are met as their areas are.
fn crowding(members: &[Member]) -> f64 {
    let surfaces = || members.iter().filter(|member| member.instance.flags & INSTANCE_MIST == 0);
    let Some(around) = surfaces().map(|member| member.bounds).reduce(|a, b| a.union(&b)) else { return 0.0 };
    surfaces().map(|member| f64::from(member.bounds.half_area())).sum::<f64>() / f64::from(around.half_area())
}
