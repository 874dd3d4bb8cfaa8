// The nodes of the hierarchies, word by word.
fn node_at(index: u32) -> Node { return nodes[index]; }
