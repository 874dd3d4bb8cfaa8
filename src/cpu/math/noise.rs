//! Perlin's improved gradient noise (Perlin 2002, "Improving Noise"): quintic fade and the gradients to the middles of
//! a cube's edges. His table of 256 permuted numbers gives way to a 32-bit hash, applied in the same nested way, so
//! that the noise does not repeat and costs no memory. Twin of `shaders/math/noise.wgsl`, bit for bit.

use super::rng::hash_u32;
use glam::Vec3;

/// 6t⁵ − 15t⁴ + 10t³: its first and second derivatives are 0 at 0 and at 1.
pub fn noise_fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Product of the offset (x, y, z) from a lattice point with that point's gradient, which the low four bits choose:
/// twelve gradients, four of them twice (Perlin's reference implementation).
pub fn noise_gradient(bits: u32, x: f32, y: f32, z: f32) -> f32 {
    let h = bits & 15;
    let u = if h < 8 { x } else { y };
    let v = if h < 4 {
        y
    } else if h == 12 || h == 14 {
        x
    } else {
        z
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

fn noise_mix(t: f32, a: f32, b: f32) -> f32 {
    a + t * (b - a)
}

/// Noise in about [-1, 1], 0 at lattice points. Defined for all finite coordinates: from 2²³ on, every float is a
/// lattice point.
pub fn perlin_noise(p: Vec3) -> f32 {
    let q = p.clamp(Vec3::splat(-16_777_216.0), Vec3::splat(16_777_216.0));
    let whole = q.floor();
    let cell = whole.as_ivec3().as_uvec3();
    let f0 = q - whole;
    let f1 = f0 - 1.0;

    let h0 = hash_u32(cell.x);
    let h1 = hash_u32(cell.x.wrapping_add(1));
    let h00 = hash_u32(h0.wrapping_add(cell.y));
    let h01 = hash_u32(h0.wrapping_add(cell.y).wrapping_add(1));
    let h10 = hash_u32(h1.wrapping_add(cell.y));
    let h11 = hash_u32(h1.wrapping_add(cell.y).wrapping_add(1));
    let z0 = cell.z;
    let z1 = cell.z.wrapping_add(1);

    let fade_x = noise_fade(f0.x);
    let fade_y = noise_fade(f0.y);
    let near = noise_mix(
        fade_y,
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h00.wrapping_add(z0)), f0.x, f0.y, f0.z),
            noise_gradient(hash_u32(h10.wrapping_add(z0)), f1.x, f0.y, f0.z),
        ),
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h01.wrapping_add(z0)), f0.x, f1.y, f0.z),
            noise_gradient(hash_u32(h11.wrapping_add(z0)), f1.x, f1.y, f0.z),
        ),
    );
    let far = noise_mix(
        fade_y,
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h00.wrapping_add(z1)), f0.x, f0.y, f1.z),
            noise_gradient(hash_u32(h10.wrapping_add(z1)), f1.x, f0.y, f1.z),
        ),
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h01.wrapping_add(z1)), f0.x, f1.y, f1.z),
            noise_gradient(hash_u32(h11.wrapping_add(z1)), f1.x, f1.y, f1.z),
        ),
    );
    noise_mix(noise_fade(f0.z), near, far)
}

/// Five octaves, each of twice the frequency and half the height of the one before (Perlin 1985, "An Image
/// Synthesizer": 1/f noise): the sum over i of noise(2ⁱ (u, v, z)) / 2ⁱ.
pub fn perlin_octaves(u: f32, v: f32, z: f32) -> f32 {
    let mut sum = 0.0;
    let mut frequency = 1.0;
    let mut height = 1.0;
    for _ in 0..5 {
        sum += height * perlin_noise(Vec3::new(frequency * u, frequency * v, frequency * z));
        frequency *= 2.0;
        height *= 0.5;
    }
    sum
}
