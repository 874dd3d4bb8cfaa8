// Elementary functions of our own, since those of drivers differ in their last bits and more (lavapipe's pow by 17 ulp).

// The vector's direction. `normalize` may multiply by a reciprocal root instead, which is another number.
fn unit_vector(v: vec3<f32>) -> vec3<f32> {
    return v / sqrt(dot(v, v));
}

// Base-2 logarithm of a positive normal number, from log2(m) = 2/ln2 artanh((m - 1) / (m + 1)) with m in
// [1/sqrt2, sqrt2); absolute error below 2e-7 beside the integer part.
fn log2_poly(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    // 0x3f3504f3 is 1/sqrt2: the exponent counts from there.
    let shifted = bits - 0x3f3504f3u;
    let exponent = bitcast<i32>(shifted) >> 23u;
    let m = bitcast<f32>((shifted & 0x007fffffu) + 0x3f3504f3u);
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    var series = 0.11111111 * q + 0.14285715;
    series = series * q + 0.2;
    series = series * q + 0.33333334;
    series = series * q;
    return f32(exponent) + 2.8853900 * (s + s * series);
}

// 2^x, 0 below -126 and 2^127 above 127; relative error below 3e-7.
fn exp2_poly(x: f32) -> f32 {
    let clamped = clamp(x, -126.0, 127.0);
    let whole = floor(clamped + 0.5);
    let t = (clamped - whole) * 0.6931472;
    var series = t * 0.00019841270 + 0.0013888889;
    series = series * t + 0.008333334;
    series = series * t + 0.041666668;
    series = series * t + 0.16666667;
    series = series * t + 0.5;
    series = series * t + 1.0;
    series = series * t + 1.0;
    // The lowest bits of floats from 2^23 on count ones: the biased exponent, without a conversion, which lavapipe
    // makes lane by lane.
    let scale = bitcast<f32>(bitcast<u32>(whole + (8388608.0 + 127.0)) << 23u);
    return select(series * scale, 0.0, x < -126.0);
}

// base^exponent for base and exponent >= 0; 0^0 is 1.
fn power(base: f32, exponent: f32) -> f32 {
    let safe = max(base, 1.1754944e-38);
    let result = exp2_poly(exponent * log2_poly(safe));
    return select(result, select(0.0, 1.0, exponent == 0.0), base < 1.1754944e-38);
}

// The angle from the x axis to (x, y), in [-pi, pi]; 0 for (0, 0). The smaller component over the larger is brought
// below tan(pi/8) by atan(t) = pi/4 + atan((t - 1) / (t + 1)); the polynomial there is a minimax fit of atan(t) / t in
// t^2, off by 2e-8 of itself. Absolute error below 3e-7.
fn atan2_poly(y: f32, x: f32) -> f32 {
    let low = min(abs(x), abs(y));
    let high = max(abs(x), abs(y));
    let ratio = low / max(high, 1.1754944e-38);
    let steep = ratio > 0.41421357;
    let t = select(ratio, (ratio - 1.0) / (ratio + 1.0), steep);
    let q = t * t;
    var series = q * 0.08060066 - 0.1387978;
    series = series * q + 0.1997792;
    series = series * q - 0.33332956;
    let arc = t + t * (series * q);
    let eighth = select(arc, arc + 0.7853982, steep);
    let quarter = select(eighth, 1.5707964 - eighth, abs(y) > abs(x));
    let half = select(quarter, 3.1415927 - quarter, x < 0.0);
    return select(half, -half, y < 0.0);
}

// Arc sine and arc cosine of x, which counts as 1 or -1 beyond them; absolute error below 4e-7.
fn asin_poly(x: f32) -> f32 {
    let sine = clamp(x, -1.0, 1.0);
    return atan2_poly(sine, sqrt((1.0 - sine) * (1.0 + sine)));
}

fn acos_poly(x: f32) -> f32 {
    let cosine = clamp(x, -1.0, 1.0);
    return atan2_poly(sqrt((1.0 - cosine) * (1.0 + cosine)), cosine);
}
