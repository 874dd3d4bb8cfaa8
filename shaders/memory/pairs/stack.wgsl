// The stack of memory/words/stack.wgsl in the memory of the workgroup, where lavapipe stores 64 bits at once, and does
// not first load what the lanes that are off would keep.
const WORKGROUP_LANES: u32 = 64u;
var<workgroup> stacks: array<u64, WORKGROUP_LANES * TRAVERSAL_STACK>;
var<private> stack_lane: u32;

fn claim_stack(lane: u32) { stack_lane = lane; }
fn stack_get(place: u32) -> vec2<u32> {
    let group = stacks[place * WORKGROUP_LANES + stack_lane];
    return vec2<u32>(u32(group), u32(group >> 32u));
}
fn stack_set(place: u32, group: vec2<u32>) {
    stacks[place * WORKGROUP_LANES + stack_lane] = u64(group.x) | (u64(group.y) << 32u);
}
