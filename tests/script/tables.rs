//! The forms with named values: their defaults, that they give what the positional forms give, and their errors.

use super::{Sandbox, message, only_scene};
use glam::{DVec3, Vec3};
use gpu_trace::scene::{Background, Bump, Camera, Material, Sampling, Scene, Transfer};
use gpu_trace::script::ScriptOptions;
use std::path::PathBuf;

fn assert_same_picture(a: &Scene, b: &Scene) {
    assert_eq!(a.camera, b.camera);
    assert_eq!(a.ambient, b.ambient);
    assert_eq!(a.lights, b.lights);
    assert_eq!(a.background, b.background);
    assert_eq!(a.sampling, b.sampling);
    assert_eq!(a.conventions, b.conventions);
    assert_eq!((&a.output, a.size, a.transfer), (&b.output, b.size, b.transfer));
    assert_eq!((a.root, &a.graph.materials), (b.root, &b.graph.materials));
}

/// The two pictures of a script that renders twice.
fn two_pictures(script: &str) -> [Scene; 2] {
    Sandbox::new().load(script).unwrap().try_into().unwrap()
}

const START: &str = "local n = gr.node('root') local l = gr.light({1,2,3}, {1,1,1}, {1,0,0})\n";

#[test]
fn both_forms_of_render_give_the_same_picture() {
    let [positional, table] = two_pictures(&format!(
        "{START}
         gr.render(n, 'a.png', 320.5, '240', {{1,2,3}}, {{0,1,0}}, {{0,2,0}}, 40, {{0.1,0.2,0.3}}, {{l}}, 3, 4, 5, 2, 0.25)
         gr.render{{
           scene=n, output='a.png', size={{320.5,'240'}}, ambient={{0.1,0.2,0.3}}, lights={{l}},
           camera={{eye={{1,2,3}}, look_at={{0,1,0}}, up={{0,2,0}}, fov=40, lens=0.25}},
           samples=18, glossy=4, shadow=5
         }}"
    ));
    assert_same_picture(&positional, &table);
    assert_eq!((table.sampling.camera, table.size, table.camera.lens_edge), (18, [320, 240], 0.25));

    let [direction, table] = two_pictures(&format!(
        "{START} gr.conventions{{view='direction'}}
         gr.render(n, 'a.png', 640, 480, {{1,2,3}}, {{0,0,-2}}, {{0,1,0}}, 50, {{0,0,0}}, {{}})
         gr.render{{scene=n, output='a.png', camera={{eye={{1,2,3}}, direction={{0,0,-2}}}}}}"
    ));
    assert_same_picture(&direction, &table);
    assert_eq!(table.camera.focus_distance, 2.0);
}

#[test]
fn look_at_is_a_point_under_either_convention() {
    let script = "gr.conventions{view='direction'}
        gr.render{scene=gr.node('n'), output='a.png', camera={eye={0,0,5}, look_at={0,0,-4}}}";
    assert_eq!(only_scene(script).camera.focus_distance, 9.0);
}

#[test]
fn the_defaults_of_render() {
    let mut sandbox = Sandbox::new();
    sandbox.options = ScriptOptions { seed: 5, ..ScriptOptions::default() };
    let scene = sandbox.load("gr.render{scene=gr.node('n'), output='a.png'}").unwrap().remove(0);
    let camera = Camera {
        eye: DVec3::new(0.0, 0.0, 5.0),
        forward: DVec3::NEG_Z,
        up: DVec3::Y,
        fov: 50.0,
        lens_edge: 0.0,
        focus_distance: 5.0,
    };
    assert_eq!(scene.camera, camera);
    assert_eq!((scene.output, scene.size, scene.transfer), (PathBuf::from("a.png"), [640, 480], Transfer::Linear));
    assert_eq!((scene.ambient, scene.lights.len()), (Vec3::ZERO, 0));
    assert_eq!(scene.sampling, Sampling { camera: 1, shadow: 1, glossy: 1, max_depth: 8, seed: 5 });
    assert_eq!(scene.background, Background::default());
}

#[test]
fn what_the_table_alone_can_say() {
    let scene = only_scene(
        "gr.render{scene=gr.node('n'), output='a.png', camera={focus=3, lens=0.5}, samples=7, max_depth=0, seed=4294967295,
                   transfer='srgb', background={colour={0,0.5,1}, transparent=true}}",
    );
    assert_eq!((scene.camera.focus_distance, scene.camera.lens_edge), (3.0, 0.5));
    assert_eq!(scene.sampling, Sampling { camera: 7, shadow: 1, glossy: 1, max_depth: 0, seed: u32::MAX });
    assert_eq!(scene.transfer, Transfer::Srgb);
    let blue = Vec3::new(0.0, 0.5, 1.0);
    assert_eq!(scene.background, Background { bottom: blue, top: blue, image: None, transparent: true });
    // The picture's own background is for that picture.
    let [own, next] = two_pictures(
        "local n = gr.node('n') gr.background{1,1,1}
         gr.render{scene=n, output='a.png', background='transparent'}
         gr.render{scene=n, output='a.png'}",
    );
    assert!(own.background.transparent && !next.background.transparent);
    assert_eq!(next.background.top, Vec3::ONE);
    assert_eq!(own.background.top, Background::default().top);
}

