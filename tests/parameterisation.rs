//! Texture coordinates and tangents: the twins against each other, and both against the inverse maps (from texture
//! coordinates to points) in double precision, whose finite differences are the tangents.

use crate::support::function_table::{Compare::Floats, FunctionTable, Lane, Twins, floats, lane_vec3, vec3_lane};
use crate::support::kernel::evaluate;
use crate::support::placed::*;
use crate::support::rays::{draw, placement};
use glam::{DAffine3, DMat2, DVec2, DVec3, Vec2, Vec3};
use gpu_trace::cpu::geometry;
use gpu_trace::cpu::geometry::bvh::scene_intersect;
use gpu_trace::cpu::geometry::hit::{Hit, Parameterisation};
use gpu_trace::cpu::geometry::instance::surface_at;
use gpu_trace::cpu::geometry::parameterisation::parameterise_at;
use gpu_trace::cpu::geometry::revolution::revolution;
use gpu_trace::cpu::geometry::{cone::*, cube::*, cylinder::*, plane::*, sphere::*, torus::*, triangle::*};
use gpu_trace::cpu::math::elementary::{acos_poly, asin_poly, atan2_poly};
use gpu_trace::renderer::Tally;
use gpu_trace::scene::{Mesh, Shape};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const SAME: u32 = 0;
const TORUS: Vec2 = Vec2::new(1.0, 0.4);

fn sphere_parameterise(point: Vec3, face: u32) -> Parameterisation {
    geometry::sphere::sphere_parameterise(point, face, revolution(point))
}

fn cylinder_parameterise(point: Vec3, face: u32) -> Parameterisation {
    geometry::cylinder::cylinder_parameterise(point, face, revolution(point))
}

fn cone_parameterise(point: Vec3, face: u32) -> Parameterisation {
    geometry::cone::cone_parameterise(point, face, revolution(point))
}

fn torus_parameterise(point: Vec3, face: u32, radii: Vec2) -> Parameterisation {
    geometry::torus::torus_parameterise(point, face, revolution(point), radii)
}

/// A face of a shape in object space: the point at (u, v), and what the renderer makes of that point.
struct Face {
    shape: &'static str,
    face: u32,
    point: fn(f64, f64) -> DVec3,
    parameterise: fn(Vec3, u32) -> Parameterisation,
    normal: fn(Vec3, u32) -> Vec3,
}

fn around(u: f64) -> (f64, f64) {
    let phi = TAU * (0.5 - u);
    (phi.cos(), phi.sin())
}

fn sphere_point(u: f64, v: f64) -> DVec3 {
    let ((x, z), theta) = (around(u), PI * (0.5 - v));
    DVec3::new(theta.cos() * x, theta.sin(), theta.cos() * z)
}

fn torus_point(u: f64, v: f64) -> DVec3 {
    let ((x, z), psi) = (around(u), TAU * (0.5 - v));
    let rho = f64::from(TORUS.x) + f64::from(TORUS.y) * psi.cos();
    DVec3::new(rho * x, f64::from(TORUS.y) * psi.sin(), rho * z)
}

