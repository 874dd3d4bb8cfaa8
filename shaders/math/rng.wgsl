// Random numbers without state: every value is a function of (index, key), integer arithmetic alone, so that both
// renderers get the same bits and nothing depends on the order of evaluation.

// Integer hash with low bias (Wellons, "Prospecting for Hash Functions", 2018: lowbias32).
fn hash_u32(value: u32) -> u32 {
    var x = value;
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    x ^= x >> 16u;
    return x;
}

// The key of a branch or of a dimension below `key`.
fn hash_combine(key: u32, value: u32) -> u32 {
    return hash_u32(key ^ (hash_u32(value) + 0x9e3779b9u));
}

// Laine and Karras's permutation with Vegdahl's constants: a bit depends on those below it alone, which on reversed
// bits is Owen's nested uniform scrambling (Burley 2020, section 2.3).
fn laine_karras(value: u32, seed: u32) -> u32 {
    var x = value;
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

fn owen_scramble(value: u32, seed: u32) -> u32 {
    return reverseBits(laine_karras(reverseBits(value), seed));
}

// Second dimension of Sobol's sequence with its bits reversed. The generator matrix is Pascal's triangle modulo 2, and
// C(k, j) is odd where j's bits are a subset of k's, so the product is an XOR over supersets, five steps for 32 bits.
fn sobol_second_reversed(index: u32) -> u32 {
    var x = index;
    x ^= (x >> 1u) & 0x55555555u;
    x ^= (x >> 2u) & 0x33333333u;
    x ^= (x >> 4u) & 0x0f0f0f0fu;
    x ^= (x >> 8u) & 0x00ff00ffu;
    x ^= (x >> 16u) & 0x0000ffffu;
    return x;
}

// The upper 24 bits as a number in [0, 1).
fn unit_from_bits(bits: u32) -> f32 {
    return f32(bits >> 8u) * 5.9604645e-8;
}

// Bits of a point of the (0,2)-sequence, shuffled and scrambled by `key`: points with one key are stratified among each
// other, points with different keys are independent (Burley 2020, section 3).
fn sobol_2d_bits(index: u32, key: u32) -> vec2<u32> {
    let shuffled = owen_scramble(index, hash_u32(key ^ 0xa511e9b3u));
    let x = reverseBits(laine_karras(shuffled, hash_u32(key ^ 0x63d83595u)));
    let y = reverseBits(laine_karras(sobol_second_reversed(shuffled), hash_u32(key ^ 0xb5297a4du)));
    return vec2<u32>(x, y);
}

// The same as a point of [0, 1)^2.
fn sobol_2d(index: u32, key: u32) -> vec2<f32> {
    let bits = sobol_2d_bits(index, key);
    return vec2<f32>(unit_from_bits(bits.x), unit_from_bits(bits.y));
}
