//! Images in the texel buffer: how they are packed, what a lookup returns on both devices, and pictures of them.

use crate::support::kernel::evaluate;
use crate::support::placed::*;
use crate::support::{BOTH, Stage, paint, pixel_direction};
use glam::{DAffine3, DVec2, DVec3, Vec2, Vec3};
use gpu_trace::cpu::bindings::Bindings;
use gpu_trace::cpu::shading::texture::{environment_lookup, texture_lookup, texture_size};
use gpu_trace::flatten::SceneBuffers;
use gpu_trace::layout::*;
use gpu_trace::scene::{Bump, Image, Material, NodeId, Scene, Shape, Texels};
use std::f64::consts::PI;
use std::sync::Arc;

fn image(width: u32, height: u32, texel: impl FnMut(u32) -> [u8; 4]) -> Arc<Image> {
    let texels = Texels::Rgba8((0..width * height).map(texel).collect());
    Arc::new(Image { name: format!("{width} x {height}"), width, height, texels })
}

fn noisy(width: u32, height: u32) -> Arc<Image> {
    let mut random = Random(u64::from(width * 1000 + height));
    image(width, height, |_| random.bits().to_le_bytes())
}

fn radiance(width: u32, height: u32) -> Arc<Image> {
    let mut random = Random(77);
    let mut value = || random.between(-4.0, 6.0).exp2() as f32;
    let texels = Texels::Rgb32F((0..width * height).map(|_| [value(), value(), value()]).collect());
    Arc::new(Image { name: "radiance".into(), width, height, texels })
}

/// Black and white squares of `cell` texels, `cells` of them along each edge.
fn checkerboard(cells: u32, cell: u32) -> Arc<Image> {
    let edge = cells * cell;
    image(
        edge,
        edge,
        |i| if ((i % edge) / cell + i / edge / cell).is_multiple_of(2) { [255; 4] } else { [0, 0, 0, 255] },
    )
}

fn textured(texture: &Arc<Image>) -> Material {
    Material { texture: Some(texture.clone()), ..paint(1.0, 0.0, 1.0) }
}

/// Buffers with these images, and where each begins.
fn packed(images: &[Arc<Image>]) -> (SceneBuffers, Vec<u32>) {
    let mut stage = Stage::new(8, 8);
    for image in images {
        stage.add(Shape::Sphere, DAffine3::IDENTITY, textured(image));
    }
    let buffers = flattened(&stage.finish());
    let starts = buffers.materials.iter().map(|material| material.texture).collect();
    (buffers, starts)
}

/// Sizes of all sorts, and both formats.
fn images() -> Vec<Arc<Image>> {
    let sizes = [(1, 1), (2, 1), (1, 5), (3, 2), (7, 13), (16, 16), (64, 48), (100, 1)];
    sizes.iter().map(|&(width, height)| noisy(width, height)).chain([radiance(9, 6), radiance(1, 1)]).collect()
}

/// The largest level's texel, repeated.
fn texel(image: &Image, x: i64, y: i64) -> DVec3 {
    let (width, height) = (i64::from(image.width), i64::from(image.height));
    let index = (y.rem_euclid(height) * width + x.rem_euclid(width)) as usize;
    match &image.texels {
        Texels::Rgba8(texels) => DVec3::from_array([0, 1, 2].map(|i| f64::from(texels[index][i]) / 255.0)),
        Texels::Rgb32F(texels) => DVec3::from_array(texels[index].map(f64::from)),
    }
}

/// Bilinear and repeated, in double precision.
fn bilinear(image: &Image, uv: DVec2) -> DVec3 {
    let at = uv * DVec2::new(f64::from(image.width), f64::from(image.height)) - 0.5;
    let (cell, share) = (at.floor(), at - at.floor());
    let (x, y) = (cell.x as i64, cell.y as i64);
    let row = |y| texel(image, x, y).lerp(texel(image, x + 1, y), share.x);
    row(y).lerp(row(y + 1), share.y)
}

const LOOKUP: &str = "
    let found = texture_lookup(word(0u), vec2<f32>(number(1u), number(2u)), number(3u));
    low = vec4<u32>(bitcast<vec3<u32>>(found), 0u);";

const SURROUNDINGS: &str = "
    let found = environment_lookup(word(0u), vec3<f32>(number(1u), number(2u), number(3u)));
    low = vec4<u32>(bitcast<vec3<u32>>(found), 0u);";

