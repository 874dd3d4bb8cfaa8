// The film: sums of samples in fixed point.

const FILM_SCALE: f32 = 1048576.0;  // 2^20 units are 1
const FILM_RANGE: f32 = 2047.0;     // what fits a sample, in radiance

fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

// A sample's value in film units, with its sign. NaN and infinity count as black and are reported.
fn film_units(value: f32) -> i32 {
    if (!is_finite(value)) {
        tally.flags |= STATUS_NOT_FINITE;
        return 0;
    }
    if (abs(value) > FILM_RANGE) {
        tally.flags |= STATUS_SATURATED;
    }
    return i32(round(clamp(value, -FILM_RANGE, FILM_RANGE) * FILM_SCALE));
}

// Adds a sample (radiance and coverage) to a pixel: 64-bit sums in two words, with the carry by hand.
fn film_add(pixel: FilmPixel, sample: vec4<f32>) -> FilmPixel {
    let units = vec4<i32>(film_units(sample.x), film_units(sample.y), film_units(sample.z), film_units(sample.w));
    let low = pixel.low + bitcast<vec4<u32>>(units);
    let carry = select(vec4<u32>(0u), vec4<u32>(1u), low < pixel.low);
    let sign = bitcast<vec4<u32>>(units >> vec4<u32>(31u));
    return FilmPixel(low, pixel.high + sign + carry);
}
