// The torus about the y axis: a tube of radius r around a circle of radius R. Where r > R it is the solid's outer
// surface (a spindle torus without the lemon inside).
//
// Along a ray, with s in units of length and rho(s) the distance from the axis,
//     g(s) = |p|^2 + R^2 - 2 R rho - r^2,   g / r^2 = (distance to the circle / r)^2 - 1,
// which is one factor of the usual quartic and keeps its digits where the quartic's coefficients do not (thin tubes,
// far origins). Its second derivative 2 - 2 R m^2 / rho^3, with m the moment of the ray about the axis, is symmetric
// about the closest approach to the axis and negative only between two inflections that are known in closed form. So
// a ray has a convex, a concave and a convex stretch, each with one extremum at most, and the nearest root has a side
// from which Newton's method goes to it without ever passing it (compare Yuksel, High-Performance Polynomial Root
// Finding for Graphics, HPG 2022, which finds such stretches from the roots of the derivative).

// Newton steps for both starting points together; a tangent ray takes the most, by halving its distance each step.
const TORUS_STEPS: u32 = 32u;

// g and half of its derivative at distance s.
fn torus_implicit(origin: vec3<f32>, unit: vec3<f32>, s: f32, radii: vec2<f32>) -> vec2<f32> {
    let x = origin.x + s * unit.x;
    let y = origin.y + s * unit.y;
    let z = origin.z + s * unit.z;
    let rho = max(sqrt(x * x + z * z), TINY);
    let e = rho - radii.x;
    return vec2<f32>(e * e + (y - radii.y) * (y + radii.y), e * ((x * unit.x + z * unit.z) / rho) + y * unit.y);
}

fn torus_intersect(origin: vec3<f32>, direction: vec3<f32>, t_max: f32, radii: vec2<f32>) -> ShapeHit {
    let major = radii.x;
    let minor = radii.y;
    let outer = major + minor;
    let d = direction;
    let length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    let u = d / length;

    // The span inside the bounding cylinder, |y| <= r and rho <= R + r, wider by the rounding error of far origins.
    let a = max(u.x * u.x + u.z * u.z, 1.0e-12);
    let inverse_a = 1.0 / a;
    let moment = origin.z * u.x - origin.x * u.z;
    let centre = -(origin.x * u.x + origin.z * u.z) * inverse_a;
    let slack = 5.0e-7 * (abs(origin.x) + abs(origin.y) + abs(origin.z) + outer);
    let bound = outer + slack;
    let discriminant = a * (bound * bound) - moment * moment;
    // Nearly parallel to the axis the slab alone is bound enough, and there is no concave stretch.
    let parallel = a < 1.0e-8;
    let half = select(sqrt(max(discriminant, 0.0)) * inverse_a, FAR, parallel);
    let inverse_y = safe_reciprocal(u.y);
    let bottom = (-(minor + slack) - origin.y) * inverse_y;
    let top = ((minor + slack) - origin.y) * inverse_y;
    let entry = max(centre - half, min(bottom, top));
    let near = max(entry, 0.0);
    let far = min(centre + half, max(bottom, top));
    if (!(near < far && (discriminant >= 0.0 || parallel))) {
        return ShapeHit(MISS, 0u);
    }

    // From here s counts from the middle of the span, where the coordinates are as small as they can be.
    let middle = 0.5 * (near + far);
    let o = origin + u * middle;
    let start = near - middle;
    let end = far - middle;
    let m = o.z * u.x - o.x * u.z;
    let m2 = m * m;
    let closest = -(o.x * u.x + o.z * u.z) * inverse_a;
    let rho = cube_root(major * m2);
    let half_concave = select(sqrt(max((rho * rho - m2 * inverse_a) * inverse_a, 0.0)), 0.0, parallel);
    let first = clamp(closest - half_concave, start, end);
    let second = clamp(closest + half_concave, start, end);

    // The root has sign * g > 0 before it and < 0 after it. Outside, roots are approached from the start of the first
    // convex stretch or from the end of the concave one; inside, from the start of the concave one or from the end of
    // the last. A start at the bounding cylinder is outside, whatever rounding says.
    let at_start = torus_implicit(o, u, start, radii);
    let at_first = torus_implicit(o, u, first, radii);
    let at_second = torus_implicit(o, u, second, radii);
    let outside = entry > 0.0 || at_start.x > 0.0;
    let sign = select(-1.0, 1.0, outside);
    let try_start = at_first.x < 0.0 || (at_start.y < 0.0 && at_first.y > 0.0);
    let try_first = at_first.x > 0.0 || at_second.x > 0.0 || (at_first.y > 0.0 && at_second.y < 0.0);
    let fallback = select(end, second, outside);
    let tries_early = select(try_first, try_start, outside);
    var s = select(fallback, select(first, start, outside), tries_early);
    var limit = select(end, select(second, first, outside), tries_early);

    // The last step leaves an error of its square, over the radius of curvature; the other term is rounding noise.
    let tolerance = 1.0e-5 * minor + 2.0e-6 * outer;
    var late = !tries_early;
    var last = 0.0;
    var missed = false;
    for (var turn = 0u; turn < TORUS_STEPS; turn++) {
        let g = torus_implicit(o, u, s, radii);
        // Past the extremum, or past the stretch: there was no root in it.
        let lost = !(sign * g.y < 0.0) || s > limit;
        missed = lost && late;
        if (missed) {
            break;
        }
        // Newton's method comes from one side; where it turns back, all that is left of g is rounding.
        let step = -0.5 * g.x / g.y;
        let turned = step * last < 0.0 && abs(g.x) <= 1.0e-6 * (minor * outer);
        s = select(select(s + step, s, turned), fallback, lost);
        last = select(step, 0.0, lost);
        limit = select(limit, end, lost);
        late = late || lost;
        if (!lost && (turned || abs(step) <= tolerance)) {
            break;
        }
    }
    let t = (middle + s) / length;
    return ShapeHit(select(MISS, t, !missed && t > 0.0 && t < t_max), 0u);
}

fn torus_project(point: vec3<f32>, face: u32, radii: vec2<f32>) -> vec3<f32> {
    let rho = max(sqrt(point.x * point.x + point.z * point.z), TINY);
    let e = rho - radii.x;
    let scale = radii.y / max(sqrt(e * e + point.y * point.y), TINY);
    let outward = (radii.x + e * scale) / rho;
    return vec3<f32>(point.x * outward, point.y * scale, point.z * outward);
}

fn torus_normal(point: vec3<f32>, face: u32, radii: vec2<f32>) -> vec3<f32> {
    let rho = max(sqrt(point.x * point.x + point.z * point.z), TINY);
    let e = rho - radii.x;
    let scale = 1.0 / max(sqrt(e * e + point.y * point.y), TINY);
    let outward = e * scale / rho;
    return vec3<f32>(point.x * outward, point.y * scale, point.z * outward);
}

// Around the axis to the right and around the tube downwards from its inner side, where the seam of v is.
fn torus_parameterise(point: vec3<f32>, face: u32, around: Revolution, radii: vec2<f32>) -> Parameterisation {
    let e = around.rho - radii.x;
    let v = 0.5 - atan2_poly(point.y, e) * 0.15915494;
    let rise = point.y * 6.2831855;
    let dpdv = vec3<f32>(around.radial.x * rise, e * -6.2831855, around.radial.z * rise);
    return Parameterisation(vec2<f32>(around.u, v), around.dpdu, dpdv);
}