fn faces() -> Vec<Face> {
    let cube = |face, point| Face { shape: "cube", face, point, parameterise: cube_parameterise, normal: cube_normal };
    let cylinder = |face, point| Face {
        shape: "cylinder",
        face,
        point,
        parameterise: cylinder_parameterise,
        normal: cylinder_normal,
    };
    let cone = |face, point| Face { shape: "cone", face, point, parameterise: cone_parameterise, normal: cone_normal };
    let torus = |point, face| torus_parameterise(point, face, TORUS);
    vec![
        Face {
            shape: "sphere",
            face: 0,
            point: sphere_point,
            parameterise: sphere_parameterise,
            normal: sphere_normal,
        },
        Face {
            shape: "torus",
            face: 0,
            point: torus_point,
            parameterise: torus,
            normal: |p, face| torus_normal(p, face, TORUS),
        },
        Face {
            shape: "plane",
            face: 0,
            point: |u, v| DVec3::new(u, 0.0, v),
            parameterise: plane_parameterise,
            normal: plane_normal,
        },
        cylinder(CYLINDER_SIDE, |u, v| DVec3::new(around(u).0, 1.0 - 2.0 * v, around(u).1)),
        cylinder(CYLINDER_TOP, |u, v| DVec3::new(2.0 * u - 1.0, 1.0, 2.0 * v - 1.0)),
        cylinder(CYLINDER_BOTTOM, |u, v| DVec3::new(2.0 * u - 1.0, -1.0, 1.0 - 2.0 * v)),
        cone(CONE_SIDE, |u, v| DVec3::new(v * around(u).0, -v, v * around(u).1)),
        cone(CONE_CAP, |u, v| DVec3::new(2.0 * u - 1.0, -1.0, 1.0 - 2.0 * v)),
        cube(0, |u, v| DVec3::new(0.0, 1.0 - v, u)),
        cube(1, |u, v| DVec3::new(1.0, 1.0 - v, 1.0 - u)),
        cube(2, |u, v| DVec3::new(u, 0.0, 1.0 - v)),
        cube(3, |u, v| DVec3::new(u, 1.0, v)),
        cube(4, |u, v| DVec3::new(1.0 - u, 1.0 - v, 0.0)),
        cube(5, |u, v| DVec3::new(u, 1.0 - v, 1.0)),
    ]
}

/// Texture coordinates that keep away from poles, apexes and seams, and are of use on every face.
fn coordinates() -> Vec<(f64, f64)> {
    draw((0.01..0.99f64, 0.02..0.98f64), 2000)
}

/// Derivatives of a map by central differences: with f64 they are good to 1e-9.
fn tangents(point: impl Fn(f64, f64) -> DVec3, u: f64, v: f64) -> (DVec3, DVec3) {
    let h = 1e-6;
    ((point(u + h, v) - point(u - h, v)) / (2.0 * h), (point(u, v + h) - point(u, v - h)) / (2.0 * h))
}

/// Largest errors of the coordinates, and of the tangents as shares of their lengths.
fn worst_errors(face: &Face, parameterise: impl Fn(Vec3, u32) -> Parameterisation) -> (f64, f64) {
    let mut worst = (0.0f64, 0.0f64);
    for (u, v) in coordinates() {
        let found = parameterise((face.point)(u, v).as_vec3(), face.face);
        worst.0 = worst.0.max((found.uv.as_dvec2() - DVec2::new(u, v)).abs().max_element());
        let (dpdu, dpdv) = tangents(face.point, u, v);
        worst.1 = worst.1.max((found.dpdu.as_dvec3() - dpdu).length() / dpdu.length());
        worst.1 = worst.1.max((found.dpdv.as_dvec3() - dpdv).length() / dpdv.length());
    }
    worst
}

/// What rounding the points to single precision leaves, close to the poles and to the apex.
const UV_LIMIT: f64 = 1e-6;
const TANGENT_LIMIT: f64 = 5e-6;

#[test]
fn coordinates_and_tangents_are_those_of_the_inverse_map() {
    for face in faces() {
        let (uv, tangent) = worst_errors(&face, face.parameterise);
        println!("{} face {}: uv {uv:.1e}, tangents {tangent:.1e}", face.shape, face.face);
        assert!(uv < UV_LIMIT && tangent < TANGENT_LIMIT, "{} face {}: {uv} {tangent}", face.shape, face.face);
    }
}

