// Images in the texel buffer: bilinear, repeated, filtered by the width of the ray.
//
// An image is a header (width, height, number of levels, TEXELS_*, then the place of each level, counted from the
// header) and its levels, each half the size of the one before (rounded down, at least 1), rows from the top.
// src/flatten/atlas.rs writes them.

const TEXELS_RGBA8: u32 = 0u;          // bytes over 255, red lowest
const TEXELS_RGB9E5: u32 = 1u;         // three 9-bit mantissas, red lowest, and a common exponent in the high 5 bits
const TEXEL_HEADER: u32 = 4u;

// Width and height, texels.
fn texture_size(image: u32) -> vec2<f32> {
    return vec2<f32>(f32(texels[image]), f32(texels[image + 1u]));
}

// The image's colour about uv, averaged over a square of the edge `footprint` (in uv units): between the two levels
// whose texels are next to that wide (Williams, "Pyramidal Parametrics", SIGGRAPH 1983).
fn texture_lookup(image: u32, uv: vec2<f32>, footprint: f32) -> vec3<f32> {
    let last = texels[image + 2u] - 1u;
    let size = texture_size(image);
    let width = clamp(footprint * max(size.x, size.y), 1.0, 16777216.0);
    let level = min(log2_poly(width), f32(last));
    let finer = floor(level);
    let blend = level - finer;
    // One call site for both levels, and one for both rows in texture_level: the kernel holds several copies of this.
    let levels = select(1u, 2u, blend > 0.0);
    var colour = vec3<f32>(0.0);
    for (var i = 0u; i < levels; i++) {
        let found = texture_level(image, min(u32(finer) + i, last), uv);
        colour = select(mix_texels(colour, found, blend), found, i == 0u);
    }
    return colour;
}

// The radiance from a direction in an equirectangular picture: its middle is towards -z, its top row straight up.
fn environment_lookup(image: u32, direction: vec3<f32>) -> vec3<f32> {
    let size = texture_size(image);
    let d = direction;
    // 1/(2 pi) and 1/pi.
    let u = atan2_poly(d.x, -d.z) * 0.15915494 + 0.5;
    let v = 0.5 - atan2_poly(d.y, sqrt(d.x * d.x + d.z * d.z)) * 0.31830987;
    // Above the middle of the top row, and below that of the bottom row, there is nothing to blend with.
    let half_row = 0.5 / size.y;
    return texture_level(image, 0u, vec2<f32>(u, clamp(v, half_row, 1.0 - half_row)));
}

// Bilinear in one level, repeated.
fn texture_level(image: u32, level: u32, uv: vec2<f32>) -> vec3<f32> {
    let width = max(texels[image] >> level, 1u);
    let height = max(texels[image + 1u] >> level, 1u);
    let start = image + texels[image + TEXEL_HEADER + level];
    let rgb9e5 = texels[image + 3u] == TEXELS_RGB9E5;
    let x = (uv.x - floor(uv.x)) * f32(width) - 0.5;
    let y = (uv.y - floor(uv.y)) * f32(height) - 0.5;
    let x0 = floor(x);
    let y0 = floor(y);
    let right = texel_after(x0, width);
    let below = texel_after(y0, height);
    let left = select(right, width, right == 0u) - 1u;
    let above = select(below, height, below == 0u) - 1u;
    // An image of one row has no second to blend with.
    let rows = select(1u, 2u, height > 1u);
    var colour = vec3<f32>(0.0);
    for (var i = 0u; i < rows; i++) {
        let row = start + select(below, above, i == 0u) * width;
        let found = mix_texels(texel_colour(texels[row + left], rgb9e5), texel_colour(texels[row + right], rgb9e5), x - x0);
        colour = select(mix_texels(colour, found, y - y0), found, i == 0u);
    }
    return colour;
}

// The texel to the right of coordinate x in [-1, count], repeated. Always below count.
fn texel_after(x: f32, count: u32) -> u32 {
    let after = u32(clamp(x + 1.0, 0.0, f32(count)));
    return select(after, 0u, after >= count);
}

fn mix_texels(a: vec3<f32>, b: vec3<f32>, t: f32) -> vec3<f32> {
    return a + (b - a) * t;
}

fn texel_colour(word: u32, rgb9e5: bool) -> vec3<f32> {
    let bits = select(8u, 9u, rgb9e5);
    let mask = (1u << bits) - 1u;
    // What stands for 1: 255, or 2^(15 + 9 - exponent) by its bits.
    let one = select(255.0, bitcast<f32>((151u - (word >> 27u)) << 23u), rgb9e5);
    return vec3<f32>(f32(word & mask), f32((word >> bits) & mask), f32((word >> (2u * bits)) & mask)) / one;
}
