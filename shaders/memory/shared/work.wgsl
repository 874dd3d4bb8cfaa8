// Which pixels an invocation renders. Lavapipe gives each of its threads the same number of workgroups, and waits for the
// last; here a subgroup takes the next pixels that nobody has taken yet, again and again, so that all threads are busy to
// the end. Workgroups that begin later find nothing left.

// The place of a block, one behind the last when nothing is left to do, and the number of a pixel in it. Each kernel
// asks until nothing is left, the first time with turn 0.
fn take_work(group: u32, turn: u32, lane: Lane) -> vec2<u32> {
    if dispatch.takes_work == 0u {
        return own_work(group, turn, lane.index);
    }
    var taken = 0u;
    if lane.in_subgroup == subgroupBroadcastFirst(lane.in_subgroup) {
        taken = atomicAdd(&status.taken, 1u);
    }
    let pixels = BLOCK_EDGE * BLOCK_EDGE;
    // A larger subgroup has no more lanes than the workgroup.
    let pixel = subgroupBroadcastFirst(taken) * min(lane.subgroup_size, pixels);
    return vec2<u32>(dispatch.first_block + pixel / pixels, pixel % pixels + lane.in_subgroup);
}
