//! A judge of intersections that shares nothing with them: signed distance functions in f64, searched along the ray.
//!
//! A ray that grazes a surface may be a hit or a miss by rounding alone, so hits are not compared with hits. A result
//! is judged by how far the surface would have to move to make it exactly right (its backward error): by the distance
//! between the reported point and the surface, and by how deep the ray had already passed through the surface before
//! that point (or, for a miss, on its whole way). Both are in units of `unit`, the rounding error of a coordinate.

use glam::{DVec3, Vec3};

/// A solid in object space: signed distance (negative inside) and a bounding sphere.
pub struct Solid {
    pub distance: Box<dyn Fn(DVec3) -> f64>,
    pub centre: DVec3,
    pub radius: f64,
    /// Samples along a ray that find each dip of the distance: a convex solid has one only.
    samples: usize,
}

impl Solid {
    pub fn sphere() -> Solid {
        Solid { distance: Box::new(|p| p.length() - 1.0), centre: DVec3::ZERO, radius: 1.0, samples: 10 }
    }

    pub fn cube() -> Solid {
        let distance = |p: DVec3| {
            let q = (p - DVec3::splat(0.5)).abs() - DVec3::splat(0.5);
            q.max(DVec3::ZERO).length() + q.max_element().min(0.0)
        };
        Solid { distance: Box::new(distance), centre: DVec3::splat(0.5), radius: 0.75f64.sqrt(), samples: 10 }
    }

    pub fn cylinder() -> Solid {
        let distance = |p: DVec3| {
            let (side, cap) = (p.x.hypot(p.z) - 1.0, p.y.abs() - 1.0);
            side.max(0.0).hypot(cap.max(0.0)) + side.max(cap).min(0.0)
        };
        Solid { distance: Box::new(distance), centre: DVec3::ZERO, radius: 2f64.sqrt(), samples: 10 }
    }

    pub fn cone() -> Solid {
        let distance = |p: DVec3| {
            let rho = p.x.hypot(p.z);
            // In the half plane (rho, y) the cone is a triangle: its side runs along (s, -s), its cap along y = -1.
            let s = (0.5 * (rho - p.y)).clamp(0.0, 1.0);
            let to_side = (rho - s).hypot(p.y + s);
            let to_cap = (rho - rho.min(1.0)).hypot(p.y + 1.0);
            let inside = rho + p.y < 0.0 && p.y > -1.0;
            to_side.min(to_cap) * if inside { -1.0 } else { 1.0 }
        };
        Solid { distance: Box::new(distance), centre: DVec3::new(0.0, -0.5, 0.0), radius: 1.25f64.sqrt(), samples: 10 }
    }

    pub fn torus(major: f64, minor: f64) -> Solid {
        let distance = move |p: DVec3| (p.x.hypot(p.z) - major).hypot(p.y) - minor;
        Solid { distance: Box::new(distance), centre: DVec3::ZERO, radius: major + minor, samples: 400 }
    }

    pub fn gradient(&self, p: DVec3) -> DVec3 {
        let h = 1e-6 * self.radius;
        let along = |e: DVec3| (self.distance)(p + e * h) - (self.distance)(p - e * h);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)) / (2.0 * h)
    }

    /// A point of the surface near p.
    pub fn to_surface(&self, mut p: DVec3) -> DVec3 {
        for _ in 0..8 {
            p -= self.gradient(p).normalize_or_zero() * (self.distance)(p);
        }
        p
    }

    /// Rounding error of a coordinate for a ray from `origin`: half a unit in the last place of the largest length.
    pub fn unit(&self, origin: DVec3) -> f64 {
        2f64.powi(-24) * (origin.distance(self.centre) + self.radius)
    }

    /// Backward error of the result `t` (not positive: a miss), in length, for the exact ray; see the module.
    /// None where the ray starts within `slack` of the surface, so that its side is a matter of rounding.
    pub fn backward_error(&self, origin: DVec3, direction: DVec3, t: f64, slack: f64) -> Option<f64> {
        let at_origin = (self.distance)(origin);
        if at_origin.abs() <= slack {
            return None;
        }
        let passed = |t: f64| (self.distance)(origin + direction * t) * -at_origin.signum();
        // Outside the bounding sphere there is nothing to pass through.
        let closest = (self.centre - origin).dot(direction) / direction.length_squared();
        let half2 = self.radius.powi(2) - (origin + direction * closest).distance_squared(self.centre);
        if half2 <= 0.0 {
            return Some(if t > 0.0 { passed(t).abs() } else { 0.0 });
        }
        let half = half2.sqrt() / direction.length();
        let start = (closest - half).max(0.0);
        let end = (closest + half).max(0.0);
        let depth = largest_on(&passed, start, if t > 0.0 { t.clamp(start, end) } else { end }, self.samples).max(0.0);
        Some(if t > 0.0 { depth.max(passed(t).abs()) } else { depth })
    }

    /// The exact crossing nearest to t, for a ray that is not tangent there.
    pub fn crossing_near(&self, origin: DVec3, direction: DVec3, mut t: f64) -> f64 {
        for _ in 0..4 {
            let p = origin + direction * t;
            t -= (self.distance)(p) / self.gradient(p).dot(direction);
        }
        t
    }
}

/// Largest value of f on [start, end]: samples, then golden sections about each local maximum that could be it.
fn largest_on(f: &dyn Fn(f64) -> f64, start: f64, end: f64, samples: usize) -> f64 {
    let step = (end - start) / samples as f64;
    let values: Vec<f64> = (0..=samples).map(|i| f(start + step * i as f64)).collect();
    let mut largest = values[0].max(values[samples]);
    for i in 0..=samples {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(samples));
        if values[i] >= values[before] && values[i] >= values[after] {
            largest = largest.max(golden_largest(f, start + step * before as f64, start + step * after as f64));
        }
    }
    largest
}

fn golden_largest(f: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_8;
    let (mut a, mut b) = (high - RATIO * (high - low), low + RATIO * (high - low));
    let (mut at_a, mut at_b) = (f(a), f(b));
    for _ in 0..40 {
        if at_a > at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - RATIO * (high - low);
            at_a = f(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + RATIO * (high - low);
            at_b = f(b);
        }
    }
    at_a.max(at_b)
}

pub fn exact(v: Vec3) -> DVec3 {
    v.as_dvec3()
}