#[test]
fn mirrored_and_exchanged_coordinates_are_rejected() {
    for face in faces() {
        let mirrored = |p, f| {
            let Parameterisation { uv, dpdu, dpdv } = (face.parameterise)(p, f);
            Parameterisation { uv: Vec2::new(1.0 - uv.x, uv.y), dpdu: -dpdu, dpdv }
        };
        let exchanged = |p, f| {
            let Parameterisation { uv, dpdu, dpdv } = (face.parameterise)(p, f);
            Parameterisation { uv, dpdu: dpdv, dpdv: dpdu }
        };
        let scaled = |p, f| {
            let Parameterisation { uv, dpdu, dpdv } = (face.parameterise)(p, f);
            Parameterisation { uv, dpdu: dpdu * 1.001, dpdv }
        };
        let (uv, tangent) = worst_errors(&face, mirrored);
        assert!(uv > UV_LIMIT && tangent > TANGENT_LIMIT, "{}: a mirrored image passed", face.shape);
        assert!(worst_errors(&face, exchanged).1 > TANGENT_LIMIT, "{}: exchanged tangents passed", face.shape);
        assert!(worst_errors(&face, scaled).1 > TANGENT_LIMIT, "{}: tangents off by 0.1 % passed", face.shape);
    }
}

/// Upright and not mirrored as seen from outside: u to the right and v downwards leave the third axis inwards.
#[test]
fn frames_are_tangent_and_not_mirrored() {
    for face in faces() {
        for (u, v) in coordinates() {
            let point = (face.point)(u, v).as_vec3();
            let n = (face.normal)(point, face.face);
            let Parameterisation { dpdu, dpdv, .. } = (face.parameterise)(point, face.face);
            let (du, dv) = (dpdu.normalize(), dpdv.normalize());
            assert!(du.dot(n).abs() < 1e-5 && dv.dot(n).abs() < 1e-5, "{} {}: not tangent", face.shape, face.face);
            assert!(du.dot(dv).abs() < 1e-5, "{} {}: not orthogonal", face.shape, face.face);
            assert!(du.cross(dv).dot(n) < -0.999, "{} {}: mirrored", face.shape, face.face);
        }
    }
}

#[test]
fn named_points_have_the_documented_coordinates() {
    let near = |found: Parameterisation, u: f32, v: f32| (found.uv - Vec2::new(u, v)).abs().max_element() < 1e-6;
    let sphere = |p| sphere_parameterise(p, 0);
    assert!(near(sphere(Vec3::X), 0.5, 0.5));
    assert!(near(sphere(Vec3::NEG_Z), 0.75, 0.5), "from +x towards -z is to the right");
    assert!(near(sphere(Vec3::Z), 0.25, 0.5));
    assert!(near(sphere(Vec3::Y), 0.5, 0.0), "the north pole is in the top row");
    assert!(near(sphere(Vec3::NEG_Y), 0.5, 1.0));
    // The seam, from either side.
    assert!(near(sphere(Vec3::NEG_X), 0.0, 0.5));
    assert!(near(sphere(Vec3::new(-1.0, 0.0, -1e-7)), 1.0, 0.5));
    assert!(near(cylinder_parameterise(Vec3::new(1.0, 1.0, 0.0), CYLINDER_SIDE), 0.5, 0.0));
    assert!(near(cylinder_parameterise(Vec3::new(0.0, -1.0, -1.0), CYLINDER_SIDE), 0.75, 1.0));
    assert!(near(cylinder_parameterise(Vec3::new(-1.0, 1.0, 0.0), CYLINDER_TOP), 0.0, 0.5));
    assert!(near(cylinder_parameterise(Vec3::new(0.0, 1.0, -1.0), CYLINDER_TOP), 0.5, 0.0));
    assert!(near(cylinder_parameterise(Vec3::new(0.0, -1.0, 1.0), CYLINDER_BOTTOM), 0.5, 0.0));
    assert!(near(cone_parameterise(Vec3::ZERO, CONE_SIDE), 0.5, 0.0), "the apex is in the top row");
    assert!(near(cone_parameterise(Vec3::new(0.0, -1.0, 1.0), CONE_SIDE), 0.25, 1.0));
    assert!(near(torus_parameterise(Vec3::new(1.5, 0.0, 0.0), 0, Vec2::new(1.0, 0.5)), 0.5, 0.5));
    assert!(near(torus_parameterise(Vec3::new(1.0, 0.5, 0.0), 0, Vec2::new(1.0, 0.5)), 0.5, 0.25));
    assert!(near(plane_parameterise(Vec3::new(3.25, 0.0, -7.5), 0), 3.25, -7.5));
    assert!(near(cube_parameterise(Vec3::new(1.0, 1.0, 1.0), 1), 0.0, 0.0));
    assert!(near(cube_parameterise(Vec3::new(0.0, 1.0, 1.0), 5), 0.0, 0.0));
}