#[test]
fn both_forms_of_material_are_the_same() {
    let render = "gr.render{scene=gr.node('n'), output='a.png'}";
    let scene = only_scene(&format!(
        "gr.material({{0.1,0.2,0.3}}, {{0.4,0.5,0.6}}, 7)
         gr.material{{diffuse={{0.1,0.2,0.3}}, specular={{0.4,0.5,0.6}}, shininess=7}}
         gr.refl_material({{0.1,0.2,0.3}}, {{0.4,0.5,0.6}}, 7, 0.5, 0.25, 1.5)
         gr.material{{diffuse={{0.1,0.2,0.3}}, specular={{0.4,0.5,0.6}}, shininess=7, reflection=0.5, glossy=0.25, ior=1.5}}
         gr.perlin_bump_material({{0.1,0.2,0.3}}, {{0.4,0.5,0.6}}, 7, 0.5, 0, -1, 3)
         gr.material{{diffuse={{0.1,0.2,0.3}}, specular={{0.4,0.5,0.6}}, shininess=7, reflection=0.5, noise=3}}
         gr.volumetric_material({{0.1,0.2,0.3}}, {{0.4,0.5,0.6}}, 7, 0.5)
         gr.material{{diffuse={{0.1,0.2,0.3}}, specular={{0.4,0.5,0.6}}, shininess=7, density=0.5}}
         {render}"
    ));
    let materials = &scene.graph.materials;
    assert_eq!(materials.len(), 8);
    for pair in materials.chunks(2) {
        assert_eq!(pair[0], pair[1]);
    }
    assert_eq!(materials[5].bump, Some(Bump::Noise { z: 3.0 }));
    assert!(materials.iter().step_by(2).zip(materials.iter().step_by(2).skip(1)).all(|(a, b)| a != b));

    let usual =
        only_scene(&format!("gr.material{{}} gr.material{{emission={{1,2,3}}, casts_shadow=false}} {render}")).graph;
    let glowing = Material { emission: Vec3::new(1.0, 2.0, 3.0), casts_shadow: false, ..Material::default() };
    assert_eq!(usual.materials, [Material::default(), glowing]);
}

