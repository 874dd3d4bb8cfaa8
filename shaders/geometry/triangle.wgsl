// Triangles: the watertight test of Woop, Benthin and Wald (JCGT 2013), normals, and the packing of normals.

// What a ray contributes to the tests: its origin, and the shear that turns its direction into the axis of its
// largest component, `axis`. The paper's exchange of axes for the winding is left out: both sides are hit.
struct TriangleRay {
    origin: vec3<f32>,
    axis: u32,
    // (x, y, z) of the paper: direction / its largest component for the two others, and 1 / the largest.
    shear: vec3<f32>,
};

// b1 and b2 weigh p1 and p2; t is MISS where there is no hit, which is_hit says without a detour over t.
struct TriangleHit {
    is_hit: bool,
    t: f32,
    b1: f32,
    b2: f32,
};

// The cyclic permutation of v that brings the coordinate `axis` to the last place.
fn axis_last(v: vec3<f32>, axis: u32) -> vec3<f32> {
    return select(select(v, v.zxy, axis == 1u), v.yzx, axis == 0u);
}

fn triangle_ray(origin: vec3<f32>, direction: vec3<f32>) -> TriangleRay {
    let size = abs(direction);
    let axis = select(select(1u, 2u, size.z > size.y), select(0u, 2u, size.z > size.x), size.x >= size.y);
    let d = axis_last(direction, axis);
    let inverse = safe_reciprocal(d.z);
    return TriangleRay(origin, axis, vec3<f32>(d.x * inverse, d.y * inverse, inverse));
}

fn triangle_intersect(ray: TriangleRay, p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>, t_max: f32) -> TriangleHit {
    let a = axis_last(p0 - ray.origin, ray.axis);
    let b = axis_last(p1 - ray.origin, ray.axis);
    let c = axis_last(p2 - ray.origin, ray.axis);
    let ax = a.x - ray.shear.x * a.z;
    let ay = a.y - ray.shear.y * a.z;
    let bx = b.x - ray.shear.x * b.z;
    let by = b.y - ray.shear.y * b.z;
    let cx = c.x - ray.shear.x * c.z;
    let cy = c.y - ray.shear.y * c.z;
    // Two triangles that share an edge see the same two products in it, subtracted one way or the other, so at most
    // one of them sees it negative. An edge of zero belongs to both: in place of the paper's recourse to double
    // precision, which decides for one of them, a ray through an edge may meet both at the same t.
    let u = cx * by - cy * bx;
    let v = ax * cy - ay * cx;
    let w = bx * ay - by * ax;
    let inside = none_positive(u, v, w) || none_positive(-u, -v, -w);
    let determinant = u + v + w;
    let inverse = 1.0 / select(determinant, 1.0, determinant == 0.0);
    let t = (u * a.z + v * b.z + w * c.z) * ray.shear.z * inverse;
    let hit = inside && determinant != 0.0 && t > 0.0 && t < t_max;
    return TriangleHit(hit, select(MISS, t, hit), v * inverse, w * inverse);
}

// Of numbers, not NaN. As integers: those of positive floats are positive, that of -0 isn't, and a maximum is one
// instruction, where one of floats takes care of NaN.
fn none_positive(u: f32, v: f32, w: f32) -> bool {
    return max(max(bitcast<i32>(u), bitcast<i32>(v)), bitcast<i32>(w)) <= 0;
}

// A unit vector from its octahedral packing (Cigolle et al., JCGT 2014): two 16-bit snorms, x in the low half.
fn decode_octahedral(packed: u32) -> vec3<f32> {
    let x = f32(bitcast<i32>(packed << 16u) >> 16u) / 32767.0;
    let y = f32(bitcast<i32>(packed) >> 16u) / 32767.0;
    let z = 1.0 - abs(x) - abs(y);
    let fold = max(-z, 0.0);
    let vx = x + select(fold, -fold, x >= 0.0);
    let vy = y + select(fold, -fold, y >= 0.0);
    return vec3<f32>(vx, vy, z) / sqrt(vx * vx + vy * vy + z * z);
}

