//! Tight boxes around turned meshes, from how far a mesh reaches along some directions.
//!
//! The reach h(d) of a set of points, the greatest d · p, is a convex function of the direction d, and h(s d) = s h(d)
//! for s ≥ 0: a support function. Between directions whose reach is known, linear interpolation is therefore never too
//! small. The known directions make up a discrete oriented polytope (Klosowski et al., "Efficient Collision Detection
//! Using Bounding Volume Hierarchies of k-DOPs", TVCG 1998), whose box after any affine map takes six interpolations.

use super::bounds::Bounds;
use crate::layout::Triangle;
use glam::{DAffine3, DVec3};

/// The directions are the integer points of the octahedron |x| + |y| + |z| = EDGE, which divide its faces into
/// triangles: 146 of them. A ball's box is at most 3 % too large.
const EDGE: i32 = 6;
/// Cells along an edge of the table.
const WIDTH: i32 = 2 * EDGE + 1;
const CELLS: usize = (WIDTH * WIDTH) as usize;

/// Triangles, neighbours in the hierarchy, that are left out together where the box around them reaches less far than
/// what is known already.
const RUN: usize = 16;

/// How far a set of points reaches, in object space.
#[derive(Debug)]
pub struct Support {
    /// The greatest d · p of the points p, for the [`direction`] d of each cell, row by row.
    reach: Box<[f64; CELLS]>,
}

impl Support {
    /// Of the corners of some triangles, neighbours after one another; at least one.
    pub fn of(triangles: &[Triangle]) -> Support {
        let runs: Vec<(&[Triangle], Bounds)> =
            triangles.chunks(RUN).map(|run| (run, corners(run).fold(Bounds::EMPTY, Bounds::extended))).collect();
        let mut most = vec![0.0; runs.len()];
        let mut reach = Box::new([0.0; CELLS]);
        for (cell, reach) in reach.iter_mut().enumerate() {
            let d = direction(cell as i32 % WIDTH - EDGE, cell as i32 / WIDTH - EDGE);
            let reach_of =
                |run: usize| corners(runs[run].0).map(|corner| d.dot(corner)).fold(f64::NEG_INFINITY, f64::max);
            let mut farthest = 0;
            for (run, (_, bounds)) in runs.iter().enumerate() {
                most[run] = (d * bounds.min).max(d * bounds.max).element_sum();
                if most[run] > most[farthest] {
                    farthest = run;
                }
            }
            *reach = reach_of(farthest);
            for (run, most) in most.iter().enumerate() {
                if *most > *reach && run != farthest {
                    *reach = reach.max(reach_of(run));
                }
            }
        }
        Support { reach }
    }

    /// A box around the points in another space.
    pub fn bounds_in(&self, map: &DAffine3) -> Bounds {
        // A row of the map is the direction along which a coordinate of the other space grows.
        let rows = map.matrix3.transpose();
        let most = DVec3::new(self.along(rows.x_axis), self.along(rows.y_axis), self.along(rows.z_axis));
        let least = -DVec3::new(self.along(-rows.x_axis), self.along(-rows.y_axis), self.along(-rows.z_axis));
        Bounds { min: map.translation + least, max: map.translation + most }
    }

    /// No less than the reach along any vector: exact along those of the table, interpolated between the three around
    /// it otherwise.
    fn along(&self, vector: DVec3) -> f64 {
        let size = vector.abs().element_sum();
        if size == 0.0 {
            return 0.0;
        }
        let scale = f64::from(EDGE) / size;
        let (x, y) = (vector.x.abs() * scale, vector.y.abs() * scale);
        let (i, j) = ((x as i32).min(EDGE), (y as i32).min(EDGE));
        let (u, v) = (x - f64::from(i), y - f64::from(j));
        let known = |i: i32, j: i32| {
            let signed = |index: i32, component: f64| if component < 0.0 { -index } else { index };
            self.reach[cell_of(signed(i, vector.x), signed(j, vector.y), vector.z < 0.0)]
        };
        let left = EDGE - i - j;
        let reach = if left <= 0 {
            known(i, EDGE - i)
        } else if left == 1 || u + v <= 1.0 {
            (1.0 - u - v) * known(i, j) + u * known(i + 1, j) + v * known(i, j + 1)
        } else {
            (1.0 - v) * known(i + 1, j) + (1.0 - u) * known(i, j + 1) + (u + v - 1.0) * known(i + 1, j + 1)
        };
        reach / scale
    }
}

fn corners(triangles: &[Triangle]) -> impl Iterator<Item = DVec3> {
    triangles.iter().flat_map(|triangle| [triangle.p0, triangle.p1, triangle.p2].map(|corner| corner.as_dvec3()))
}

