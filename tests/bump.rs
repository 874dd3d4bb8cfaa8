//! Bump maps: slopes with a known normal, heights that rise outwards on every shape, and normals that stay in view.

use crate::support::function_table::{Compare::Floats, FunctionTable, Lane, Twins, lane_vec3, vec3_lane};
use crate::support::placed::*;
use crate::support::rays::{draw, unit_vector};
use glam::{DAffine3, DVec3, Vec2, Vec3, Vec4};
use gpu_trace::cpu::bindings::Bindings;
use gpu_trace::cpu::geometry::bvh::scene_intersect;
use gpu_trace::cpu::geometry::hit::{Hit, Surface};
use gpu_trace::cpu::geometry::instance::surface_at;
use gpu_trace::cpu::geometry::parameterisation::parameterise_at;
use gpu_trace::cpu::math::noise::perlin_octaves;
use gpu_trace::cpu::shading::bump::{bump_normal, tilted_normal, visible_normal};
use gpu_trace::cpu::shading::detail::{FOOTPRINT_MAX, map_footprint, surface_detail};
use gpu_trace::flatten::{FeatureSet, SceneBuffers};
use gpu_trace::layout::{MATERIAL_NOISE_BUMP, SHAPE_MESH};
use gpu_trace::renderer::Tally;
use gpu_trace::scene::Shape;
use gpu_trace::shader::PARTS;
use std::sync::Arc;

/// An image of one level as it lies in the texel buffer: width, height, levels, RGBA8, the level's place, texels.
pub fn image_words(width: u32, height: u32, texel: impl Fn(u32, u32) -> u32) -> Vec<u32> {
    let texels = (0..width * height).map(|i| texel(i % width, i / width) * 0x0001_0101);
    [width, height, 1, 0, 5].into_iter().chain(texels).collect()
}

/// A shape under a bump map: the image of these words, or noise.
fn bumped(shape: Shape, transform: DAffine3, image: Option<Vec<u32>>) -> SceneBuffers {
    let mut buffers = flattened(&scene_of([(shape, transform)]));
    for material in &mut buffers.materials {
        match image {
            Some(_) => material.bump = 0,
            None => material.flags |= MATERIAL_NOISE_BUMP,
        }
        material.noise_z = 0.37;
    }
    buffers.texels = image.unwrap_or_default();
    buffers.features = FeatureSet::of(&buffers);
    buffers
}

fn meet(scene: &Bindings, origin: Vec3, direction: Vec3) -> Option<(Hit, Surface)> {
    let hit = scene_intersect(scene, origin, direction, 3.0e38, &mut Tally::default());
    (hit.t > 0.0).then(|| (hit, surface_at(scene, hit, origin, direction)))
}

fn shapes() -> Vec<Shape> {
    vec![
        Shape::Sphere,
        Shape::Cube,
        Shape::Cylinder,
        Shape::Cone,
        Shape::Torus { major: 1.0, minor: 0.4 },
        Shape::Plane,
        Shape::Mesh(Arc::new(bumpy_ball(8))),
    ]
}