/// Once around, u grows steadily but for one seam, at -x; so does v around the tube, with its seam inside.
#[test]
fn there_is_one_seam() {
    let steps = 3600;
    let circle = |i: i32| {
        let angle = f64::from(i) / f64::from(steps) * TAU + 1e-3;
        (angle.cos() as f32, angle.sin() as f32)
    };
    let seams = |coordinate: &dyn Fn(f32, f32) -> f32| {
        let jumps = (0..steps).filter(|&i| {
            let (here, next) = (circle(i), circle(i + 1));
            (coordinate(here.0, here.1) - coordinate(next.0, next.1)).abs() > 2.0 / steps as f32
        });
        jumps.map(|i| circle(i).0).collect::<Vec<_>>()
    };
    let at_the_far_side = |found: Vec<f32>| found.len() == 1 && found[0] < -0.999;
    assert!(at_the_far_side(seams(&|x, z| sphere_parameterise(Vec3::new(x, 0.0, z), 0).uv.x)));
    assert!(at_the_far_side(seams(&|x, z| cylinder_parameterise(Vec3::new(x, 0.3, z), 0).uv.x)));
    assert!(at_the_far_side(seams(&|x, z| cone_parameterise(Vec3::new(0.5 * x, -0.5, 0.5 * z), 0).uv.x)));
    assert!(at_the_far_side(seams(&|x, z| torus_parameterise(Vec3::new(1.4 * x, 0.0, 1.4 * z), 0, TORUS).uv.x)));
    let tube = |x, y| torus_parameterise(Vec3::new(1.0 + 0.4 * x, 0.4 * y, 0.0), 0, TORUS).uv.y;
    assert!(at_the_far_side(seams(&tube)));
}

#[test]
fn frames_are_finite_at_poles_and_apexes() {
    let check = |name: &str, found: Parameterisation, n: Vec3| {
        let Parameterisation { uv, dpdu, dpdv } = found;
        assert!(uv.is_finite() && dpdu.is_finite() && dpdv.is_finite(), "{name}: {found:?}");
        let (du, dv) = (dpdu.normalize(), dpdv.normalize());
        assert!(du.is_finite() && dv.is_finite(), "{name}: a tangent of no length in {found:?}");
        assert!(du.dot(dv).abs() < 1e-5 && du.dot(n).abs() < 1e-5, "{name}: {found:?} {n}");
    };
    for tilt in [0.0f32, 1e-30, 1e-12, 1e-7, 1e-5] {
        for y in [1.0f32, -1.0] {
            let point = Vec3::new(tilt, y, -tilt);
            check("pole", sphere_parameterise(point, 0), sphere_normal(point, 0));
        }
        let point = Vec3::new(tilt, -tilt, 0.0);
        check("apex", cone_parameterise(point, CONE_SIDE), Vec3::new(1.0, 1.0, 0.0).normalize());
        check("cap", cylinder_parameterise(Vec3::new(tilt, 1.0, tilt), CYLINDER_TOP), Vec3::Y);
        let point = Vec3::new(tilt, 0.75f32.sqrt(), 0.0);
        let radii = Vec2::new(0.5, 1.0);
        check("spindle", torus_parameterise(point, 0, radii), torus_normal(point, 0, radii));
    }
}

fn lanes(found: Parameterisation) -> [Lane; 3] {
    [floats([found.uv.x, found.uv.y, 0.0, 0.0]), vec3_lane(found.dpdu, 0.0), vec3_lane(found.dpdv, 0.0)]
}

