//! The distinct images of a scene in one buffer of texels, each with its levels; `shaders/shading/texture.wgsl`
//! describes the format.

use super::cache::FlattenCache;
use crate::layout::NONE;
use crate::scene::{Image, Texels};
use crate::{Error, Result};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// Formats of texels, as `shaders/shading/texture.wgsl` numbers them.
const TEXELS_RGBA8: u32 = 0;
const TEXELS_RGB9E5: u32 = 1;

/// Words before the table of levels.
const HEADER: usize = 4;

/// Levels of the largest image that u32 can describe.
const MAX_LEVELS: usize = 32;

/// The images added so far. An image is the same image only if it is the same allocation.
pub struct Atlas<'a> {
    cache: &'a FlattenCache,
    texels: Vec<u32>,
    /// The images are borrowed so that no other can come to lie at the same address.
    places: HashMap<*const Image, (&'a Arc<Image>, u32)>,
}

impl<'a> Atlas<'a> {
    pub fn new(cache: &'a FlattenCache) -> Self {
        Atlas { cache, texels: Vec::new(), places: HashMap::new() }
    }

    /// First word of the image in the buffer; an image that was added before is stored once.
    ///
    /// # Errors
    /// [`Error::Scene`] where the image has no pixels, or fewer or more than its size says, or where all images
    /// together pass what a 32-bit index reaches.
    pub fn add(&mut self, image: &'a Arc<Image>) -> Result<u32> {
        if let Some(&(_, start)) = self.places.get(&Arc::as_ptr(image)) {
            return Ok(start);
        }
        let sizes = level_sizes(image)?;
        let words = HEADER as u64 + sizes.iter().map(|&[width, height]| 1 + width as u64 * height as u64).sum::<u64>();
        let end = self.texels.len() as u64 + words;
        if end >= u64::from(NONE) {
            return Err(Error::Scene(format!(
                "the images up to '{}', {} x {} pixels, take {end} texels with their smaller versions; \
                 at most {NONE} are possible",
                image.name, image.width, image.height
            )));
        }
        let start = self.texels.len() as u32;
        let packed = self.cache.packed(image, |image| pack(image, &sizes, words as usize));
        self.texels.extend_from_slice(&packed);
        self.places.insert(Arc::as_ptr(image), (image, start));
        Ok(start)
    }

    pub fn into_texels(self) -> Vec<u32> {
        self.texels
    }
}

/// The image in the buffer's format, which says nothing of where in the buffer it stands.
fn pack(image: &Image, sizes: &[[usize; 2]], words: usize) -> Vec<u32> {
    let mut packed = Vec::with_capacity(words);
    let format = match &image.texels {
        Texels::Rgba8(_) => TEXELS_RGBA8,
        Texels::Rgb32F(_) => TEXELS_RGB9E5,
    };
    packed.extend([image.width, image.height, sizes.len() as u32, format]);
    let mut offset = HEADER + sizes.len();
    for [width, height] in sizes {
        packed.push(offset as u32);
        offset += width * height;
    }
    match &image.texels {
        Texels::Rgba8(texels) => push_levels(&mut packed, sizes, texels, |t| t.map(f32::from), pack_rgba8),
        Texels::Rgb32F(texels) => push_levels(&mut packed, sizes, texels, representable, pack_rgb9e5),
    }
    packed
}

fn push_levels<T: Copy + Sync>(
    packed: &mut Vec<u32>,
    sizes: &[[usize; 2]],
    texels: &[T],
    value: impl Fn(T) -> [f32; 4] + Sync,
    pack: impl Fn([f32; 4]) -> u32 + Sync + Copy,
) {
    packed.par_extend(texels.par_iter().map(|&texel| pack(value(texel))));
    // Each level is averaged from the one before, which is not rounded to the packed format.
    let mut level: Vec<[f32; 4]> = Vec::new();
    for pair in sizes.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        level = if level.is_empty() {
            shrink(from, to, |index| value(texels[index]))
        } else {
            shrink(from, to, |index| level[index])
        };
        packed.par_extend(level.par_iter().map(|&texel| pack(texel)));
    }
}

/// Width and height of each level, down to 1 x 1.
fn level_sizes(image: &Image) -> Result<Vec<[usize; 2]>> {
    let (width, height) = (image.width as usize, image.height as usize);
    let count = match &image.texels {
        Texels::Rgba8(texels) => texels.len(),
        Texels::Rgb32F(texels) => texels.len(),
    };
    if count == 0 || width.checked_mul(height) != Some(count) {
        return Err(Error::Scene(format!(
            "the image '{}' has {count} pixels in place of {} x {}",
            image.name, image.width, image.height
        )));
    }
    let halves = (0..MAX_LEVELS).map(|level| [(width >> level).max(1), (height >> level).max(1)]);
    let last = width.max(height).ilog2() as usize;
    Ok(halves.take(last + 1).collect())
}

