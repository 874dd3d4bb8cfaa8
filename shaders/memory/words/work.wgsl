// Which pixels an invocation renders: one, in the block that its workgroup takes.

// The place of a block, one behind the last when nothing is left to do, and the number of a pixel in it. Each kernel
// asks until nothing is left, the first time with turn 0.
fn take_work(group: u32, turn: u32, lane: Lane) -> vec2<u32> {
    return own_work(group, turn, lane.index);
}