fn face_twins(face: &Face, cpu: impl Fn(Vec3, u32) -> Parameterisation) -> Twins<2, 3> {
    let mut points: Vec<Vec3> = coordinates().iter().map(|&(u, v)| (face.point)(u, v).as_vec3()).collect();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO] {
        for sign in [1.0, -1.0] {
            for nudge in [Vec3::ZERO, Vec3::new(0.0, 0.0, -0.0), Vec3::splat(1e-7), Vec3::splat(-1e-25)] {
                points.push(axis * sign + nudge);
            }
        }
    }
    let radii = floats([TORUS.x, TORUS.y, 0.0, 0.0]);
    let inputs = points.iter().map(|p| [[p.x.to_bits(), p.y.to_bits(), p.z.to_bits(), face.face], radii]).collect();
    let extra = match face.shape {
        "torus" => ", revolution(vec3_at(0u)), floats_at(1u).xy",
        "sphere" | "cylinder" | "cone" => ", revolution(vec3_at(0u))",
        _ => "",
    };
    let body = format!(
        "let found = {}_parameterise(vec3_at(0u), inputs[0].w{extra});
         results[0] = float_lane(vec4<f32>(found.uv, 0.0, 0.0));
         results[1] = float_lane(vec4<f32>(found.dpdu, 0.0));
         results[2] = float_lane(vec4<f32>(found.dpdv, 0.0));",
        face.shape
    );
    let shape = format!("geometry/{}.wgsl", face.shape);
    let parts = ["math/elementary.wgsl", "math/roots.wgsl", "geometry/hit.wgsl", "geometry/revolution.wgsl", &shape];
    Twins::new(inputs, &FunctionTable::new(&parts, &body), |row| lanes(cpu(lane_vec3(row[0]), row[0][3])))
}

#[test]
fn twins_agree() {
    for face in faces() {
        let twins = face_twins(&face, face.parameterise);
        twins.assert_close(&format!("{}_parameterise, face {}", face.shape, face.face), [Floats; 3], SAME);
    }
    let sphere = &faces()[0];
    let shifted = |p, face| {
        let found = sphere_parameterise(p, face);
        Parameterisation { uv: Vec2::new(found.uv.x.next_up(), found.uv.y), ..found }
    };
    assert!(face_twins(sphere, shifted).difference([Floats; 3]).ulps > SAME, "u one bit off passed");
}

