//! Materials, textures, noise, lights and backgrounds: what each call makes.

use super::{RENDER, Sandbox, message, node, only_scene};
use glam::{DVec3, Vec3};
use gpu_trace::cpu::math::noise::perlin_noise;
use gpu_trace::scene::{Background, Bump, Image, Light, LightExtent, Material, Scene, Texels};
use gpu_trace::script::ScriptOptions;
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use std::io::Cursor;
use std::sync::Arc;

/// Two pixels, red and blue.
fn png() -> Vec<u8> {
    let picture = RgbImage::from_fn(2, 1, |x, _| Rgb(if x == 0 { [255, 0, 0] } else { [0, 0, 255] }));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageRgb8(picture).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// The scene of a script in whose folder lies `a.png`.
fn with_image(script: &str) -> Scene {
    let sandbox = Sandbox::new();
    sandbox.write("a.png", png());
    let mut scenes = sandbox.load(&format!("root = root or gr.node('root') {script} {RENDER}")).unwrap();
    scenes.remove(0)
}

fn with_image_message(script: &str) -> String {
    let sandbox = Sandbox::new();
    sandbox.write("a.png", png());
    sandbox.failure(script).0
}

fn light(script: &str) -> Light {
    let script =
        format!("gr.render(gr.node('r'), 'a', 1, 1, {{0,0,0}}, {{0,0,-1}}, {{0,1,0}}, 50, {{0,0,0}}, {{{script}}})");
    only_scene(&script).lights[0]
}

fn background(script: &str) -> Background {
    with_image(script).background
}

fn is_the_image(image: &Arc<Image>) -> bool {
    image.texels == Texels::Rgba8(vec![[255, 0, 0, 255], [0, 0, 255, 255]])
}

const SHINY: Material = Material {
    diffuse: Vec3::new(0.1, 0.2, 0.3),
    specular: Vec3::new(0.4, 0.5, 0.6),
    shininess: 7.0,
    reflection: 0.5,
    glossy: 0.25,
    ior: Some(1.5),
    texture: None,
    bump: None,
    density: None,
    emission: Vec3::ZERO,
    casts_shadow: true,
};

#[test]
fn texture_materials() {
    let scene = with_image(
        "gr.texture_material('a.png', {0.4, 0.5, 0.6}, 7)
         gr.texture_material('a.png', {0.4, 0.5, 0.6}, 7, 0.5, 0.25, 1.5)
         gr.texture_material(gr.texture('a.png'), {0.4, 0.5, 0.6}, 7, 0, 0, -1)",
    );
    let image = scene.graph.materials[0].texture.clone().unwrap();
    assert!(is_the_image(&image));
    let usual = Material::default();
    let plain = Material {
        diffuse: usual.diffuse,
        reflection: 0.0,
        glossy: 0.0,
        ior: None,
        texture: Some(Arc::clone(&image)),
        ..SHINY
    };
    let shiny = Material { diffuse: usual.diffuse, texture: Some(image), ..SHINY };
    assert_eq!(scene.graph.materials, [plain.clone(), shiny, plain]);
}

#[test]
fn bump_materials() {
    let scene = with_image(
        "gr.bump_material('a.png', {0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, 7, 0.5, 0.25, 1.5, 1)
         gr.bump_material('a.png', {0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, 7, 0.5, 0.25, 1.5, 2)
         gr.perlin_bump_material({0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, 7, 0.5, 0.25, 1.5, -2.5)",
    );
    let Some(Bump::Image(image)) = scene.graph.materials[0].bump.clone() else { panic!("no bump map") };
    assert!(is_the_image(&image));
    let bump = Some(Bump::Image(Arc::clone(&image)));
    let textured = Material { texture: Some(image), bump: bump.clone(), ..SHINY };
    let own_colour = Material { bump, ..SHINY };
    let noise = Material { bump: Some(Bump::Noise { z: -2.5 }), ..SHINY };
    assert_eq!(scene.graph.materials, [textured, own_colour, noise]);
}

#[test]
fn volumetric_materials() {
    let scene = only_scene(&format!(
        "gr.volumetric_material({{0.1, 0.2, 0.3}}, {{0.4, 0.5, 0.6}}, 7, 0.5)
         gr.volumetric_material({{0.1, 0.2, 0.3}}, {{0.4, 0.5, 0.6}}, 7, 1)
         root = gr.node('root') {RENDER}"
    ));
    let mist = |density| Material { reflection: 0.0, glossy: 0.0, ior: None, density: Some(density), ..SHINY };
    assert_eq!(scene.graph.materials, [mist(0.5), mist(1.0)]);
}

#[test]
fn textures_and_bumps_of_nodes() {
    let scene = with_image(
        "local t = gr.texture('a.png')
         gr.sphere('plain')
         gr.sphere('both'):set_texture(t)
         local c = gr.cube('file') c:set_texture('a.png') c:set_bump('a.png')
         local d = gr.cube('back') d:set_texture(t) d:set_bump(t) d:set_texture(nil) d:set_bump(nil)",
    );
    let texture = |name| node(&scene, name).texture.clone();
    let bump = |name| node(&scene, name).bump.clone();
    assert!(texture("plain").is_none() && bump("plain").is_none());
    assert!(is_the_image(&texture("both").unwrap()) && bump("both").is_none());
    assert_eq!(bump("file"), texture("file").map(Bump::Image));
    assert!(texture("back").is_none() && bump("back").is_none());
}

#[test]
fn one_image_is_loaded_once() {
    let scene = with_image(
        "local t = gr.texture('a.png')
         gr.texture_material(t, {0,0,0}, 1)
         gr.texture_material('a.png', {0,0,0}, 1)
         gr.bump_material('../d/a.png', {0,0,0}, {0,0,0}, 1, 0, 0, -1, 1)
         gr.sphere('s'):set_texture('./a.png')
         gr.background{image='a.png'}",
    );
    let materials = &scene.graph.materials;
    let first = materials[0].texture.as_ref().unwrap();
    let Some(Bump::Image(bump)) = &materials[2].bump else { panic!("no bump map") };
    let others = [
        materials[1].texture.as_ref(),
        materials[2].texture.as_ref(),
        Some(bump),
        node(&scene, "s").texture.as_ref(),
        scene.background.image.as_ref(),
    ];
    assert!(others.into_iter().all(|other| Arc::ptr_eq(first, other.unwrap())));
}

#[test]
fn noise_is_the_shaders_own() {
    assert!(perlin_noise(Vec3::new(0.3, -1.7, 2.25)) != 0.0, "nothing to compare");
    let expected = perlin_noise(Vec3::new(0.3, -1.7, 2.25));
    only_scene(&format!(
        "local n = gr.noise(0.3, -1.7, 2.25)
         assert(math.type(n) == 'float' and n == {expected:?}, n)
         assert(gr.noise(4, 5, 6) == 0)
         root = gr.node('root') {RENDER}",
        expected = f64::from(expected)
    ));
}

#[test]
fn the_frame_by_both_names() {
    let mut sandbox = Sandbox::new();
    sandbox.options = ScriptOptions { frame: 12, ..ScriptOptions::default() };
    assert!(sandbox.run("assert(gr.frame() == 12 and gr.frame_cmd() == 12)").is_ok());
}

#[test]
fn lights_with_an_extent() {
    let extent = LightExtent::Parallelogram { u: DVec3::new(2.0, 0.0, 0.0), v: DVec3::new(0.0, 1.0, 3.0) };
    let area = Light {
        position: DVec3::new(1.0, 2.0, 3.0),
        colour: Vec3::new(0.5, 0.25, 1.0),
        falloff: Vec3::new(1.0, 0.0, 0.5),
        extent,
        visible: true,
    };
    let start = "position={1,2,3}, colour={0.5,0.25,1}, falloff={1,0,0.5}";
    assert_eq!(light(&format!("gr.area_light{{{start}, u={{2,0,0}}, v={{0,1,3}}, visible=true}}")), area);
    assert_eq!(light("gr.area_light({1,2,3}, {0.5,0.25,1}, {1,0,0.5}, {2,0,0}, {0,1,3}, true)"), area);
    assert_eq!(
        light("gr.area_light({1,2,3}, {0.5,0.25,1}, {1,0,0.5}, {2,0,0}, {0,1,3})"),
        Light { visible: false, ..area }
    );

    let sphere = Light { extent: LightExtent::Sphere { radius: 0.75 }, visible: false, ..area };
    assert_eq!(light(&format!("gr.sphere_light{{{start}, radius=0.75}}")), sphere);
    assert_eq!(light("gr.sphere_light({1,2,3}, {0.5,0.25,1}, {1,0,0.5}, 0.75)"), sphere);
    assert_eq!(
        light("gr.sphere_light({1,2,3}, {0.5,0.25,1}, {1,0,0.5}, 0.75, true)"),
        Light { visible: true, ..sphere }
    );

    let classic = Light { extent: LightExtent::Classic, ..sphere };
    assert_eq!(light(&format!("gr.light{{{start}}}")), classic);
    assert_eq!(light("gr.light({1,2,3}, {0.5,0.25,1}, {1,0,0.5})"), classic);
    let usual = light("gr.light{position={1,2,3}}");
    assert_eq!(usual, Light { colour: Vec3::ONE, falloff: Vec3::X, ..classic });
    assert_eq!(light("gr.light{position={1,2,3}, color={0.5,0.25,1}}").colour, area.colour);
}

#[test]
fn backgrounds() {
    let usual = Background::default();
    let grey = Vec3::splat(0.5);
    let flat = Background { bottom: grey, top: grey, ..usual.clone() };
    assert_eq!(background(""), usual);
    assert_eq!(background("gr.background{colour={0.5,0.5,0.5}}"), flat);
    assert_eq!(background("gr.background{color={0.5,0.5,0.5}}"), flat);
    assert_eq!(background("gr.background({0.5,0.5,0.5})"), flat);
    assert_eq!(background("gr.background{bottom={0.5,0.5,0.5}}"), Background { bottom: grey, ..usual.clone() });
    let gradient = Background { bottom: Vec3::ZERO, top: grey, ..usual.clone() };
    assert_eq!(background("gr.background{bottom={0,0,0}, top={0.5,0.5,0.5}}"), gradient);
    let transparent = Background { transparent: true, ..usual.clone() };
    assert_eq!(background("gr.background('transparent')"), transparent);
    assert_eq!(background("gr.background{transparent=true}"), transparent);
    assert_eq!(
        background("gr.background{colour={0.5,0.5,0.5}, transparent=true}"),
        Background { transparent: true, ..flat }
    );
    // Each call starts anew.
    assert_eq!(background("gr.background('transparent') gr.background{}"), usual);
    for script in ["gr.background{image='a.png'}", "gr.background(gr.texture('a.png'))"] {
        assert!(is_the_image(&background(script).image.unwrap()), "{script}");
    }
}

#[test]
fn a_background_holds_for_the_pictures_that_follow() {
    let script = format!("root = gr.node('root') {RENDER} gr.background('transparent') {RENDER} {RENDER}");
    let scenes = Sandbox::new().load(&script).unwrap();
    let transparent: Vec<bool> = scenes.iter().map(|scene| scene.background.transparent).collect();
    assert_eq!(transparent, [false, true, true]);
}

#[test]
fn bad_values_name_the_argument_or_the_key() {
    let kd = "{1,1,1}, {0,0,0}, 1";
    let cases = [
        (
            "gr.texture_material()",
            "gr.texture_material: argument 1: expected a texture or the name of an image, got nil",
        ),
        (
            "gr.texture_material(5, {0,0,0}, 1)",
            "gr.texture_material: argument 1: expected a texture or the name of an image, got 5",
        ),
        (
            "gr.texture_material('a.png', {0,0,0}, 1, 1, -0.5)",
            "gr.texture_material: argument 5: expected the edge of the glossy square, at least 0, got -0.5",
        ),
        (
            "gr.texture_material('a.png', {0,0,0}, 1, 1, 0, 0)",
            "gr.texture_material: argument 6: expected a refractive index above 0, or -1 for none, got 0",
        ),
        (
            "gr.bump_material('a.png', KD, 0, 0, -1)",
            "gr.bump_material: argument 8: expected POS to be 1 (diffuse colour from the image) or 2 (from argument 2), got nil",
        ),
        (
            "gr.bump_material('a.png', KD, 0, 0, -1, 3)",
            "gr.bump_material: argument 8: expected POS to be 1 (diffuse colour from the image) or 2 (from argument 2), got 3",
        ),
        (
            "gr.bump_material('a.png', KD, 0, -1, -1, 1)",
            "gr.bump_material: argument 6: expected the edge of the glossy square, at least 0, got -1",
        ),
        (
            "gr.perlin_bump_material(KD, 0, 0, -1)",
            "gr.perlin_bump_material: argument 7: expected a height in the noise, a number, got nil",
        ),
        (
            "gr.perlin_bump_material(KD, -1, 0, -1, 1)",
            "gr.perlin_bump_material: argument 4: expected a reflectance of at least 0, got -1",
        ),
        (
            "gr.volumetric_material(KD)",
            "gr.volumetric_material: argument 4: expected a density above 0 and at most 1, got nil",
        ),
        (
            "gr.volumetric_material(KD, 0)",
            "gr.volumetric_material: argument 4: expected a density above 0 and at most 1, got 0",
        ),
        (
            "gr.volumetric_material(KD, 2)",
            "gr.volumetric_material: argument 4: expected a density above 0 and at most 1, got 2",
        ),
        (
            "gr.volumetric_material(KD, -1)",
            "gr.volumetric_material: argument 4: expected a density above 0 and at most 1, got -1",
        ),
        ("gr.texture({})", "gr.texture: argument 1: expected a texture or the name of an image, got an empty table"),
        (
            "gr.node('n'):set_texture(gr.texture('a.png'))",
            "gr.set_texture: 'n' has no shape that could have a texture; set it on the shapes",
        ),
        (
            "gr.node('n'):set_bump(gr.texture('a.png'))",
            "gr.set_bump: 'n' has no shape that could have a bump map; set it on the shapes",
        ),
        ("gr.cube('n'):set_bump(1)", "gr.set_bump: argument 1: expected a texture or the name of an image, got 1"),
        (
            "gr.cube('n'):set_material(gr.texture('a.png'))",
            "gr.set_material: argument 1: expected a material, got a texture",
        ),
        ("gr.noise(1, 2)", "gr.noise: argument 3: expected a number, got nil"),
        (
            "gr.area_light{position={0,0,0}, u={1,0,0}}",
            "gr.area_light: key 'v': expected a table of 3 numbers, got nil",
        ),
        (
            "gr.area_light({0,0,0},{1,1,1},{1,0,0},{1,0,0},{2,0,0})",
            "gr.area_light: argument 5: expected an edge {x, y, z} that spans an area with u, got a table of 3 values",
        ),
        (
            "gr.area_light{position={0,0,0}, u={1,0,0}, v={0,0,1}, visible=1}",
            "gr.area_light: key 'visible': expected true or false, got 1",
        ),
        (
            "gr.sphere_light{position={0,0,0}, radius=0}",
            "gr.sphere_light: key 'radius': expected a radius above 0, got 0",
        ),
        ("gr.sphere_light{radius=1}", "gr.sphere_light: key 'position': expected a table of 3 numbers, got nil"),
        (
            "gr.light{position={0,0,0}, falloff={0,0,0}}",
            "gr.light: key 'falloff': expected attenuation {c0, c1, c2}, none below 0 and one above, got a table of 3 values",
        ),
        (
            "gr.light{position={0,0,0}, visible=true}",
            "gr.light: unknown key 'visible'; known are 'position', 'colour', 'falloff'",
        ),
        (
            "gr.background('transparant')",
            "gr.background: argument 1: expected a table such as {colour={r, g, b}}, a colour, a texture or \"transparent\", got the text 'transparant'",
        ),
        (
            "gr.background()",
            "gr.background: argument 1: expected a table such as {colour={r, g, b}}, a colour, a texture or \"transparent\", got nil",
        ),
        ("gr.background{1, 1}", "gr.background: argument 1: expected a table of 3 numbers, got 2 values"),
        ("gr.background{color={1,1,1}, colour={1,1,1}}", "gr.background: key 'colour' is given in two spellings"),
        ("gr.background{colour={1,1,1}, top={1,1,1}}", "gr.background: key 'top': cannot stand together with 'colour'"),
        (
            "gr.background{bottom={1,1,1}, image='a.png'}",
            "gr.background: key 'image': cannot stand together with 'bottom'",
        ),
        ("gr.background{imgae='a.png'}", "gr.background: unknown key 'imgae'; did you mean 'image'?"),
    ];
    for (line, expected) in cases {
        let got = with_image_message(&format!("\n\n{}", line.replace("KD", kd)));
        assert_eq!(got, format!("scene.lua:3: {expected}"), "{line}");
    }
}

#[test]
fn bad_images_name_the_place_and_the_file() {
    let sandbox = Sandbox::new();
    sandbox.write("cut.png", &png()[..40]);
    sandbox.write("text.png", "this is text");
    sandbox.write("empty.png", "");
    // A picture of 2³¹ − 1 by 2³¹ − 1 pixels in 42 bytes.
    let bomb =
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\x02\0\0\0\x9b\xab\x9c\x31\0\0\0\x01IDAT\0";
    sandbox.write("bomb.png", bomb);
    let mut huge = b"P6 16384 16384 255\n".to_vec();
    huge.extend([0; 99]);
    sandbox.write("huge.ppm", huge);
    let failure = |line: &str| sandbox.failure(&format!("\n{line}")).0;
    insta::assert_snapshot!(failure("gr.texture('cut.png')"), @"scene.lua:2: gr.texture: argument 1: cut.png: the PNG data end too early");
    insta::assert_snapshot!(failure("gr.material{bump='text.png'}"), @"scene.lua:2: gr.material: key 'bump': text.png: this is no image of a known kind; expected PNG, JPEG, BMP, TGA, GIF, WebP, QOI, PNM, HDR or EXR");
    insta::assert_snapshot!(failure("gr.background{image='empty.png'}"), @"scene.lua:2: gr.background: key 'image': empty.png: the file is empty");
    insta::assert_snapshot!(failure("gr.sphere('s'):set_texture('bomb.png')"), @"scene.lua:2: gr.set_texture: argument 1: bomb.png: decoding it takes more than 512 MiB");
    insta::assert_snapshot!(failure("gr.texture_material('huge.ppm', {0,0,0}, 1)"), @"scene.lua:2: gr.texture_material: argument 1: huge.ppm: it is 16384 x 16384 pixels, which take 1024 MiB, more than 512 MiB");
    let missing = failure("gr.texture('gone.png')");
    assert!(
        missing.starts_with("scene.lua:2: gr.texture: argument 1: cannot find 'gone.png'; looked for "),
        "{missing}"
    );
}

#[test]
fn images_count_towards_the_scripts_memory() {
    let mut sandbox = Sandbox::new();
    sandbox.options.memory_limit = 8 << 20;
    let mut picture = b"P5 2048 2048 255\n".to_vec();
    picture.resize(picture.len() + 2048 * 2048, 128);
    sandbox.write("a.pgm", picture);
    let (message, _) = sandbox.failure("\npcall(gr.texture, 'a.pgm')");
    assert_eq!(message, "scene.lua:2: the script needs more than 8 MiB of memory and was ended");
}

#[test]
fn mist_with_a_surface_is_warned_of() {
    let sandbox = Sandbox::new();
    let summary = sandbox.run("gr.material{density=0.5, ior=1.5, reflection=1, diffuse={1,1,1}}").unwrap();
    let warnings: Vec<String> = summary.warnings.iter().map(|warning| sandbox.shorten(warning)).collect();
    assert_eq!(
        warnings,
        [
            "scene.lua:1: gr.material: with 'density' the shape is mist and has no surface; 'reflection', 'ior' does nothing"
        ]
    );
    let others = "gr.material{density=0.5, texture=gr.texture('a.png'), casts_shadow=true}";
    sandbox.write("a.png", include_bytes!("../../assets/dimples.png"));
    let summary = sandbox.run(others).unwrap();
    assert!(summary.warnings[0].ends_with("'texture', 'casts_shadow' does nothing"), "{:?}", summary.warnings);
    for (calls, warned) in [
        ("s:set_material(mist) s:set_texture(gr.texture('a.png'))", true),
        ("s:set_texture(gr.texture('a.png')) s:set_material(mist)", true),
        ("s:set_texture(gr.texture('a.png')) s:set_material(gr.material{})", false),
    ] {
        let script = format!("local s, mist = gr.sphere('fog'), gr.material{{density=0.5}} {calls}");
        let warnings = sandbox.run(&script).unwrap().warnings;
        let expected = "'fog' is mist, which has no surface: its texture does nothing";
        assert_eq!(warnings.iter().any(|warning| warning.ends_with(expected)), warned, "{calls}: {warnings:?}");
        assert_eq!(warnings.len(), usize::from(warned));
    }
    assert_eq!(sandbox.run("gr.material{density=0.5, diffuse={1,1,1}}").unwrap().warnings, [""; 0]);
    assert!(message("gr.material{density=0.5, bump='gone.png'}").contains("cannot find 'gone.png'"));
}