/// A ramp that grows by 1/15 a texel makes the plane's normal lean back by that slope, on both sides and under every
/// transform: 1/15 is the tangent, in object space, of the angle between the normals.
#[test]
fn a_ramp_on_a_plane_has_the_normal_of_its_slope() {
    let mut random = Random(41);
    let mut least_wrong = f64::INFINITY;
    let along_u = image_words(16, 1, |x, _| 17 * x);
    let along_v = image_words(1, 16, |_, y| 17 * y);
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let fixed = [DAffine3::IDENTITY, DAffine3::from_scale(DVec3::splat(50.0)), mirror];
    for round in 0..200 {
        let transform = fixed.get(round).copied().unwrap_or_else(|| random.transform(3.0));
        for (image, axis) in [(&along_u, DVec3::X), (&along_v, DVec3::Z)] {
            let buffers = bumped(Shape::Plane, transform, Some(image.clone()));
            let scene = bindings(&buffers);
            let to_normal = transform.matrix3.inverse().transpose();
            let upright = (to_normal * DVec3::Y).normalize();
            let target = DVec3::new(random.between(0.1, 0.9), 0.0, random.between(0.1, 0.9));
            for side in [1.0, -1.0] {
                let origin = transform.transform_point3(target) + upright * side;
                let direction = (-side * upright).as_vec3();
                let (hit, surface) = meet(&scene, origin.as_vec3(), direction).expect("the plane is met");
                let normal = surface_detail(&scene, hit, surface, direction, 0.0).shading_normal.as_dvec3();
                let leaning = |slope: f64| side * (to_normal * (DVec3::Y - axis * slope)).normalize();
                let error = (normal - leaning(1.0 / 15.0)).length();
                assert!(error < 1e-4, "{error} off under {transform:?} from side {side}");
                least_wrong = least_wrong.min((normal - leaning(-1.0 / 15.0)).length());
            }
        }
    }
    assert!(least_wrong > 0.01, "the opposite slope is only {least_wrong} off");
}

/// Pairs of neighbouring hits: the change of the height between them, and the way from one to the other along the
/// tilt of the outward normal at the first.
fn rises(buffers: &SceneBuffers, random: &mut Random, transform: &DAffine3, pairs: &mut Vec<[f64; 2]>) {
    let scene = bindings(buffers);
    for _ in 0..150 {
        let origin = transform.transform_point3(random.point(2.0)).as_vec3();
        let target = transform.transform_point3(random.point(0.9)).as_vec3();
        let direction = (target - origin).normalize();
        let beside = (direction + random.point(0.0005).as_vec3()).normalize();
        let (Some((hit, first)), Some((other, second))) =
            (meet(&scene, origin, direction), meet(&scene, origin, beside))
        else {
            continue;
        };
        let [at, there] = [parameterise_at(&scene, hit, first), parameterise_at(&scene, other, second)];
        // Not across an edge, a seam, or the rim of the shape.
        let near = (second.point - first.point).length() < 0.02 * hit.t && (there.uv - at.uv).length() < 0.02;
        let same = hit.primitive == other.primitive && first.entering == second.entering;
        if !near || !same || first.geometric_normal.dot(direction) > -0.2 {
            continue;
        }
        let head_on = -first.geometric_normal;
        let normal = surface_detail(&scene, hit, first, head_on, 0.0).shading_normal;
        let outward = if first.entering { normal } else { -normal };
        let tilt = outward - outward.dot(first.geometric_normal) * first.geometric_normal;
        let height = |uv: Vec2| f64::from(perlin_octaves(uv.x, uv.y, 0.37));
        pairs.push([height(there.uv) - height(at.uv), f64::from(tilt.dot(second.point - first.point))]);
    }
}

/// Shares of the pairs whose normal leans away from the greater height, and towards it.
fn leanings(pairs: &[[f64; 2]]) -> [f64; 2] {
    let clear: Vec<_> = pairs.iter().filter(|[rise, lean]| rise.abs() > 1e-4 && lean.abs() > 3e-6).collect();
    assert!(clear.len() > 300, "only {} of {} pairs are clear", clear.len(), pairs.len());
    [-1.0, 1.0]
        .map(|sign| clear.iter().filter(|[rise, lean]| rise * lean * sign > 0.0).count() as f64)
        .map(|count| count / clear.len() as f64)
}

/// The height between two hits nearby says which way the normal has to lean, whatever the tangents: away from the
/// greater height as seen from outside, towards it from inside, on shapes that are stretched, sheared and mirrored.
#[test]
fn heights_rise_outwards_on_every_shape_and_both_sides() {
    for (seed, shape) in (42..).zip(shapes()) {
        let mut random = Random(seed);
        let mut pairs = Vec::new();
        for _ in 0..40 {
            let transform = random.transform(2.0);
            rises(&bumped(shape.clone(), transform, None), &mut random, &transform, &mut pairs);
        }
        let [away, towards] = leanings(&pairs);
        println!("{shape:?}: {} pairs, {towards:.4} lean to the wrong side", pairs.len());
        assert!(away > 0.99, "{shape:?}: {towards} of the normals lean towards the greater height");
        pairs.iter_mut().for_each(|[_, lean]| *lean = -*lean);
        assert!(leanings(&pairs)[1] > 0.99, "{shape:?}: dents passed for bumps");
    }
}

