//! Normals turned by a height field (Blinn 1978). Twin of `shaders/shading/bump.wgsl`.