/// On the device, for rows of (image, three numbers).
fn on_device(buffers: &SceneBuffers, body: &str, rows: &[(u32, Vec3)]) -> Vec<Vec3> {
    let queries: Vec<[u32; 4]> =
        rows.iter().map(|(image, v)| [*image, v.x.to_bits(), v.y.to_bits(), v.z.to_bits()]).collect();
    let vector = |words: [u32; 8]| Vec3::from_array([0, 1, 2].map(|i| f32::from_bits(words[i])));
    evaluate(buffers, body, &queries).into_iter().map(vector).collect()
}

/// Coordinates on texels, between them, on seams and corners, and far away; footprints of all sizes.
fn lookups(starts: &[u32]) -> Vec<(u32, Vec3)> {
    let mut random = Random(5);
    let mut rows = Vec::new();
    for &start in starts {
        for &u in &[0.0f32, 1.0, -1e-9, 0.5, -0.25, 1.0 / 3.0, 3.75, 1.0f32.next_down(), -1e6, 12_345.678] {
            for &v in &[0.0f32, -0.0, 1.0, 0.999_999_9, 0.1, -7.3] {
                for footprint in [0.0f32, 0.01, 1.0 / 3.0, 1.0, 1e9] {
                    rows.push((start, Vec3::new(u, v, footprint)));
                }
            }
        }
        for _ in 0..300 {
            let uv = random.point(3.0);
            rows.push((start, Vec3::new(uv.x as f32, uv.y as f32, random.between(-9.0, 1.0).exp2() as f32)));
        }
    }
    rows
}

#[test]
fn lookups_agree() {
    let (buffers, starts) = packed(&images());
    let scene = bindings(&buffers);
    let rows = lookups(&starts);
    let cpu: Vec<Vec3> = rows.iter().map(|(image, v)| texture_lookup(&scene, *image, v.truncate(), v.z)).collect();
    let gpu = on_device(&buffers, LOOKUP, &rows);
    assert!(cpu.iter().all(|colour| colour.is_finite()));
    let differing = |cpu: &[Vec3]| gpu.iter().zip(cpu).filter(|(a, b)| a != b).count();
    println!("{} of {} lookups differ", differing(&cpu), rows.len());
    assert_eq!(differing(&cpu), 0, "of {}", rows.len());
    // A twin that shifts by half a texel, and one that ignores the footprint, are found out.
    let shifted = |(image, v): &(u32, Vec3)| {
        let half = Vec2::splat(0.5) / texture_size(&scene, *image);
        texture_lookup(&scene, *image, v.truncate() + half, v.z)
    };
    assert!(differing(&rows.iter().map(shifted).collect::<Vec<_>>()) > rows.len() / 3);
    let sharp = |(image, v): &(u32, Vec3)| texture_lookup(&scene, *image, v.truncate(), 0.0);
    assert!(differing(&rows.iter().map(sharp).collect::<Vec<_>>()) > rows.len() / 3);
}

#[test]
fn unfiltered_lookups_are_bilinear_and_repeated() {
    let images = images();
    let (buffers, starts) = packed(&images);
    let scene = bindings(&buffers);
    let mut random = Random(6);
    let mut worst = [0.0f64; 2];
    for (image, &start) in images.iter().zip(&starts) {
        let is_float = usize::from(matches!(image.texels, Texels::Rgb32F(_)));
        for _ in 0..500 {
            let uv = Vec2::new(random.between(-2.0, 2.0) as f32, random.between(-2.0, 2.0) as f32);
            let found = texture_lookup(&scene, start, uv, 0.0).as_dvec3();
            let error = (found - bilinear(image, uv.as_dvec2())).abs().max_element();
            worst[is_float] = worst[is_float].max(error);
        }
        // Texels are hit exactly at their middles.
        let size = DVec2::new(f64::from(image.width), f64::from(image.height));
        let last = DVec2::new(f64::from(image.width - 1), f64::from(image.height - 1));
        for corner in [DVec2::ZERO, last, DVec2::new(last.x, 0.0), DVec2::new(0.0, last.y)] {
            let uv = ((corner + 0.5) / size).as_vec2();
            let found = texture_lookup(&scene, start, uv, 0.0).as_dvec3();
            let expected = texel(image, corner.x as i64, corner.y as i64);
            assert!((found - expected).abs().max_element() < [5e-5, 0.1][is_float], "{}: {corner}", image.name);
        }
    }
    println!("off by {worst:?}");
    // Shared exponents keep nine bits of up to 64.
    assert!(worst[0] < 1e-4 && worst[1] < 64.0 / 512.0, "{worst:?}");
}

