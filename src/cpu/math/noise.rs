//! Perlin's improved gradient noise (Perlin 2002). Twin of `shaders/math/noise.wgsl`.
