//! The functions of math/roots, math/offset and geometry/* on the device against their CPU twins: the same inputs,
//! hard cases included, and results that agree to the last bit wherever the device divides and takes roots exactly
//! (lavapipe does). Shader compilers may still reorder a sum with a constant: the functions write those in the order
//! that compilers bring them into.

use crate::support::function_table::{
    Compare::{Bits, Floats},
    FunctionTable, Lane, Twins, floats, lane_vec3, vec3_lane,
};
use crate::support::oracle::Solid;
use crate::support::rays::{Ray, draw, ray_choice};
use glam::{Vec2, Vec3};
use gpu_trace::cpu::geometry::hit::ShapeHit;
use gpu_trace::cpu::geometry::{cone::*, cube::*, cylinder::*, plane::*, sphere::*, torus::*};

const UNBOUNDED: f32 = 3.0e38;
const ROWS: usize = 6000;

/// What the results may differ by, in ulps: nothing, since only + - * / sqrt and comparisons are used.
const SAME: u32 = 0;

/// A shape's three functions under their WGSL name; `radii` are passed on where it has them.
struct Shape<'a> {
    name: &'static str,
    solid: Solid,
    radii: Option<Vec2>,
    intersect: &'a dyn Fn(Vec3, Vec3, f32) -> ShapeHit,
    project: &'a dyn Fn(Vec3, u32) -> Vec3,
    normal: &'a dyn Fn(Vec3, u32) -> Vec3,
}

fn rays_at(solid: &Solid) -> Vec<Ray> {
    let mut rays: Vec<Ray> = draw(ray_choice(), ROWS).iter().map(|choice| choice.ray(solid)).collect();
    // Tiny and huge directions, signed zeros, and origins on the surface.
    for (i, scale) in [1e-12, 1e-6, 1e6, 1e12].into_iter().cycle().take(400).enumerate() {
        rays.push(Ray { direction: rays[i].direction * scale, ..rays[i] });
    }
    for d in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, -Vec3::ZERO + Vec3::Y] {
        for o in [Vec3::ZERO, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, Vec3::ONE] {
            for back in [0.0, 0.5, 2.0] {
                rays.push(Ray { origin: o - d * back, direction: d });
                rays.push(Ray { origin: o * -0.5 - d * back, direction: -d });
            }
        }
    }
    rays
}

impl Shape<'_> {
    fn parts(&self) -> Vec<String> {
        let shape = format!("geometry/{}.wgsl", self.name);
        let shared = ["math/elementary.wgsl", "math/roots.wgsl", "geometry/hit.wgsl", "geometry/revolution.wgsl"];
        shared.iter().map(|&part| part.to_owned()).chain([shape]).collect()
    }

    /// `last` is the lane with the radii.
    fn table(&self, last: &str, body: &str) -> FunctionTable {
        let parts = self.parts();
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        let radii = if self.radii.is_some() { ", floats_at(LAST).xy" } else { "" };
        FunctionTable::new(&parts, &body.replace("SHAPE", self.name).replace("RADII", radii).replace("LAST", last))
    }

    fn radii_lane(&self) -> Lane {
        let radii = self.radii.unwrap_or_default();
        floats([radii.x, radii.y, 0.0, 0.0])
    }

    /// Rows of (origin, t_max), (direction, -) and radii; results t, and the face as an integer.
    fn intersections(&self) -> Twins<3, 2> {
        let mut inputs = Vec::new();
        for Ray { origin, direction } in rays_at(&self.solid) {
            inputs.push([vec3_lane(origin, UNBOUNDED), vec3_lane(direction, 0.0), self.radii_lane()]);
            // Cut short at the hit, just behind it, and in front of it.
            let t = (self.intersect)(origin, direction, UNBOUNDED).t;
            if inputs.len().is_multiple_of(4) && t > 0.0 {
                for t_max in [t, t.next_up(), t * 0.5] {
                    inputs.push([vec3_lane(origin, t_max), vec3_lane(direction, 0.0), self.radii_lane()]);
                }
            }
        }
        let table = self.table(
            "2u",
            "let hit = SHAPE_intersect(vec3_at(0u), vec3_at(1u), f32_at(0u, 3u)RADII);
             results[0].x = bitcast<u32>(hit.t); results[1].x = hit.face;",
        );
        Twins::new(inputs, &table, |&[origin, direction, _]| {
            let hit = (self.intersect)(lane_vec3(origin), lane_vec3(direction), f32::from_bits(origin[3]));
            [[hit.t.to_bits(), 0, 0, 0], [hit.face, 0, 0, 0]]
        })
    }

    /// Points near the surface with the faces they were hit on: rows of (point, face) and radii.
    fn points(&self) -> Vec<[Lane; 2]> {
        let hits = rays_at(&self.solid).into_iter().filter_map(|ray| {
            let hit = (self.intersect)(ray.origin, ray.direction, UNBOUNDED);
            let point = ray.origin + ray.direction * hit.t;
            (hit.t > 0.0)
                .then(|| [[point.x.to_bits(), point.y.to_bits(), point.z.to_bits(), hit.face], self.radii_lane()])
        });
        hits.collect()
    }

    fn surfaces(&self) -> Twins<2, 2> {
        let table = self.table(
            "1u",
            "let point = SHAPE_project(vec3_at(0u), inputs[0].wRADII);
             results[0] = float_lane(vec4<f32>(point, 0.0));
             results[1] = float_lane(vec4<f32>(SHAPE_normal(point, inputs[0].wRADII), 0.0));",
        );
        Twins::new(self.points(), &table, |&[point, _]| {
            let (near, face) = (lane_vec3(point), point[3]);
            let on_surface = (self.project)(near, face);
            [vec3_lane(on_surface, 0.0), vec3_lane((self.normal)(on_surface, face), 0.0)]
        })
    }

    fn check(&self) {
        let hits = self.intersections();
        let count = hits.cpu.iter().filter(|row| f32::from_bits(row[0][0]) > 0.0).count();
        assert!(count > 500 && hits.inputs.len() - count > 500, "{} rows, {count} hits", hits.inputs.len());
        hits.assert_close(&format!("{}_intersect", self.name), [Floats, Bits], SAME);
        self.surfaces().assert_close(&format!("{}_project and _normal", self.name), [Floats, Floats], SAME);
    }
}

