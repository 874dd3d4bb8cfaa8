// The groups of `traverse` that await their turn. At module scope, since WGSL would zero a function's array each time.
var<private> stack: array<vec2<u32>, TRAVERSAL_STACK>;

fn claim_stack(_lane: u32) {}
fn stack_get(place: u32) -> vec2<u32> { return stack[place]; }
fn stack_set(place: u32, group: vec2<u32>) { stack[place] = group; }