#[test]
fn bad_keys_and_values_are_named() {
    let render = "gr.render{scene=gr.node('n'), output='a.png', ";
    let cases = [
        ("gr.material{shinines=3}", "gr.material: unknown key 'shinines'; did you mean 'shininess'?"),
        ("gr.material{difuse={1,1,1}, zzz=1}", "gr.material: unknown key 'difuse'; did you mean 'diffuse'?"),
        (
            "gr.material{wavelength=3}",
            "gr.material: unknown key 'wavelength'; known are 'diffuse', 'specular', 'shininess', 'reflection', 'glossy', \
             'ior', 'texture', 'bump', 'noise', 'density', 'emission', 'casts_shadow'",
        ),
        (
            "gr.material{shininess='hard'}",
            "gr.material: key 'shininess': expected a shininess of at least 0, got the text 'hard'",
        ),
        ("gr.material{diffuse=1}", "gr.material: key 'diffuse': expected a table of 3 numbers, got 1"),
        ("gr.material{diffuse={1,2}}", "gr.material: key 'diffuse': expected a table of 3 numbers, got 2 values"),
        (
            "gr.material{glossy=-1}",
            "gr.material: key 'glossy': expected the edge of the glossy square, at least 0, got -1",
        ),
        ("gr.material{ior=0}", "gr.material: key 'ior': expected a refractive index above 0, or -1 for none, got 0"),
        ("gr.material{density=2}", "gr.material: key 'density': expected a density above 0 and at most 1, got 2"),
        ("gr.material{noise=1, bump='a.png'}", "gr.material: key 'noise': cannot stand together with 'bump'"),
        (
            "gr.material{texture=true}",
            "gr.material: key 'texture': expected a texture or the name of an image, got true",
        ),
        ("gr.material({1,1,1})", "gr.material: argument 2: expected a table of 3 numbers, got nil"),
        (
            "gr.material({diffuse={1,1,1}}, {0,0,0}, 1)",
            "gr.material: argument 1: expected a table of 3 numbers, got 0 values",
        ),
        (
            "gr.light{{0,0,0}, colour={1,1,1}}",
            "gr.light: values in the table need names; known are 'position', 'colour', 'falloff'",
        ),
        ("gr.render{}", "gr.render: key 'scene': expected a node, got nil"),
        ("gr.render{scene=5}", "gr.render: key 'scene': expected a node, got 5"),
        ("gr.render{scene=gr.node('n')}", "gr.render: key 'output': expected the name of the picture's file, got nil"),
        (
            "RENDER size={0, 5}}",
            "gr.render: key 'size': expected a width and a height of 1 to 65535 pixels, got {0, 5}",
        ),
        ("RENDER size=5}", "gr.render: key 'size': expected a table of 2 numbers, got 5"),
        (
            "RENDER camera=5}",
            "gr.render: key 'camera': expected a table with any of eye, look_at, direction, up, fov, lens, focus, got 5",
        ),
        ("RENDER camera={eyes={0,0,0}}}", "gr.render: unknown key 'camera.eyes'; did you mean 'camera.eye'?"),
        (
            "RENDER camera={fov=180}}",
            "gr.render: key 'camera.fov': expected a vertical angle of view between 0 and 180 degrees, got 180",
        ),
        (
            "RENDER camera={eye={0,0,0}}}",
            "gr.render: key 'camera.look_at': expected a point to look at that is not the eye itself, got {0, 0, 0}",
        ),
        (
            "RENDER camera={direction={0,0,0}}}",
            "gr.render: key 'camera.direction': expected a direction of view that is not zero, got {0, 0, 0}",
        ),
        (
            "RENDER camera={direction={0,0,1}, look_at={0,0,0}}}",
            "gr.render: key 'camera.direction': cannot stand together with 'camera.look_at'",
        ),
        (
            "RENDER camera={eye={0,5,0}}}",
            "gr.render: key 'camera.up': expected an up that is not along the direction of view {0, -1, 0}, got {0, 1, 0}",
        ),
        ("RENDER camera={lens=-1}}", "gr.render: key 'camera.lens': expected the edge of the lens, at least 0, got -1"),
        ("RENDER camera={focus=0}}", "gr.render: key 'camera.focus': expected a distance above 0, got 0"),
        ("RENDER ambient='dim'}", "gr.render: key 'ambient': expected a table of 3 numbers, got the text 'dim'"),
        ("RENDER lights={3}}", "gr.render: key 'lights': expected a table of lights, got 3 at [1]"),
        ("RENDER samples=0}", "gr.render: key 'samples': expected a whole number from 1 to 16777216, got 0"),
        ("RENDER shadow=1.5}", "gr.render: key 'shadow': expected a whole number from 1 to 65535, got 1.5"),
        ("RENDER glossy=65536}", "gr.render: key 'glossy': expected a whole number from 1 to 65535, got 65536"),
        ("RENDER max_depth=-1}", "gr.render: key 'max_depth': expected a whole number from 0 to 1000, got -1"),
        (
            "RENDER seed=4294967296}",
            "gr.render: key 'seed': expected a whole number from 0 to 4294967295, got 4294967296",
        ),
        ("RENDER transfer='sRGB'}", "gr.render: key 'transfer': expected \"linear\" or \"srgb\", got the text 'sRGB'"),
        (
            "RENDER transfer='srbg'}",
            "gr.render: key 'transfer': expected \"linear\" or \"srgb\", got the text 'srbg'; did you mean \"srgb\"?",
        ),
        (
            "RENDER background={colr={1,1,1}}}",
            "gr.render: unknown key 'background.colr'; did you mean 'background.colour'?",
        ),
        ("RENDER background={colour=3}}", "gr.render: key 'background.colour': expected a table of 3 numbers, got 3"),
        (
            "RENDER dof=3}",
            "gr.render: unknown key 'dof'; known are 'scene', 'output', 'size', 'camera', 'ambient', 'lights', \
          'samples', 'shadow', 'glossy', 'max_depth', 'background', 'transfer', 'seed'",
        ),
    ];
    for (line, expected) in cases {
        let got = message(&format!("\n{}", line.replace("RENDER ", render)));
        assert_eq!(got, format!("scene.lua:2: {expected}"), "{line}");
    }
}

#[test]
fn a_table_is_read_without_its_metatable() {
    let script = "local t = setmetatable({}, {__index = {diffuse={1,1,1}}, __pairs = function() error('no') end})
        gr.material(t) gr.render{scene=gr.node('n'), output='a.png'}";
    assert_eq!(only_scene(script).graph.materials, [Material::default()]);
}
