// Where an invocation stands among the others.
struct Lane {
    // Its number in the workgroup.
    @builtin(local_invocation_index) index: u32,
    // Its number in the subgroup, whose lanes run together.
    @builtin(subgroup_invocation_id) in_subgroup: u32,
    // Lanes of a subgroup, a power of two.
    @builtin(subgroup_size) subgroup_size: u32,
};

var<private> subgroup_lane: u32;

// Each kernel calls this before it traces a ray.
fn claim_lane(lane: Lane) {
    subgroup_lane = lane.in_subgroup;
    claim_stack(lane.index);
}