/// The direction of a cell, by its column and row from the middle: the octahedron unfolded, +z in the middle and -z in
/// the corners.
fn direction(column: i32, row: i32) -> DVec3 {
    let z = EDGE - column.abs() - row.abs();
    let (x, y) = if z < 0 { folded(column, row) } else { (column, row) };
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}

/// The cell of the direction with these first two components, of which the third is the rest.
fn cell_of(x: i32, y: i32, below: bool) -> usize {
    let (column, row) = if below { folded(x, y) } else { (x, y) };
    ((row + EDGE) * WIDTH + column + EDGE) as usize
}

/// Turns the lower half inside out, and back.
fn folded(a: i32, b: i32) -> (i32, i32) {
    let signed = |size: i32, like: i32| if like < 0 { -size } else { size };
    (signed(EDGE - b.abs(), a), signed(EDGE - a.abs(), b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, Vec3};
    use proptest::prelude::*;

    fn triangles(corners: &[Vec3]) -> Vec<Triangle> {
        let pack = |c: &[Vec3]| Triangle { p0: c[0], p1: c[1], p2: c[2], ..Triangle::default() };
        corners.chunks_exact(3).map(pack).collect()
    }

    fn exact(corners: &[Vec3], map: &DAffine3) -> Bounds {
        corners.iter().map(|corner| map.transform_point3(corner.as_dvec3())).fold(Bounds::EMPTY, Bounds::extended)
    }

    /// Points on a sphere of radius 1, evenly.
    fn ball(count: usize) -> Vec<Vec3> {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let point = |i: usize| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            (DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z).as_vec3()
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn cells_and_directions_agree() {
        for row in -EDGE..=EDGE {
            for column in -EDGE..=EDGE {
                let d = direction(column, row);
                assert_eq!(d.abs().element_sum(), f64::from(EDGE));
                let cell = cell_of(d.x as i32, d.y as i32, d.z < 0.0) as i32;
                assert_eq!(direction(cell % WIDTH - EDGE, cell / WIDTH - EDGE), d);
            }
        }
    }

    #[test]
    fn boxes_without_a_turn_are_exact() {
        let corners = ball(999);
        let support = Support::of(&triangles(&corners));
        let map = DAffine3::from_scale(DVec3::new(2.0, 3.0, -0.5));
        let (bounds, exact) = (support.bounds_in(&map), exact(&corners, &map));
        assert!((bounds.min - exact.min).abs().max_element() < 1e-12, "{bounds:?} {exact:?}");
        assert!((bounds.max - exact.max).abs().max_element() < 1e-12, "{bounds:?} {exact:?}");
    }

    #[test]
    fn the_box_of_a_turned_ball_is_at_most_3_percent_too_large() {
        let support = Support::of(&triangles(&ball(30_000)));
        let worst = ball(2_000).iter().map(|axis| support.along(axis.as_dvec3())).fold(0.0, f64::max);
        assert!((1.01..1.03).contains(&worst), "{worst}");
    }

    proptest! {
        #[test]
        fn boxes_hold_all_corners_however_turned(
            corners in prop::collection::vec(prop::array::uniform3(-10f32..10.0), 3..200),
            matrix in prop::array::uniform9(prop_oneof![Just(0.0), Just(1.0), -2f64..2.0]),
            translation in prop::array::uniform3(-100f64..100.0),
        ) {
            let corners: Vec<Vec3> = corners.into_iter().map(Vec3::from_array).collect();
            let corners = &corners[..corners.len() / 3 * 3];
            let map = DAffine3 {
                matrix3: DMat3::from_cols_array(&matrix),
                translation: DVec3::from_array(translation),
            };
            let (bounds, exact) = (Support::of(&triangles(corners)).bounds_in(&map), exact(corners, &map));
            let slack = 1e-12 * (exact.min.abs().max(exact.max.abs()).max_element() + 100.0);
            prop_assert!((bounds.min - slack).cmple(exact.min).all(), "{bounds:?} {exact:?}");
            prop_assert!((bounds.max + slack).cmpge(exact.max).all(), "{bounds:?} {exact:?}");
            // Nor are they much too large, beside the corners' distance from the origin.
            let radius = corners.iter().map(|corner| corner.as_dvec3().length()).fold(0.0, f64::max);
            let rows = map.matrix3.transpose();
            let most = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| 0.35 * radius * row.length() + slack);
            let over = (bounds.max - exact.max).max(exact.min - bounds.min);
            prop_assert!(over.cmple(DVec3::from_array(most)).all(), "{bounds:?} {exact:?}");
        }
    }
}