/// The seam between the last column and the first is a blend like any other, and so is the one between rows.
#[test]
fn seams_and_corners_wrap() {
    let four =
        image(2, 2, |i| [[200, 0, 0, 255], [0, 200, 0, 255], [0, 0, 200, 255], [100, 100, 100, 255]][i as usize]);
    let (buffers, starts) = packed(&[four]);
    let scene = bindings(&buffers);
    let at = |u, v| (texture_lookup(&scene, starts[0], Vec2::new(u, v), 0.0) * 255.0).round();
    assert_eq!(at(0.25, 0.25), Vec3::new(200.0, 0.0, 0.0), "row 0 is at v = 0");
    assert_eq!(at(0.75, 0.25), Vec3::new(0.0, 200.0, 0.0));
    assert_eq!(at(0.25, 0.75), Vec3::new(0.0, 0.0, 200.0));
    assert_eq!(at(0.0, 0.25), Vec3::new(100.0, 100.0, 0.0));
    assert_eq!(at(1.0, 0.25), at(0.0, 0.25));
    assert_eq!(at(0.25, 0.0), Vec3::new(100.0, 0.0, 100.0));
    assert_eq!(at(0.0, 0.0), Vec3::splat(75.0));
    assert_eq!(at(-3.75, 7.25), at(0.25, 0.25));
}

#[test]
fn surroundings_agree_and_lie_where_they_should() {
    let images = [radiance(16, 8), noisy(7, 3), radiance(1, 1), noisy(64, 32)];
    let (buffers, starts) = packed(&images);
    let scene = bindings(&buffers);
    let mut random = Random(8);
    let mut rows = Vec::new();
    for &start in &starts {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            rows.extend([(start, axis), (start, -axis), (start, axis + 1e-8), (start, axis * -0.0 - Vec3::Z)]);
        }
        rows.extend((0..500).map(|_| (start, random.point(1.0).normalize().as_vec3())));
    }
    let cpu: Vec<Vec3> = rows.iter().map(|(image, d)| environment_lookup(&scene, *image, *d)).collect();
    let gpu = on_device(&buffers, SURROUNDINGS, &rows);
    let differing = gpu.iter().zip(&cpu).filter(|(a, b)| a != b).count();
    assert_eq!(differing, 0, "of {}", rows.len());
    let mirrored = rows.iter().map(|(image, d)| environment_lookup(&scene, *image, *d * Vec3::new(-1.0, 1.0, 1.0)));
    assert!(gpu.iter().zip(mirrored).filter(|(a, b)| *a != b).count() > rows.len() / 2, "a mirrored twin passed");

    // Against double precision, rows kept from wrapping.
    for (image, &start) in images.iter().zip(&starts) {
        let height = f64::from(image.height);
        for (_, d) in rows.iter().filter(|(from, _)| *from == start) {
            let e = d.as_dvec3();
            let v = (0.5 - e.y.atan2(e.x.hypot(e.z)) / PI).clamp(0.5 / height, 1.0 - 0.5 / height);
            let expected = bilinear(image, DVec2::new(0.5 + e.x.atan2(0.0 - e.z) / (2.0 * PI), v));
            let error = (environment_lookup(&scene, start, *d).as_dvec3() - expected).abs().max_element();
            assert!(error < 64.0 / 512.0 + 1e-4, "{} towards {d}: off by {error}", image.name);
        }
    }
    // 16 columns: the middle of the picture is between columns 7 and 8, +x a quarter to the right.
    let towards = |d: Vec3| environment_lookup(&scene, starts[0], d).as_dvec3();
    let column = |x, y| texel(&images[0], x, y);
    let half_step = (PI / 16.0) as f32;
    let right_of_middle = Vec3::new(half_step.sin(), half_step.tan() * 0.0, -half_step.cos());
    assert!((towards(right_of_middle) - (column(8, 3) + column(8, 4)) / 2.0).abs().max_element() < 0.15);
    assert!((towards(Vec3::Y) - (column(7, 0) + column(8, 0)) / 2.0).abs().max_element() < 0.15);
    assert!((towards(Vec3::NEG_Y) - (column(7, 7) + column(8, 7)) / 2.0).abs().max_element() < 0.15);
}

