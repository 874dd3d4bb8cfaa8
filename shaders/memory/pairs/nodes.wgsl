// The nodes of the hierarchies, of which each lane loads its own.
fn node_at(index: u32) -> Node { return load_node(index); }
