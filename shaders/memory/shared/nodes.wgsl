// The nodes of the hierarchies. Where neighbouring rays keep together, the lanes of a subgroup mostly visit the same one:
// the first of them loads it, and the others that are there take it over.
fn node_at(index: u32) -> Node {
    if HAS_MANY_MESHES { return load_node(index); }
    let leader = select(subgroup_lane, subgroupBroadcastFirst(subgroup_lane), subgroupBroadcastFirst(index) == index);
    var node: Node;
    if leader == subgroup_lane { node = load_node(index); }
    return Node(
        subgroupShuffle(node.grid, leader),
        subgroupShuffle(node.children, leader),
        subgroupShuffle(node.x, leader),
        subgroupShuffle(node.y, leader),
        subgroupShuffle(node.z, leader),
        vec4<u32>(0u),
    );
}