/// A mesh whose image lies on it either way round.
#[test]
fn heights_rise_outwards_where_a_meshs_image_is_mirrored() {
    for mirrored in [false, true] {
        let mut random = Random(50);
        let mut pairs = Vec::new();
        for _ in 0..40 {
            let transform = random.transform(2.0);
            let mut buffers = bumped(Shape::Mesh(Arc::new(quad())), transform, None);
            let word = |p: Vec3| {
                let u = if mirrored { 1.0 - p.x } else { p.x };
                (u * 65535.0) as u32 | ((p.z * 65535.0) as u32) << 16
            };
            for triangle in &mut buffers.triangles {
                [triangle.uv0, triangle.uv1, triangle.uv2] = [triangle.p0, triangle.p1, triangle.p2].map(word);
            }
            for instance in buffers.instances.iter_mut().filter(|instance| instance.shape == SHAPE_MESH) {
                instance.parameters = Vec4::new(0.0, 0.0, 1.0, 1.0);
            }
            rises(&buffers, &mut random, &transform, &mut pairs);
        }
        let [away, _] = leanings(&pairs);
        assert!(away > 0.99, "mirrored {mirrored}: only {away} lean away from the greater height");
    }
}

/// Normals within 89 degrees of the true one, and views from above the surface.
fn normals_and_views() -> Vec<[Vec3; 3]> {
    let above = |v: DVec3, n: DVec3, least: f64| {
        let upper = if v.dot(n) < 0.0 { -v } else { v };
        (upper + n * least).normalize().as_vec3()
    };
    draw((unit_vector(), unit_vector(), unit_vector(), 0..4), 8000)
        .into_iter()
        .map(|(n, turned, view, kind)| {
            let grazing = view - n * view.dot(n) * if kind == 0 { 0.999 } else { 0.0 };
            [above(turned, n, 0.02), n.as_vec3(), above(grazing.normalize(), n, 1e-4)]
        })
        .collect()
}

#[test]
fn visible_normals_face_the_viewer_and_mirror_above_the_surface() {
    let mut raw_dark = 0;
    let mut kept = 0;
    for [n, geometric, view] in normals_and_views() {
        let visible = visible_normal(n, geometric, view);
        let view_z = view.dot(geometric);
        assert!((visible.length() - 1.0).abs() < 1e-5);
        assert!(visible.dot(view) >= 0.499 * view_z, "{n} from {view} about {geometric} is {visible}");
        let mirrored = 2.0 * visible.dot(view) * visible - view;
        assert!(mirrored.dot(geometric) > (0.9 * view_z).min(0.01) - 1e-4, "{n} {geometric} {view}");
        // Bent within the plane of both normals, towards the true one, and no further than that.
        let aside = n.cross(geometric).normalize_or_zero();
        assert!(visible.dot(aside).abs() < 1e-4 && visible.dot(n) > n.dot(geometric) - 1e-4);
        raw_dark += usize::from(n.dot(view) <= 0.0);
        kept += usize::from(visible == n);
    }
    assert!(raw_dark > 200 && kept > 2000, "{raw_dark} unbent normals face away, {kept} are kept");
    // Straight on, and where there is nothing to bend.
    assert_eq!(visible_normal(Vec3::Y, Vec3::Y, Vec3::Y), Vec3::Y);
    assert_eq!(visible_normal(-Vec3::Y, Vec3::Y, Vec3::Y), Vec3::Y);
    assert!(visible_normal(Vec3::X, Vec3::Y, Vec3::X).is_finite());
}