#[test]
fn every_level_keeps_the_mean() {
    for image in images() {
        let (buffers, starts) = packed(std::slice::from_ref(&image));
        let scene = bindings(&buffers);
        let whole = texture_lookup(&scene, starts[0], Vec2::new(0.3, 0.8), 100.0).as_dvec3();
        let (width, height) = (i64::from(image.width), i64::from(image.height));
        let sum: DVec3 = (0..width * height).map(|i| texel(&image, i % width, i / width)).sum();
        let mean = sum / (width * height) as f64;
        let allowed = if matches!(image.texels, Texels::Rgb32F(_)) { mean.max_element() / 512.0 } else { 0.51 / 255.0 };
        assert!((whole - mean).abs().max_element() < allowed, "{}: {whole} for {mean}", image.name);
    }
}

/// Standard deviation of a fine checkerboard looked up at random with footprints of so many squares.
fn contrast(scene: &Bindings, start: u32, cells: f32, squares: f32) -> f64 {
    let mut random = Random(3);
    let count = 4000;
    let values: Vec<f64> = (0..count)
        .map(|_| {
            let uv = Vec2::new(random.between(0.0, 1.0) as f32, random.between(0.0, 1.0) as f32);
            f64::from(texture_lookup(scene, start, uv, squares / cells).x)
        })
        .collect();
    let mean = values.iter().sum::<f64>() / f64::from(count);
    assert!((mean - 0.5).abs() < 0.05, "the mean at {squares} squares is {mean}");
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / f64::from(count)).sqrt()
}

#[test]
fn fine_squares_far_away_are_grey() {
    let (buffers, starts) = packed(&[checkerboard(64, 1), checkerboard(64, 4), checkerboard(50, 3)]);
    let scene = bindings(&buffers);
    for (&start, cells) in starts.iter().zip([64.0, 64.0, 50.0]) {
        let sharp = contrast(&scene, start, cells, 0.0);
        let near: Vec<f64> = [0.25, 1.0, 1.5, 2.0].map(|squares| contrast(&scene, start, cells, squares)).to_vec();
        let far: Vec<f64> = [3.0, 5.0, 10.0, 64.0].map(|squares| contrast(&scene, start, cells, squares)).to_vec();
        println!("deviation: sharp {sharp:.3}, {near:.3?} at 1/4, 1, 3/2 and 2 squares, {far:.3?} at 3, 5, 10 and 64");
        assert!(sharp > 0.15, "{sharp}: the board has no contrast to lose");
        assert!(far.iter().all(|&deviation| deviation < 0.06), "{far:?}");
        assert!(near[3] < 0.6 * sharp, "{near:?}");
    }
}

#[test]
fn images_are_stored_once_and_in_full() {
    let (a, b) = (noisy(5, 3), noisy(4, 4));
    // Equal pixels in another allocation are another image.
    let again = Arc::new((*a).clone());
    let (buffers, starts) = packed(&[a.clone(), b, a.clone(), again]);
    assert_eq!(buffers.materials.len(), 4, "four materials were described");
    assert_eq!(starts[0], starts[2]);
    assert_ne!(starts[0], starts[3]);
    // 5 x 3, 2 x 1, 1 x 1 with a header of four words and three places; 4 x 4, 2 x 2, 1 x 1.
    let (first, second) = (4 + 3 + 15 + 2 + 1, 4 + 3 + 16 + 4 + 1);
    assert_eq!(starts, [0, first, 0, first + second]);
    assert_eq!(buffers.texels.len() as u32, 2 * first + second);
    assert_eq!(buffers.texels[..7], [5, 3, 3, 0, 7, 22, 24]);
    let Texels::Rgba8(bytes) = &a.texels else { panic!("8 bits were asked for") };
    let words: Vec<u32> = bytes.iter().map(|&rgba| u32::from_le_bytes(rgba)).collect();
    assert_eq!(buffers.texels[7..22], words);
    assert_eq!(buffers.frame.background_image, NONE);
    assert!(buffers.features.texture && !buffers.features.bump && !buffers.features.background_image);
}

/// A scene of spheres that share a material, with changes to the nodes.
fn with_overrides(material: Material, change: impl Fn(usize, &mut gpu_trace::scene::Node)) -> Scene {
    let mut stage = Stage::new(8, 8);
    for _ in 0..5 {
        stage.add(Shape::Sphere, DAffine3::IDENTITY, material.clone());
    }
    let mut scene = stage.finish();
    let graph = Arc::make_mut(&mut scene.graph);
    let shared = graph.nodes[1].material;
    for index in 1..=5 {
        let node = graph.node_mut(NodeId(index));
        node.material = shared;
        change(index as usize, node);
    }
    scene
}