/// The image at another size, no texel larger than it was: each texel is the mean of the area that it covers. Areas
/// end at the borders of the image, so that opposite borders of a repeated image stay in step.
fn shrink(from: [usize; 2], to: [usize; 2], texel: impl Fn(usize) -> [f32; 4] + Sync) -> Vec<[f32; 4]> {
    let (columns, rows) = (coverage(from[0], to[0]), coverage(from[1], to[1]));
    let pixel = |index: usize| {
        let mut sum = [0.0; 4];
        for &(row, row_weight) in &rows[index / to[0]] {
            for &(column, column_weight) in &columns[index % to[0]] {
                let colour = texel(row * from[0] + column);
                for (total, value) in sum.iter_mut().zip(colour) {
                    *total += row_weight * column_weight * value;
                }
            }
        }
        sum
    };
    (0..to[0] * to[1]).into_par_iter().map(pixel).collect()
}

/// For each of `to` equal parts of a line of `from` texels: the texels that it covers, and their shares of it.
fn coverage(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    // In units of 1 / to texel, everything is an integer.
    let part = |index: usize| {
        let (start, end) = (index * from, (index + 1) * from);
        let share = |texel: usize| (end.min((texel + 1) * to) - start.max(texel * to)) as f32 / from as f32;
        (start / to..end.div_ceil(to)).map(|texel| (texel, share(texel))).collect()
    };
    (0..to).map(part).collect()
}

fn pack_rgba8(texel: [f32; 4]) -> u32 {
    u32::from_le_bytes(texel.map(|value| (value + 0.5) as u8))
}

/// The largest value of the format: 511 / 512 of 2^16.
const MAX_RGB9E5: f32 = 65408.0;

/// Radiance as the format can hold it: within the range, NaN as 0.
fn representable([red, green, blue]: [f32; 3]) -> [f32; 4] {
    [red, green, blue, 0.0].map(|value| if value > 0.0 { value.min(MAX_RGB9E5) } else { 0.0 })
}

/// Nine bits of each of red, green and blue under a common exponent (the OpenGL extension EXT_texture_shared_exponent);
/// off by 1/511 of the largest of them at most: half a step, which is at most 1/255 of it.
fn pack_rgb9e5([red, green, blue, _]: [f32; 4]) -> u32 {
    let largest = red.max(green).max(blue);
    // The exponent of the largest, by its bits: 2^(exponent - 15) is just above it, and at least 2^-15.
    let exponent = ((largest.to_bits() >> 23) as i32 - 127 + 16).max(0);
    let unit = |exponent: i32| f32::from_bits(((exponent - 24 + 127) as u32) << 23);
    let rounds_up = largest / unit(exponent) + 0.5 >= 512.0;
    let exponent = if rounds_up { exponent + 1 } else { exponent };
    let mantissa = |value: f32| (value / unit(exponent) + 0.5) as u32;
    mantissa(red) | mantissa(green) << 9 | mantissa(blue) << 18 | (exponent as u32) << 27
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_covered_texels_add_up() {
        for (from, to) in [(1, 1), (2, 1), (3, 1), (5, 2), (7, 3), (640, 320), (641, 320)] {
            let parts = coverage(from, to);
            let mut given = vec![0.0; from];
            for part in &parts {
                assert!((part.iter().map(|(_, share)| share).sum::<f32>() - 1.0).abs() < 1e-6);
                part.iter().for_each(|&(texel, share)| given[texel] += share);
            }
            // Every texel counts the same in the whole.
            let expected = to as f32 / from as f32;
            assert!(given.iter().all(|share| (share - expected).abs() < 1e-6), "{from} to {to}: {given:?}");
        }
    }

    #[test]
    fn shared_exponents_keep_nine_bits() {
        let unpack = |word: u32| {
            let unit = 2f32.powi((word >> 27) as i32 - 24);
            [word & 0x1ff, word >> 9 & 0x1ff, word >> 18 & 0x1ff].map(|mantissa| mantissa as f32 * unit)
        };
        for colour in
            [[0.0; 3], [1.0, 0.5, 0.25], [3.7, 0.01, 900.0], [1e-5, 2e-5, 0.0], [511.9, 511.4, 0.3], [65408.0; 3]]
        {
            let [red, green, blue] = colour;
            let back = unpack(pack_rgb9e5([red, green, blue, 0.0]));
            let largest = red.max(green).max(blue);
            // The least step is 2^-24.
            let allowed = (largest / 511.0).max(2f32.powi(-25));
            assert!(back.iter().zip(colour).all(|(b, c)| (b - c).abs() <= allowed), "{colour:?} became {back:?}");
        }
        assert_eq!(representable([f32::NAN, f32::INFINITY, -1.0]), [0.0, MAX_RGB9E5, 0.0, 0.0]);
    }
}
