//! What rays that leave the scene see. Twin of `shaders/shading/background.wgsl`.
