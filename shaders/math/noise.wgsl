// Perlin's improved gradient noise (Perlin 2002, "Improving Noise"): quintic fade and the gradients to the middles of
// a cube's edges. His table of 256 permuted numbers gives way to a 32-bit hash, applied in the same nested way, so that
// the noise does not repeat and costs no memory.

// 6t^5 - 15t^4 + 10t^3: its first and second derivatives are 0 at 0 and at 1.
fn noise_fade(t: f32) -> f32 {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// Product of the offset (x, y, z) from a lattice point with that point's gradient, which the low four bits choose:
// twelve gradients, four of them twice (Perlin's reference implementation).
fn noise_gradient(bits: u32, x: f32, y: f32, z: f32) -> f32 {
    let h = bits & 15u;
    let u = select(y, x, h < 8u);
    let v = select(select(z, x, h == 12u || h == 14u), y, h < 4u);
    return select(-u, u, (h & 1u) == 0u) + select(-v, v, (h & 2u) == 0u);
}

fn noise_mix(t: f32, a: f32, b: f32) -> f32 {
    return a + t * (b - a);
}

// Noise in about [-1, 1], 0 at lattice points. Defined for all finite coordinates: from 2^23 on, every float is a
// lattice point.
fn perlin_noise(p: vec3<f32>) -> f32 {
    let q = clamp(p, vec3<f32>(-16777216.0), vec3<f32>(16777216.0));
    let whole = floor(q);
    let cell = vec3<u32>(vec3<i32>(whole));
    let f0 = q - whole;
    let f1 = f0 - 1.0;

    let h0 = hash_u32(cell.x);
    let h1 = hash_u32(cell.x + 1u);
    let h00 = hash_u32(h0 + cell.y);
    let h01 = hash_u32(h0 + cell.y + 1u);
    let h10 = hash_u32(h1 + cell.y);
    let h11 = hash_u32(h1 + cell.y + 1u);
    let z0 = cell.z;
    let z1 = cell.z + 1u;

    let fade_x = noise_fade(f0.x);
    let fade_y = noise_fade(f0.y);
    let near = noise_mix(
        fade_y,
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h00 + z0), f0.x, f0.y, f0.z),
            noise_gradient(hash_u32(h10 + z0), f1.x, f0.y, f0.z),
        ),
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h01 + z0), f0.x, f1.y, f0.z),
            noise_gradient(hash_u32(h11 + z0), f1.x, f1.y, f0.z),
        ),
    );
    let far = noise_mix(
        fade_y,
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h00 + z1), f0.x, f0.y, f1.z),
            noise_gradient(hash_u32(h10 + z1), f1.x, f0.y, f1.z),
        ),
        noise_mix(
            fade_x,
            noise_gradient(hash_u32(h01 + z1), f0.x, f1.y, f1.z),
            noise_gradient(hash_u32(h11 + z1), f1.x, f1.y, f1.z),
        ),
    );
    return noise_mix(noise_fade(f0.z), near, far);
}

// Five octaves, each of twice the frequency and half the height of the one before (Perlin 1985, "An Image
// Synthesizer": 1/f noise): the sum over i of noise(2^i (u, v, z)) / 2^i.
fn perlin_octaves(u: f32, v: f32, z: f32) -> f32 {
    var sum = 0.0;
    var frequency = 1.0;
    var height = 1.0;
    for (var octave = 0u; octave < 5u; octave++) {
        sum += height * perlin_noise(vec3<f32>(frequency * u, frequency * v, frequency * z));
        frequency *= 2.0;
        height *= 0.5;
    }
    return sum;
}
