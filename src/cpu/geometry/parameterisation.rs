//! Texture coordinates and tangents of the surface at a hit. Twin of `shaders/geometry/parameterisation.wgsl`.
