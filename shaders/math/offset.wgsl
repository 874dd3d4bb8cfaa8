// Origins of rays that leave a surface (Wächter and Binder, Ray Tracing Gems ch. 6).

// p moved off the surface along the unit vector n, which points to the side where the new ray goes: by 256 units in
// the last place of each coordinate (times n), which exceeds the rounding error of p at any scale; near the planes of
// the origin, where units in the last place shrink below that error, by 2^-16 in absolute terms. World space.
fn offset_ray_origin(p: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    let units = vec3<i32>(256.0 * n);
    let away = select(units, -units, p < vec3<f32>(0.0));
    let stepped = bitcast<vec3<f32>>(bitcast<vec3<i32>>(p) + away);
    return select(stepped, p + n * (1.0 / 65536.0), abs(p) < vec3<f32>(1.0 / 32.0));
}