/// A lamp at the eye lights what the eye sees: with bumps as steep as an image can have, no point is less than half as
/// bright as on the smooth shape, and none is black.
#[test]
fn extreme_bumps_leave_no_black_spots() {
    let chequers = image_words(64, 64, |x, y| 255 * ((x / 2 + y / 2) % 2));
    let mut random = Random(51);
    for (shape, image) in shapes().into_iter().flat_map(|shape| [(shape.clone(), None), (shape, Some(&chequers))]) {
        let (mut seen, mut dark_unbent) = (0, 0);
        // Not turned, so that object space is the world's.
        let transform = DAffine3::IDENTITY;
        let buffers = bumped(shape.clone(), transform, image.cloned());
        let scene = bindings(&buffers);
        for _ in 0..4000 {
            let eye = random.point(4.0).as_vec3();
            let direction = (random.point(1.0).as_vec3() - eye).normalize();
            let Some((hit, surface)) = meet(&scene, eye, direction) else { continue };
            let detailed = surface_detail(&scene, hit, surface, direction, 0.0);
            let [bumpy, smooth] =
                [detailed.shading_normal, surface.geometric_normal].map(|n| -f64::from(n.dot(direction)));
            assert!(bumpy >= 0.49 * smooth && bumpy > 0.0, "{shape:?}: {bumpy} where the smooth one has {smooth}");
            let side = if surface.entering { 1.0 } else { -1.0 };
            let parameterisation = parameterise_at(&scene, hit, surface);
            let material = &buffers.materials[surface.material as usize];
            let raw = bump_normal(&scene, material, &parameterisation, side * surface.geometric_normal, 0.0);
            seen += 1;
            dark_unbent += usize::from(side * raw.dot(direction) > 0.0);
        }
        assert!(seen > 300, "{shape:?}: only {seen} hits");
        if image.is_some() {
            assert!(dark_unbent * 50 > seen, "{shape:?}: only {dark_unbent} of {seen} unbent normals face away");
        }
    }
}

#[test]
fn bumps_too_small_to_see_fade_out() {
    let noise = bumped(Shape::Plane, DAffine3::IDENTITY, None);
    let chequers = image_words(64, 64, |x, y| 255 * ((x + y) % 2));
    let image = bumped(Shape::Plane, DAffine3::IDENTITY, Some(chequers));
    for (buffers, widths) in [(noise, [0.0, 0.5, 8.0, 1e9]), (image, [0.0, 4.0 / 64.0, 40.0 / 64.0, 1e9])] {
        let scene = bindings(&buffers);
        let mut random = Random(52);
        let mut tilts = [0.0_f32; 4];
        for _ in 0..500 {
            let origin = (random.point(9.0) * DVec3::new(1.0, 0.0, 1.0) + DVec3::Y).as_vec3();
            let (hit, surface) = meet(&scene, origin, Vec3::NEG_Y).expect("the plane is met");
            for (tilt, width) in tilts.iter_mut().zip(widths) {
                let normal = surface_detail(&scene, hit, surface, Vec3::NEG_Y, width).shading_normal;
                *tilt += (normal - Vec3::Y).length() / 500.0;
            }
        }
        println!("mean tilts {tilts:?} for footprints {widths:?}");
        assert!(tilts[0] > 0.05 && tilts[1] < 0.5 * tilts[0] && tilts[2] < 0.1 * tilts[0] && tilts[3] < 1e-3);
    }
}

#[test]
fn footprints_grow_with_the_cone_the_angle_and_the_texels() {
    let area = |u: f32, v: f32, cosine: f32| map_footprint(0.5, cosine, Vec3::X * u, Vec3::Z * v);
    assert!((area(1.0, 1.0, -1.0) - 0.5).abs() < 1e-6);
    assert!((area(1.0, 1.0, -0.5) - 1.0).abs() < 1e-6);
    assert!((area(4.0, 1.0, -1.0) - 0.25).abs() < 1e-6);
    assert_eq!(area(0.0, 1.0, -1.0), FOOTPRINT_MAX);
    assert_eq!(map_footprint(0.0, 0.0, Vec3::X, Vec3::Z), 0.0);
}

