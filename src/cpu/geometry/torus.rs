//! The torus about the y axis; twin of `shaders/geometry/torus.wgsl`, where the method is explained.

use super::hit::{MISS, Parameterisation, ShapeHit};
use super::revolution::Revolution;
use crate::cpu::math::elementary::atan2_poly;
use crate::cpu::math::roots::{FAR, TINY, cube_root, safe_reciprocal};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, TAU};

/// Newton steps for both starting points together.
pub const TORUS_STEPS: u32 = 32;

/// g and half of its derivative at distance s.
#[inline]
fn torus_implicit(origin: Vec3, unit: Vec3, s: f32, radii: Vec2) -> Vec2 {
    let x = origin.x + s * unit.x;
    let y = origin.y + s * unit.y;
    let z = origin.z + s * unit.z;
    let rho = (x * x + z * z).sqrt().max(TINY);
    let e = rho - radii.x;
    Vec2::new(e * e + (y - radii.y) * (y + radii.y), e * ((x * unit.x + z * unit.z) / rho) + y * unit.y)
}

/// Nearest hit in (0, t_max) of a ray in object space, whose direction need not be a unit vector; `radii` are (R, r),
/// from the axis to the centre of the tube and the tube's own.
pub fn torus_intersect(origin: Vec3, direction: Vec3, t_max: f32, radii: Vec2) -> ShapeHit {
    let major = radii.x;
    let minor = radii.y;
    let outer = major + minor;
    let d = direction;
    let length = (d.x * d.x + d.y * d.y + d.z * d.z).sqrt();
    let u = d / length;

    // The span inside the bounding cylinder, |y| ≤ r and rho ≤ R + r, wider by the rounding error of far origins.
    let a = (u.x * u.x + u.z * u.z).max(1.0e-12);
    let inverse_a = 1.0 / a;
    let moment = origin.z * u.x - origin.x * u.z;
    let centre = -(origin.x * u.x + origin.z * u.z) * inverse_a;
    let slack = 5.0e-7 * (origin.x.abs() + origin.y.abs() + origin.z.abs() + outer);
    let bound = outer + slack;
    let discriminant = a * (bound * bound) - moment * moment;
    // Nearly parallel to the axis the slab alone is bound enough, and there is no concave stretch.
    let parallel = a < 1.0e-8;
    let half = if parallel { FAR } else { discriminant.max(0.0).sqrt() * inverse_a };
    let inverse_y = safe_reciprocal(u.y);
    let bottom = (-(minor + slack) - origin.y) * inverse_y;
    let top = ((minor + slack) - origin.y) * inverse_y;
    let entry = (centre - half).max(bottom.min(top));
    let near = entry.max(0.0);
    let far = (centre + half).min(bottom.max(top));
    let meets = near < far && (discriminant >= 0.0 || parallel);
    if !meets {
        return ShapeHit { t: MISS, face: 0 };
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
    let half_concave = if parallel { 0.0 } else { ((rho * rho - m2 * inverse_a) * inverse_a).max(0.0).sqrt() };
    let first = (closest - half_concave).max(start).min(end);
    let second = (closest + half_concave).max(start).min(end);

    // The root has sign * g > 0 before it and < 0 after it. Outside, roots are approached from the start of the first
    // convex stretch or from the end of the concave one; inside, from the start of the concave one or from the end of
    // the last. A start at the bounding cylinder is outside, whatever rounding says.
    let at_start = torus_implicit(o, u, start, radii);
    let at_first = torus_implicit(o, u, first, radii);
    let at_second = torus_implicit(o, u, second, radii);
    let outside = entry > 0.0 || at_start.x > 0.0;
    let sign = if outside { 1.0 } else { -1.0 };
    let try_start = at_first.x < 0.0 || (at_start.y < 0.0 && at_first.y > 0.0);
    let try_first = at_first.x > 0.0 || at_second.x > 0.0 || (at_first.y > 0.0 && at_second.y < 0.0);
    let fallback = if outside { second } else { end };
    let tries_early = if outside { try_start } else { try_first };
    let (mut s, mut limit) = match (tries_early, outside) {
        (false, _) => (fallback, end),
        (true, true) => (start, first),
        (true, false) => (first, second),
    };

    // The last step leaves an error of its square, over the radius of curvature; the other term is rounding noise.
    let tolerance = 1.0e-5 * minor + 2.0e-6 * outer;
    let mut late = !tries_early;
    let mut last = 0.0;
    let mut missed = false;
    for _ in 0..TORUS_STEPS {
        let g = torus_implicit(o, u, s, radii);
        let descends = sign * g.y < 0.0;
        // Past the extremum, or past the stretch: there was no root in it.
        let lost = !descends || s > limit;
        missed = lost && late;
        if missed {
            break;
        }
        // Newton's method comes from one side; where it turns back, all that is left of g is rounding.
        let step = -0.5 * g.x / g.y;
        let turned = step * last < 0.0 && g.x.abs() <= 1.0e-6 * (minor * outer);
        if lost {
            s = fallback;
            last = 0.0;
            limit = end;
            late = true;
        } else {
            s = if turned { s } else { s + step };
            last = step;
        }
        if !lost && (turned || step.abs() <= tolerance) {
            break;
        }
    }
    let t = (middle + s) / length;
    ShapeHit { t: if !missed && t > 0.0 && t < t_max { t } else { MISS }, face: 0 }
}

/// The nearest point of the surface.
#[inline]
pub fn torus_project(point: Vec3, _face: u32, radii: Vec2) -> Vec3 {
    let rho = (point.x * point.x + point.z * point.z).sqrt().max(TINY);
    let e = rho - radii.x;
    let scale = radii.y / (e * e + point.y * point.y).sqrt().max(TINY);
    let outward = (radii.x + e * scale) / rho;
    Vec3::new(point.x * outward, point.y * scale, point.z * outward)
}

/// Unit outward normal at a point of the surface.
#[inline]
pub fn torus_normal(point: Vec3, _face: u32, radii: Vec2) -> Vec3 {
    let rho = (point.x * point.x + point.z * point.z).sqrt().max(TINY);
    let e = rho - radii.x;
    let scale = 1.0 / (e * e + point.y * point.y).sqrt().max(TINY);
    let outward = e * scale / rho;
    Vec3::new(point.x * outward, point.y * scale, point.z * outward)
}

/// Around the axis to the right and around the tube downwards from its inner side, where the seam of v is.
#[inline]
pub fn torus_parameterise(point: Vec3, _face: u32, around: Revolution, radii: Vec2) -> Parameterisation {
    let e = around.rho - radii.x;
    let v = 0.5 - atan2_poly(point.y, e) * (0.5 * FRAC_1_PI);
    let rise = point.y * TAU;
    let dpdv = Vec3::new(around.radial.x * rise, e * -TAU, around.radial.z * rise);
    Parameterisation { uv: Vec2::new(around.u, v), dpdu: around.dpdu, dpdv }
}
