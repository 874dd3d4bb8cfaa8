// The unit cube [0, 1]^3. Faces: 2 * axis, and 1 more for the face at 1.

fn cube_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> ShapeHit {
    let inverse = vec3<f32>(safe_reciprocal(direction.x), safe_reciprocal(direction.y), safe_reciprocal(direction.z));
    let low = -origin * inverse;
    let high = (vec3<f32>(1.0) - origin) * inverse;
    let enters = min(low, high);
    let leaves = max(low, high);
    let near = max(max(enters.x, enters.y), enters.z);
    let far = min(min(leaves.x, leaves.y), leaves.z);
    let outside = near > 0.0;
    let t = select(far, near, outside);
    let hit = near <= far && t > 0.0 && t < t_max;
    let met = select(leaves, enters, outside);
    let axis = select(select(2u, 1u, met.y == t), 0u, met.x == t);
    let along = select(select(inverse.z, inverse.y, axis == 1u), inverse.x, axis == 0u);
    // Upwards along its axis a ray enters through the face at 0 and leaves through the face at 1.
    let side = select(0u, 1u, (along > 0.0) != outside);
    return ShapeHit(select(MISS, t, hit), 2u * axis + side);
}

fn cube_project(point: vec3<f32>, face: u32) -> vec3<f32> {
    let inside = clamp(point, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(inside, vec3<f32>(f32(face & 1u)), vec3<u32>(0u, 1u, 2u) == vec3<u32>(face >> 1u));
}

fn cube_normal(point: vec3<f32>, face: u32) -> vec3<f32> {
    let outward = f32(face & 1u) * 2.0 - 1.0;
    return select(vec3<f32>(0.0), vec3<f32>(outward), vec3<u32>(0u, 1u, 2u) == vec3<u32>(face >> 1u));
}

// Each face shows the whole image, upright and not mirrored as seen from outside: with +y up on the four sides, -z
// up on the top, and +z up on the bottom.
fn cube_parameterise(point: vec3<f32>, face: u32) -> Parameterisation {
    let outward = f32(face & 1u) * 2.0 - 1.0;
    let axis = face >> 1u;
    let from_middle = point - vec3<f32>(0.5);
    let right = select(
        vec3<f32>(select(outward, 1.0, axis == 1u), 0.0, 0.0),
        vec3<f32>(0.0, 0.0, -outward),
        axis == 0u,
    );
    let down = select(vec3<f32>(0.0, -1.0, 0.0), vec3<f32>(0.0, 0.0, outward), axis == 1u);
    let u = (from_middle.x * right.x + from_middle.z * right.z) + 0.5;
    let v = (from_middle.y * down.y + from_middle.z * down.z) + 0.5;
    return Parameterisation(vec2<f32>(u, v), right, down);
}
