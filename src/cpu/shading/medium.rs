//! Mist: homogeneous volumes that scatter. Twin of `shaders/shading/medium.wgsl`.
