//! Random numbers without state; twin of `shaders/math/rng.wgsl`, bit for bit.

use glam::{UVec2, Vec2};

/// Integer hash with low bias (Wellons, "Prospecting for Hash Functions", 2018: lowbias32).
pub fn hash_u32(value: u32) -> u32 {
    let mut x = value;
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^= x >> 16;
    x
}

/// The key of a branch or of a dimension below `key`.
pub fn hash_combine(key: u32, value: u32) -> u32 {
    hash_u32(key ^ hash_u32(value).wrapping_add(0x9e37_79b9))
}

/// Laine and Karras's permutation with Vegdahl's constants: a bit depends on those below it alone, which on reversed
/// bits is Owen's nested uniform scrambling (Burley 2020, section 2.3).
pub fn laine_karras(value: u32, seed: u32) -> u32 {
    let mut x = value;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x
}

pub fn owen_scramble(value: u32, seed: u32) -> u32 {
    laine_karras(value.reverse_bits(), seed).reverse_bits()
}

/// Second dimension of Sobol's sequence with its bits reversed. The generator matrix is Pascal's triangle modulo 2, and
/// C(k, j) is odd where j's bits are a subset of k's, so the product is an XOR over supersets, five steps for 32 bits.
pub fn sobol_second_reversed(index: u32) -> u32 {
    let mut x = index;
    x ^= (x >> 1) & 0x5555_5555;
    x ^= (x >> 2) & 0x3333_3333;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^= (x >> 16) & 0x0000_ffff;
    x
}

/// The upper 24 bits as a number in [0, 1).
pub fn unit_from_bits(bits: u32) -> f32 {
    (bits >> 8) as f32 * 5.960_464_5e-8
}

/// Bits of a point of the (0,2)-sequence, shuffled and scrambled by `key`: points with one key are stratified among
/// each other, points with different keys are independent (Burley 2020, section 3).
pub fn sobol_2d_bits(index: u32, key: u32) -> UVec2 {
    let shuffled = owen_scramble(index, hash_u32(key ^ 0xa511_e9b3));
    let x = laine_karras(shuffled, hash_u32(key ^ 0x63d8_3595)).reverse_bits();
    let y = laine_karras(sobol_second_reversed(shuffled), hash_u32(key ^ 0xb529_7a4d)).reverse_bits();
    UVec2::new(x, y)
}

/// The same as a point of [0, 1)².
pub fn sobol_2d(index: u32, key: u32) -> Vec2 {
    let bits = sobol_2d_bits(index, key);
    Vec2::new(unit_from_bits(bits.x), unit_from_bits(bits.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sobol's second dimension by its direction numbers, v[k] = v[k-1] ^ (v[k-1] >> 1).
    fn by_direction_numbers(index: u32) -> u32 {
        let mut direction = 0x8000_0000_u32;
        let mut x = 0;
        for bit in 0..32 {
            if index >> bit & 1 == 1 {
                x ^= direction;
            }
            direction ^= direction >> 1;
        }
        x
    }

    #[test]
    fn second_dimension_is_that_of_the_direction_numbers() {
        for index in (0..5000).chain((0..5000).map(hash_u32)) {
            assert_eq!(sobol_second_reversed(index).reverse_bits(), by_direction_numbers(index), "index {index}");
        }
    }

    /// Every elementary interval of area 1/n holds one of any n = 2^m points: the net property survives the scrambling.
    #[test]
    fn points_form_a_net() {
        for key in 0..20 {
            let points: Vec<Vec2> = (0..256).map(|index| sobol_2d(index, hash_u32(key))).collect();
            for columns_log2 in 0..=8 {
                let (columns, rows) = (1 << columns_log2, 256 >> columns_log2);
                let mut filled = vec![0; 256];
                for point in &points {
                    filled[(point.x * columns as f32) as usize * rows + (point.y * rows as f32) as usize] += 1;
                }
                assert!(filled.iter().all(|count| *count == 1), "key {key}, {columns} x {rows}");
            }
        }
    }
}