#[test]
fn surfaces_without_maps_stay_as_they_are() {
    let buffers = flattened(&scene_of([(Shape::Sphere, DAffine3::IDENTITY)]));
    let scene = bindings(&buffers);
    let (hit, surface) = meet(&scene, Vec3::Z * 3.0, Vec3::NEG_Z).expect("the ball is met");
    assert_eq!(surface_detail(&scene, hit, surface, Vec3::NEG_Z, 0.1), surface);
    let bumpy = bumped(Shape::Sphere, DAffine3::IDENTITY, None);
    assert_ne!(surface_detail(&bindings(&bumpy), hit, surface, Vec3::NEG_Z, 0.001), surface);
}

/// The parts of the shaders without entry points.
fn parts() -> Vec<&'static str> {
    let names = PARTS.iter().filter_map(|part| part.path.strip_prefix("shaders/"));
    names.filter(|name| !name.starts_with("kernels/")).collect()
}

#[test]
fn normals_agree_on_both_devices() {
    let mut random = Random(53);
    let inputs: Vec<[Lane; 4]> = normals_and_views()
        .into_iter()
        .map(|[n, geometric, view]| {
            let size = random.between(-3.0, 3.0).exp2();
            let [u, v] = [random.point(size), random.point(size)].map(DVec3::as_vec3);
            let slope = random.point(1.0).as_vec3();
            [vec3_lane(n, slope.x), vec3_lane(geometric, slope.y), vec3_lane(view, slope.z), vec3_lane(u, v.x)]
        })
        .collect();
    let table = FunctionTable::new(
        &parts(),
        "let n = vec3_at(0u); let g = vec3_at(1u); let v = vec3_at(2u); let u = vec3_at(3u);
         let slope = vec2<f32>(f32_at(0u, 3u), f32_at(1u, 3u));
         results[0] = float_lane(vec4<f32>(tilted_normal(g, u, v, slope), map_footprint(slope.x * slope.x, slope.y, u, v)));
         results[1] = float_lane(vec4<f32>(visible_normal(n, g, v), 0.0));",
    );
    let cpu = |row: &[Lane; 4]| {
        let [n, g, v, u] = row.map(lane_vec3);
        let slope = Vec2::new(f32::from_bits(row[0][3]), f32::from_bits(row[1][3]));
        let footprint = map_footprint(slope.x * slope.x, slope.y, u, v);
        [vec3_lane(tilted_normal(g, u, v, slope), footprint), vec3_lane(visible_normal(n, g, v), 0.0)]
    };
    let twins = Twins::new(inputs, &table, cpu);
    let apart = |twins: &Twins<4, 2>| {
        let distance = |a: Lane, b: Lane| (lane_vec3(a) - lane_vec3(b)).length();
        let pairs = twins.gpu.iter().zip(&twins.cpu);
        pairs.map(|(a, b)| distance(a[0], b[0]).max(distance(a[1], b[1]))).fold(0.0, f32::max)
    };
    let footprints = |twins: &Twins<4, 2>| -> Twins<4, 1> {
        let last = |rows: &[[Lane; 2]]| rows.iter().map(|row| [[row[0][3], 0, 0, 0]]).collect::<Vec<[Lane; 1]>>();
        Twins { inputs: twins.inputs.clone(), gpu: last(&twins.gpu), cpu: last(&twins.cpu) }
    };
    println!("normals: {:.2e} apart at most, {:?}", apart(&twins), twins.difference([Floats, Floats]));
    // Dot and cross products may be summed in another order.
    assert!(apart(&twins) < 2e-5, "{} apart", apart(&twins));
    footprints(&twins).assert_close("map_footprint", [Floats], 4);
    let swapped = |row: &[Lane; 4]| cpu(&[row[0], row[1], row[3], row[2]]);
    let wrong = Twins { cpu: twins.inputs.iter().map(swapped).collect(), ..twins };
    assert!(apart(&wrong) > 0.1, "swapped tangents passed");
}
