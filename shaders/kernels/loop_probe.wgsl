// How many turns a loop makes before the driver ends it: a program of its own, for `gpu-trace doctor`.
// Two entry points, since Mesa 22.3's llvmpipe counts the turns of all loops of an invocation together.

struct Probe {
    // What is asked for; the nested loops make outer * inner turns.
    single: u32,
    outer: u32,
    inner: u32,
    // Turns made.
    made: u32,
    // A hash of the turns, so that no compiler replaces a loop by its result.
    mixed: u32,
};

@group(0) @binding(0) var<storage, read_write> probe: Probe;

fn mix(value: u32, turn: u32) -> u32 {
    let product = (value ^ turn) * 0x9e3779b1u;
    return product ^ (product >> 15u);
}

@compute @workgroup_size(1)
fn single_loop() {
    var made = 0u;
    var mixed = 0u;
    for (var turn = 0u; turn < probe.single; turn += 1u) {
        made += 1u;
        mixed = mix(mixed, turn);
    }
    probe.made = made;
    probe.mixed = mixed;
}

@compute @workgroup_size(1)
fn nested_loops() {
    var made = 0u;
    var mixed = 0u;
    for (var outer = 0u; outer < probe.outer; outer += 1u) {
        for (var inner = 0u; inner < probe.inner; inner += 1u) {
            made += 1u;
            mixed = mix(mixed, outer + inner);
        }
    }
    probe.made = made;
    probe.mixed = mixed;
}
