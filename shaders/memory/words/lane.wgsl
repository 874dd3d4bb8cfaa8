// Where an invocation stands among the others.
struct Lane {
    // Its number in the workgroup.
    @builtin(local_invocation_index) index: u32,
};

// Each kernel calls this before it traces a ray.
fn claim_lane(lane: Lane) { claim_stack(lane.index); }