#[test]
fn nodes_replace_the_maps_of_their_materials() {
    let (own, other, bump) = (noisy(2, 2), noisy(3, 3), noisy(4, 4));
    let material = Material { texture: Some(own.clone()), emission: Vec3::X, ..paint(0.1, 0.2, 0.3) };
    let scene = with_overrides(material, |index, node| match index {
        2 => node.texture = Some(other.clone()),
        3 => node.bump = Some(Bump::Image(bump.clone())),
        4 => node.bump = Some(Bump::Noise { z: 1.5 }),
        // The same as the material's own.
        5 => node.texture = Some(own.clone()),
        _ => {}
    });
    let buffers = flattened(&scene);
    assert_eq!(buffers.materials.len(), 4, "one for each combination");
    let mut described: Vec<_> = buffers
        .instances
        .iter()
        .map(|instance| {
            let Material4 { edge, bump, noise_z, flags } = described(&buffers, instance.material);
            (edge, bump, noise_z.to_bits(), flags)
        })
        .collect();
    described.sort();
    let z = 1.5f32.to_bits();
    let both = MATERIAL_TEXTURE_REPLACES | MATERIAL_NOISE_BUMP;
    let one = MATERIAL_TEXTURE_REPLACES;
    assert_eq!(described, [(2, 0, 0, one), (2, 0, 0, one), (2, 0, z, both), (2, 4, 0, one), (3, 0, 0, one)]);
    assert!(buffers.materials.iter().all(|material| material.emission == Vec3::X));
    assert!(buffers.features.bump && buffers.features.texture);
}

/// The widths of a material's texture and bump images (0 for none), and the rest of its maps.
struct Material4 {
    edge: u32,
    bump: u32,
    noise_z: f32,
    flags: u32,
}

fn described(buffers: &SceneBuffers, index: u32) -> Material4 {
    let material = &buffers.materials[index as usize];
    let width = |start: u32| if start == NONE { 0 } else { buffers.texels[start as usize] };
    Material4 {
        edge: width(material.texture),
        bump: width(material.bump),
        noise_z: material.noise_z,
        flags: material.flags,
    }
}

#[test]
fn mists_and_glasses_come_first_and_have_numbers() {
    let mut stage = Stage::new(8, 8);
    stage.add(Shape::Sphere, DAffine3::IDENTITY, paint(0.1, 0.1, 0.1));
    let mist = Material { density: Some(0.25), reflection: 1.0, ior: Some(1.5), ..paint(0.2, 0.2, 0.2) };
    stage.add(Shape::Sphere, DAffine3::IDENTITY, Material { bump: Some(Bump::Noise { z: 0.0 }), ..mist });
    stage.add(Shape::Sphere, DAffine3::IDENTITY, Material { ior: Some(1.5), ..paint(0.3, 0.3, 0.3) });
    let buffers = flattened(&stage.finish());
    let numbers: Vec<_> = buffers.materials.iter().map(|m| (m.medium, m.density, m.ior, m.flags)).collect();
    assert_eq!(numbers, [(1, 0.25, 0.0, MATERIAL_MIST), (2, 0.0, 1.5, 0), (0, 0.0, 0.0, 0)]);
    assert_eq!(buffers.materials[0].reflection, 0.0, "mist has no surface");
    let found: Vec<_> = buffers.instances.iter().map(|i| buffers.materials[i.material as usize].diffuse.x).collect();
    assert_eq!(found.len(), 3);
    assert!([0.1, 0.2, 0.3].iter().all(|grey| found.contains(grey)), "{found:?}");
}

#[test]
fn images_that_cannot_be_packed_are_refused() {
    let scene = |image: Image| {
        let mut stage = Stage::new(8, 8);
        stage.add(Shape::Sphere, DAffine3::IDENTITY, textured(&Arc::new(image)));
        stage.finish()
    };
    let short = Image { name: "bark.png".into(), width: 4, height: 4, texels: Texels::Rgba8(vec![[0; 4]; 15]) };
    assert_eq!(refusal(&scene(short)), "the image 'bark.png' has 15 pixels in place of 4 x 4");
    let none = Image { name: "void".into(), width: 0, height: 9, texels: Texels::Rgb32F(vec![]) };
    assert!(refusal(&scene(none)).contains("'void' has 0 pixels"));
}