fn sphere() -> Shape<'static> {
    Shape {
        name: "sphere",
        solid: Solid::sphere(),
        radii: None,
        intersect: &sphere_intersect,
        project: &sphere_project,
        normal: &sphere_normal,
    }
}

#[test]
fn sphere_agrees() {
    sphere().check();
}

#[test]
fn cube_agrees() {
    Shape {
        name: "cube",
        solid: Solid::cube(),
        radii: None,
        intersect: &cube_intersect,
        project: &cube_project,
        normal: &cube_normal,
    }
    .check();
}

#[test]
fn cylinder_agrees() {
    Shape {
        name: "cylinder",
        solid: Solid::cylinder(),
        radii: None,
        intersect: &cylinder_intersect,
        project: &cylinder_project,
        normal: &cylinder_normal,
    }
    .check();
}

#[test]
fn cone_agrees() {
    Shape {
        name: "cone",
        solid: Solid::cone(),
        radii: None,
        intersect: &cone_intersect,
        project: &cone_project,
        normal: &cone_normal,
    }
    .check();
}

#[test]
fn plane_agrees() {
    Shape {
        name: "plane",
        solid: Solid::sphere(),
        radii: None,
        intersect: &plane_intersect,
        project: &plane_project,
        normal: &plane_normal,
    }
    .check();
}

#[test]
fn torus_agrees() {
    for radii in [Vec2::new(1.0, 0.01), Vec2::new(1.0, 0.5), Vec2::new(20.0, 19.8), Vec2::new(1.0, 1.3)] {
        Shape {
            name: "torus",
            solid: Solid::torus(radii.x.into(), radii.y.into()),
            radii: Some(radii),
            intersect: &|o, d, t_max| torus_intersect(o, d, t_max, radii),
            project: &|p, face| torus_project(p, face, radii),
            normal: &|p, face| torus_normal(p, face, radii),
        }
        .check();
    }
}

/// Twins that are wrong in one respect must be found out by the comparison that passes the right ones.
#[test]
fn wrong_twins_are_found_out() {
    let far_root = |o: Vec3, d: Vec3, t_max: f32| {
        let near = sphere_intersect(o, d, t_max);
        let far = sphere_intersect(o + d * near.t * 1.01, d, t_max);
        if near.t > 0.0 && far.t > 0.0 { ShapeHit { t: far.t + near.t * 1.01, face: 0 } } else { near }
    };
    let twins = Shape { intersect: &far_root, ..sphere() }.intersections();
    assert!(twins.difference([Floats, Bits]).ulps > 1000, "the far root passed");

    let last_bit = |o: Vec3, d: Vec3, t_max: f32| {
        let hit = sphere_intersect(o, d, t_max);
        ShapeHit { t: if hit.t > 0.0 { hit.t.next_up() } else { hit.t }, ..hit }
    };
    let twins = Shape { intersect: &last_bit, ..sphere() }.intersections();
    assert!(twins.difference([Floats, Bits]).ulps > SAME, "t one bit off passed");

    let twins = Shape { normal: &|p, face| -sphere_normal(p, face), ..sphere() }.surfaces();
    assert!(twins.difference([Floats, Floats]).ulps > 1000, "a flipped normal passed");

    let opposite_face = |o: Vec3, d: Vec3, t_max: f32| {
        let hit = cube_intersect(o, d, t_max);
        ShapeHit { face: hit.face ^ 1, ..hit }
    };
    let cube = Shape { name: "cube", solid: Solid::cube(), intersect: &opposite_face, ..sphere() };
    assert_eq!(cube.intersections().difference([Floats, Bits]).ulps, u32::MAX, "the opposite face passed");
}