/// Rows of three corners with packed coordinates, weights, and the rectangle.
fn triangle_rows() -> Vec<[Lane; 5]> {
    let corner = || (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    let rectangle = (-2.0..2.0f32, -2.0..2.0f32, 0.1..4.0f32, 0.1..4.0f32, 0..3u32);
    let choice = (corner(), corner(), corner(), placement(), any::<[u32; 3]>(), (0.0..0.5f32, 0.0..0.5f32), rectangle);
    draw(choice, 3000)
        .into_iter()
        .map(|(p0, p1, p2, place, uvs, (b1, b2), (x, y, width, height, kind))| {
            let [a, b, c] = [p0, p1, p2].map(|p| place.transform_point3(p).as_vec3().to_array().map(f32::to_bits));
            // A third of the meshes have no coordinates; some triangles have no area in the image.
            let [width, height] = if kind == 0 { [0.0; 2] } else { [width, height] };
            let last = if kind == 1 && uvs[0].is_multiple_of(3) { uvs[1] } else { uvs[2] };
            [
                [a[0], a[1], a[2], uvs[0]],
                [b[0], b[1], b[2], uvs[1]],
                [c[0], c[1], c[2], last],
                floats([b1, b2, 0.0, 0.0]),
                floats([x, y, width, height]),
            ]
        })
        .collect()
}

fn cpu_triangle(row: &[Lane; 5]) -> Parameterisation {
    let [b1, b2, _, _] = row[3].map(f32::from_bits);
    let corners = [lane_vec3(row[0]), lane_vec3(row[1]), lane_vec3(row[2])];
    let rectangle = glam::Vec4::from_array(row[4].map(f32::from_bits));
    triangle_parameterise(corners, [row[0][3], row[1][3], row[2][3]], b1, b2, rectangle)
}

#[test]
fn triangles_agree_and_their_tangents_are_those_of_the_affine_map() {
    let body = "let b = floats_at(3u);
         let found = triangle_parameterise(vec3_at(0u), vec3_at(1u), vec3_at(2u), inputs[0].w, inputs[1].w,
             inputs[2].w, b.x, b.y, floats_at(4u));
         results[0] = float_lane(vec4<f32>(found.uv, 0.0, 0.0));
         results[1] = float_lane(vec4<f32>(found.dpdu, 0.0));
         results[2] = float_lane(vec4<f32>(found.dpdv, 0.0));";
    let parts = ["math/roots.wgsl", "geometry/hit.wgsl", "geometry/triangle.wgsl"];
    let rows = triangle_rows();
    let twins = Twins::new(rows, &FunctionTable::new(&parts, body), |row| lanes(cpu_triangle(row)));
    twins.assert_close("triangle_parameterise", [Floats; 3], SAME);

    let mut worst = 0.0f64;
    let mut checked = 0;
    for row in &twins.inputs {
        let rectangle = row[4].map(|word| f64::from(f32::from_bits(word)));
        let uv = |packed: u32| {
            let share = DVec2::new(f64::from(packed & 0xffff), f64::from(packed >> 16)) / 65535.0;
            DVec2::new(rectangle[0] + share.x * rectangle[2], 1.0 - rectangle[1] - share.y * rectangle[3])
        };
        let [uv0, uv1, uv2] = [row[0][3], row[1][3], row[2][3]].map(uv);
        let map = DMat2::from_cols(uv1 - uv0, uv2 - uv0);
        if rectangle[2] == 0.0 || map.determinant().abs() < 0.3 {
            continue;
        }
        checked += 1;
        let [p0, p1, p2] = [row[0], row[1], row[2]].map(|lane| lane_vec3(lane).as_dvec3());
        let point = |uv: DVec2| {
            let weights = map.inverse() * (uv - uv0);
            p0 + (p1 - p0) * weights.x + (p2 - p0) * weights.y
        };
        let found = cpu_triangle(row);
        let here = found.uv.as_dvec2();
        let (dpdu, dpdv) = (point(here + DVec2::X) - point(here), point(here + DVec2::Y) - point(here));
        worst = worst.max((found.dpdu.as_dvec3() - dpdu).length() / (p1 - p0).length().max((p2 - p0).length()));
        worst = worst.max((found.dpdv.as_dvec3() - dpdv).length() / (p1 - p0).length().max((p2 - p0).length()));
        let [b1, b2, _, _] = row[3].map(|word| f64::from(f32::from_bits(word)));
        assert!((map * DVec2::new(b1, b2) + uv0 - here).abs().max_element() < 5e-6);
    }
    println!("{checked} triangles, tangents off by {worst:.1e} of their size at most");
    assert!(checked > 500 && worst < 1e-4, "{checked} {worst}");
}

/// Without coordinates of its own, a triangle shows the image upright along the largest axis of its normal.
#[test]
fn planar_coordinates_stand_upright() {
    let sides = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    for normal in sides {
        let up = if normal.y == 0.0 { DVec3::Y } else { DVec3::Z * -normal.y };
        let right = up.cross(normal);
        // Tilted by half a right angle at most, so that the axis stays the largest.
        let tilted = (normal + 0.4 * right + 0.3 * up).normalize();
        for n in [normal, tilted] {
            let (a, b) = n.any_orthonormal_pair();
            let corners = [DVec3::ZERO, a, b].map(|p| (p + normal * 2.0).as_vec3());
            let found = triangle_parameterise(corners, [0; 3], 0.25, 0.5, glam::Vec4::ZERO);
            let point = normal * 2.0 + a * 0.25 + b * 0.5;
            let expected = DVec2::new(point.dot(right), -point.dot(up));
            assert!((found.uv.as_dvec2() - expected).length() < 1e-6, "{n}: {} for {expected}", found.uv);
            // Along u the point moves by 1 to the right and not up, wherever the plane leads it otherwise.
            let (dpdu, dpdv) = (found.dpdu.as_dvec3(), found.dpdv.as_dvec3());
            assert!((dpdu.dot(right) - 1.0).abs() < 1e-6 && dpdu.dot(up).abs() < 1e-6 && dpdu.dot(n).abs() < 1e-6);
            assert!((dpdv.dot(up) + 1.0).abs() < 1e-6 && dpdv.dot(right).abs() < 1e-6 && dpdv.dot(n).abs() < 1e-6);
        }
    }
}

#[test]
fn inverse_trigonometry_agrees() {
    let mut inputs: Vec<[Lane; 1]> = draw((-1.5..1.5f32, -1e3..1e3f32, -8.0..8.0f64), 20_000)
        .into_iter()
        .map(|(y, x, power)| [floats([y, x * 10f64.powf(power) as f32, y / 1.5, 0.0])])
        .collect();
    for y in [0.0f32, -0.0, 1.0, -1.0, 0.414_213_57, 1e-30, f32::MAX, 2.0] {
        for x in [0.0f32, -0.0, 1.0, -1.0, 1e30, -1e-38] {
            inputs.push([floats([y, x, y, 0.0])]);
        }
    }
    let body = "let x = floats_at(0u);
         results[0] = float_lane(vec4<f32>(atan2_poly(x.x, x.y), asin_poly(x.z), acos_poly(x.z), 0.0));";
    let cpu = |row: &[Lane; 1]| {
        let [y, x, z, _] = row[0].map(f32::from_bits);
        [floats([atan2_poly(y, x), asin_poly(z), acos_poly(z), 0.0])]
    };
    let twins = Twins::new(inputs, &FunctionTable::new(&["math/elementary.wgsl"], body), cpu);
    twins.assert_close("atan2_poly, asin_poly, acos_poly", [Floats], SAME);

    let mut worst = [0.0f64; 3];
    for (row, results) in twins.inputs.iter().zip(&twins.gpu) {
        let [y, x, z, _] = row[0].map(|word| f64::from(f32::from_bits(word)));
        let found = results[0].map(|word| f64::from(f32::from_bits(word)));
        // A zero counts as positive, so that there is one angle for it.
        let (y, x, z) = (y + 0.0, x + 0.0, z.clamp(-1.0, 1.0));
        let expected = [y.atan2(x), z.asin(), z.acos()];
        (0..3).for_each(|i| worst[i] = worst[i].max((found[i] - expected[i]).abs()));
    }
    println!("absolute errors of atan2, asin, acos: {worst:?}");
    assert!(worst[0] < 3e-7 && worst[1] < 4e-7 && worst[2] < 4e-7, "{worst:?}");
}

/// A ball with texture coordinates of its own, an affine map of the points.
fn mesh_with_coordinates() -> Mesh {
    let mut mesh = bumpy_ball(8);
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(p.x * 0.5 + p.z, p.y * 0.7 - 0.2 * p.x)).collect();
    mesh
}