// Unit normal of the triangle's plane, on the side from which the corners run counterclockwise. A triangle without
// area has +y.
fn triangle_geometric_normal(p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> vec3<f32> {
    let e1 = p1 - p0;
    let e2 = p2 - p0;
    // Edges are brought to size 1 first: the squares of a small triangle's area underflow.
    let size = max(max(max(abs(e1.x), abs(e1.y)), abs(e1.z)), max(max(abs(e2.x), abs(e2.y)), abs(e2.z)));
    let scale = 1.0 / max(size, TINY);
    let a = e1 * scale;
    let b = e2 * scale;
    let x = a.y * b.z - a.z * b.y;
    let y = a.z * b.x - a.x * b.z;
    let z = a.x * b.y - a.y * b.x;
    let length = sqrt(x * x + y * y + z * z);
    return select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(x, y, z) / max(length, TINY), length > 0.0);
}

// Unit normal interpolated between those of the corners (packed), b1 and b2 weighing the second and third.
fn triangle_shading_normal(n0: u32, n1: u32, n2: u32, b1: f32, b2: f32) -> vec3<f32> {
    let first = decode_octahedral(n0);
    let n = first * (1.0 - b1 - b2) + decode_octahedral(n1) * b1 + decode_octahedral(n2) * b2;
    let length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    // Opposite normals cancel: then the first corner's stands.
    return select(first, n / max(length, TINY), length > 1.0e-6);
}

// Texture coordinates of a corner: two 16-bit unorms within the rectangle (least corner, extent). The image's rows
// count downwards, OBJ's v upwards.
fn decode_uv(packed: u32, rectangle: vec4<f32>) -> vec2<f32> {
    let share = vec2<f32>(f32(packed & 0xffffu), f32(packed >> 16u)) / 65535.0;
    return vec2<f32>(share.x * rectangle.z + rectangle.x, 1.0 - (share.y * rectangle.w + rectangle.y));
}

// The direction in the plane with normal n that moves as `along` does across `axis`.
fn tangent_over(along: vec3<f32>, axis: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    let slope = (n.x * along.x + n.y * along.y + n.z * along.z) / (n.x * axis.x + n.y * axis.y + n.z * axis.z);
    return along - axis * slope;
}

// Coordinates of the mesh's own where it has any (a rectangle with an extent), b1 and b2 weighing the second and third
// corner. Otherwise one image a unit square, projected along the largest axis of the normal and upright as seen from
// outside, as on the faces of the cube; those are also the tangents where a triangle has no area in the image.
fn triangle_parameterise(
    p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>, uv0: u32, uv1: u32, uv2: u32, b1: f32, b2: f32, rectangle: vec4<f32>,
) -> Parameterisation {
    let own = rectangle.z != 0.0 || rectangle.w != 0.0;
    let first = decode_uv(uv0, rectangle);
    let d1 = decode_uv(uv1, rectangle) - first;
    let d2 = decode_uv(uv2, rectangle) - first;
    let determinant = d1.x * d2.y - d1.y * d2.x;
    let has_area = own && abs(determinant) > TINY;
    let inverse = 1.0 / select(1.0, determinant, has_area);
    let e1 = p1 - p0;
    let e2 = p2 - p0;
    let own_uv = first + d1 * b1 + d2 * b2;
    if has_area {
        let dpdu = (e1 * d2.y - e2 * d1.y) * inverse;
        let dpdv = (e2 * d1.x - e1 * d2.x) * inverse;
        return Parameterisation(own_uv, dpdu, dpdv);
    }

    let n = triangle_geometric_normal(p0, p1, p2);
    let size = abs(n);
    let over_x = size.x >= size.y && size.x >= size.z;
    let over_y = !over_x && size.y >= size.z;
    let axis = vec3<f32>(select(0.0, 1.0, over_x), select(0.0, 1.0, over_y), select(1.0, 0.0, over_x || over_y));
    let outward = select(1.0, -1.0, n.x * axis.x + n.y * axis.y + n.z * axis.z < 0.0);
    let right = select(vec3<f32>(select(outward, 1.0, over_y), 0.0, 0.0), vec3<f32>(0.0, 0.0, -outward), over_x);
    let down = select(vec3<f32>(0.0, -1.0, 0.0), vec3<f32>(0.0, 0.0, outward), over_y);
    let point = p0 * (1.0 - b1 - b2) + p1 * b1 + p2 * b2;
    let across = vec2<f32>(point.x * right.x + point.z * right.z, point.y * down.y + point.z * down.z);
    return Parameterisation(
        select(across, own_uv, own), tangent_over(right, axis, n), tangent_over(down, axis, n),
    );
}
