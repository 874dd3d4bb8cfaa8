// The nodes of the hierarchies, of which each lane loads its own.
fn node_at(index: u32) -> Node {
    let first = nodes[index][0];
    let second = nodes[index][1];
    let third = nodes[index][2];
    return Node(
        words_of(first.xy),
        words_of(first.zw),
        words_of(second.xy),
        words_of(second.zw),
        words_of(third.xy),
        vec4<u32>(0u),
    );
}