const AT_HIT: &str = "
    tally = Tally(0u, vec4<u32>(0u));
    let origin = vec3<f32>(number(0u), number(1u), number(2u));
    let direction = vec3<f32>(number(3u), number(4u), number(5u));
    let hit = Hit(number(6u), word(7u), word(8u), number(9u), number(10u));
    let found = parameterise_at(hit, surface_at(hit, origin, direction));
    low = bitcast<vec4<u32>>(vec4<f32>(found.uv, found.dpdu.xy));
    high = bitcast<vec4<u32>>(vec4<f32>(found.dpdu.z, found.dpdv));";

/// Placed shapes: world-space tangents against the transformed inverse map, and the twins against each other.
#[test]
fn tangents_of_placed_shapes_are_those_of_the_world() {
    let mut random = Random(31);
    let torus = Shape::Torus { major: 1.0, minor: f64::from(TORUS.y) };
    let mesh = Shape::Mesh(Arc::new(mesh_with_coordinates()));
    let shapes = [Shape::Sphere, Shape::Cube, Shape::Cylinder, Shape::Cone, torus, mesh, Shape::Plane];
    let placed: Vec<(Shape, DAffine3)> =
        (0..70).map(|i| (shapes[i % shapes.len()].clone(), random.transform(4.0))).collect();
    let buffers = flattened(&scene_of(placed));
    let scene = bindings(&buffers);
    let names = ["sphere", "cube", "cylinder", "cone", "torus", "plane", "mesh"];
    let maps = faces();
    let (mut queries, mut found, mut worst, mut compared) = (Vec::new(), Vec::new(), 0.0f64, [0; 7]);
    for ray in rays_into(&buffers, &mut random, 6.0, 12_000) {
        let mut tally = Tally::default();
        let hit = scene_intersect(&scene, ray.origin, ray.direction, 1e30, &mut tally);
        if hit.t <= 0.0 {
            continue;
        }
        let surface = surface_at(&scene, hit, ray.origin, ray.direction);
        let here = parameterise_at(&scene, hit, surface);
        let Hit { t, instance, primitive, b1, b2 } = hit;
        let (o, d) = (ray.origin.to_array().map(f32::to_bits), ray.direction.to_array().map(f32::to_bits));
        let [t, b1, b2] = [t, b1, b2].map(f32::to_bits);
        queries.push([o[0], o[1], o[2], d[0], d[1], d[2], t, instance, primitive, b1, b2]);
        found.push(here);
        assert!(here.uv.is_finite() && here.dpdu.is_finite() && here.dpdv.is_finite(), "{hit:?} {here:?}");

        let placed = &buffers.instances[instance as usize];
        let name = names[placed.shape as usize];
        let Some(face) = maps.iter().find(|face| face.shape == name && face.face == primitive) else { continue };
        let (u, v) = (f64::from(here.uv.x), f64::from(here.uv.y));
        // Close to a pole the coordinates of a rounded point are good to few digits.
        if !(0.01..0.99).contains(&v) && ["sphere", "cone"].contains(&name) {
            continue;
        }
        let rows = placed.world_from_object.map(|row| row.as_dvec4());
        let to_world = |v: DVec3| DVec3::from_array(rows.map(|row| row.truncate().dot(v)));
        let (dpdu, dpdv) = tangents(face.point, u, v);
        let (dpdu, dpdv) = (to_world(dpdu), to_world(dpdv));
        worst = worst.max((here.dpdu.as_dvec3() - dpdu).length() / dpdu.length());
        worst = worst.max((here.dpdv.as_dvec3() - dpdv).length() / dpdv.length());
        let there = to_world((face.point)(u, v)) + DVec3::from_array(rows.map(|row| row.w));
        let off = (there - surface.point.as_dvec3()).length();
        assert!(off < 2e-5 * (1.0 + there.length()), "{name}: the point is {off} from where its coordinates are");
        compared[placed.shape as usize] += 1;
    }
    println!("compared {compared:?}, tangents off by {worst:.1e} of their lengths at most");
    assert!(compared[..6].iter().all(|&count| count > 100) && worst < 1e-4, "{compared:?} {worst}");

    let gpu = evaluate(&buffers, AT_HIT, &queries);
    let words = |p: &Parameterisation| {
        [p.uv.x, p.uv.y, p.dpdu.x, p.dpdu.y, p.dpdu.z, p.dpdv.x, p.dpdv.y, p.dpdv.z].map(|x| (x + 0.0).to_bits())
    };
    let same = |(gpu, cpu): &(&[u32; 8], &Parameterisation)| {
        gpu.map(|word| (f32::from_bits(word) + 0.0).to_bits()) == words(cpu)
    };
    let identical = gpu.iter().zip(&found).filter(same).count();
    println!("{identical} of {} hits are identical to the bit", found.len());
    assert!(found.len() > 4000 && identical == found.len(), "{identical} of {}", found.len());
    let shuffled = gpu.iter().skip(1).zip(&found).filter(same).count();
    assert!(shuffled * 10 < found.len(), "the answers of other hits passed");
}