#[test]
fn the_surroundings_are_in_the_buffer() {
    let mut stage = Stage::new(8, 8);
    stage.add(Shape::Sphere, DAffine3::IDENTITY, textured(&noisy(3, 3)));
    stage.scene.background.image = Some(radiance(8, 4));
    let buffers = flattened(&stage.finish());
    let start = buffers.frame.background_image as usize;
    assert_eq!(buffers.texels[start..start + 4], [8, 4, 4, 1]);
    assert!(buffers.features.background_image);
}

/// A picture of the side of a box that fills it is the image, upright and not mirrored. Texels are five pixels wide, so
/// that the filter has nothing to do; the middle pixel of each shows its very colour.
#[test]
fn a_picture_of_a_side_is_the_image() {
    let edge = 40;
    for image in [noisy(8, 8), checkerboard(4, 2)] {
        for device in &BOTH {
            let mut stage = Stage::new(edge, edge);
            stage.scene.ambient = Vec3::ONE;
            let half = (PI / 6.0).tan();
            stage.add_box(DVec3::new(-half, -half, -2.0), DVec3::new(half, half, -1.0), textured(&image));
            let film = stage.film(device);
            let found = |x, y| {
                let [red, green, blue, _] = film.radiance(x, y).map(f64::from);
                DVec3::new(red, green, blue)
            };
            let off = |mirrored: bool| {
                let pixels = (0..edge * edge).map(|i| (i % edge, i / edge));
                let errors = pixels.map(|(x, y)| {
                    let u = (f64::from(x) + 0.5) / f64::from(edge);
                    let uv = DVec2::new(if mirrored { 1.0 - u } else { u }, (f64::from(y) + 0.5) / f64::from(edge));
                    (found(x, y) - bilinear(&image, uv)).abs().max_element()
                });
                errors.fold(0.0f64, f64::max)
            };
            let middles = (0..64).map(|i| (i % 8, i / 8)).map(|(x, y)| {
                (found(5 * x + 2, 5 * y + 2) - texel(&image, i64::from(x), i64::from(y))).abs().max_element()
            });
            let (worst, at_middles) = (off(false), middles.fold(0.0f64, f64::max));
            println!("{} on {device:?}: off by {worst:.1e}, at the middles by {at_middles:.1e}", image.name);
            assert!(worst < 1e-4 && at_middles < 1e-5, "{} on {device:?}: {worst} {at_middles}", image.name);
            assert!(off(true) > 0.1, "a mirrored image passed");
        }
    }
}

/// A floor of large squares seen from above against the ray's point in double precision, and fine squares towards
/// the horizon, which are grey with one sample a pixel.
#[test]
fn a_checkered_floor_is_sharp_near_and_grey_far_away() {
    for device in &BOTH {
        let mut stage = Stage::new(96, 96);
        stage.scene.ambient = Vec3::ONE;
        stage.add(Shape::Plane, DAffine3::from_translation(DVec3::NEG_Y), textured(&checkerboard(2, 8)));
        let scene = stage.scene.clone();
        let film = stage.film(device);
        let (mut near, mut far) = (0, Vec::new());
        for y in 50..96 {
            for x in 0..96 {
                let d = pixel_direction(&scene, x, y, [0.5, 0.5]);
                let distance = -1.0 / d.y;
                let found = f64::from(film.radiance(x, y)[0]);
                // Length of the pixel's footprint on the floor: its width over the sine of the angle.
                let footprint = 2.0 * (PI / 6.0).tan() / 96.0 * distance / -d.y;
                if footprint < 0.06 {
                    let uv = DVec2::new(d.x, d.z) * distance;
                    let expected = bilinear(&checkerboard(2, 8), uv).x;
                    assert!((found - expected).abs() < 1e-3, "{x}, {y} on {device:?}: {found} for {expected}");
                    near += 1;
                } else if footprint > 4.0 {
                    far.push(found);
                }
            }
        }
        let mean = far.iter().sum::<f64>() / far.len() as f64;
        let deviation = (far.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / far.len() as f64).sqrt();
        println!("{device:?}: {near} pixels near; {} far, mean {mean:.4}, deviation {deviation:.4}", far.len());
        assert!(near > 300 && far.len() > 200, "{near} {}", far.len());
        assert!((mean - 0.5).abs() < 0.01 && deviation < 0.02, "{mean} {deviation}");
    }
}
