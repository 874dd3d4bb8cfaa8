//! `gr.render`, materials, lights, conventions.

use super::{RENDER, Sandbox, message, node, only_scene};
use glam::{DVec3, Vec3};
use gpu_trace::Error;
use gpu_trace::scene::{LightExtent, PixelOrigin, Specular, Transfer};
use gpu_trace::script::{ConventionOverrides, ScriptOptions, TransformOrder, ViewConvention, run_scene};
use std::path::PathBuf;

#[test]
fn everything_that_render_is_told_is_in_the_scene() {
    let scene = only_scene(
        "local root = gr.node('root')
         local light = gr.light({1, 2, 3}, {0.5, -0.25, 1}, {1, 0, 0.5})
         gr.render(root, 'out/picture.png', 320.9, 240, {0, 0, 5}, {0, 3, 1}, {0, 2, 0}, 40, {0.1, 0.2, 0.3},
                   {light, light}, 3, 4, 5, 2, 0.25)",
    );
    assert_eq!(scene.graph.node(scene.root).name, "root");
    assert_eq!(scene.output, PathBuf::from("out/picture.png"));
    assert_eq!(scene.size, [320, 240]);
    assert_eq!(scene.camera.eye, DVec3::new(0.0, 0.0, 5.0));
    assert!((scene.camera.forward - DVec3::new(0.0, 0.6, -0.8)).length() < 1e-15);
    assert_eq!(scene.camera.up, DVec3::new(0.0, 2.0, 0.0));
    assert_eq!((scene.camera.fov, scene.camera.lens_edge, scene.camera.focus_distance), (40.0, 0.25, 5.0));
    assert_eq!(scene.ambient, Vec3::new(0.1, 0.2, 0.3));
    assert_eq!(scene.lights.len(), 2);
    assert_eq!(scene.lights[0].position, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(scene.lights[0].colour, Vec3::new(0.5, -0.25, 1.0));
    assert_eq!(scene.lights[0].falloff, Vec3::new(1.0, 0.0, 0.5));
    assert_eq!(scene.lights[0].extent, LightExtent::Classic);
    assert_eq!((scene.sampling.camera, scene.sampling.glossy, scene.sampling.shadow), (18, 4, 5));
    assert_eq!(scene.transfer, Transfer::Linear);
}

#[test]
fn the_counts_default_to_one_and_no_lens() {
    let scene = only_scene(&format!("root = gr.node('root') {RENDER}"));
    assert_eq!((scene.sampling.camera, scene.sampling.glossy, scene.sampling.shadow), (1, 1, 1));
    assert_eq!(scene.camera.lens_edge, 0.0);
    // With one depth-of-field sample the lens is off.
    let off =
        only_scene("gr.render(gr.node('r'), 'a', 1, 1, {0,0,0}, {0,0,-1}, {0,1,0}, 50, {0,0,0}, {}, 2, 1, 1, 1, 9)");
    assert_eq!((off.sampling.camera, off.camera.lens_edge), (4, 0.0));
}

#[test]
fn view_is_a_direction_on_request() {
    let script = "gr.conventions{view='direction'}
        gr.render(gr.node('r'), 'a', 1, 1, {0,0,5}, {0,0,-4}, {0,1,0}, 50, {0,0,0}, {})";
    let scene = only_scene(script);
    assert_eq!(scene.camera.forward, DVec3::NEG_Z);
    assert_eq!(scene.camera.focus_distance, 4.0);
    let point = only_scene("gr.render(gr.node('r'), 'a', 1, 1, {0,0,5}, {0,0,-4}, {0,1,0}, 50, {0,0,0}, {})");
    assert_eq!(point.camera.focus_distance, 9.0);
}

#[test]
fn rendering_conventions_reach_the_scene() {
    let plain = only_scene(&format!("root = gr.node('root') {RENDER}"));
    assert_eq!((plain.conventions.specular, plain.conventions.sample), (Specular::Phong, PixelOrigin::Centre));
    let switched =
        only_scene(&format!("gr.conventions{{specular='blinn', sample='corner'}} root = gr.node('root') {RENDER}"));
    assert_eq!((switched.conventions.specular, switched.conventions.sample), (Specular::Blinn, PixelOrigin::Corner));
}

#[test]
fn conventions_parse_and_say_what_they_know() {
    let all: ConventionOverrides = "view=direction, transforms=post,specular=blinn,sample=corner".parse().unwrap();
    assert_eq!(all.view, Some(ViewConvention::Direction));
    assert_eq!(all.transforms, Some(TransformOrder::Post));
    assert_eq!(all.specular, Some(Specular::Blinn));
    assert_eq!(all.sample, Some(PixelOrigin::Corner));
    assert_eq!("".parse::<ConventionOverrides>().unwrap(), ConventionOverrides::default());
    let error = |text: &str| text.parse::<ConventionOverrides>().unwrap_err();
    insta::assert_snapshot!(error("veiw=point"), @"unknown convention 'veiw'; did you mean 'view'? (known: view=point|direction, transforms=pre|post, specular=phong|blinn, sample=centre|corner)");
    insta::assert_snapshot!(error("view=up"), @"view: expected 'point' or 'direction', got 'up'");
    insta::assert_snapshot!(error("view"), @"expected 'name=value' pairs with commas between, got 'view'");
    insta::assert_snapshot!(message("\ngr.conventions{view='up'}"), @"scene.lua:2: gr.conventions: argument 1: view: expected 'point' or 'direction', got 'up'");
    insta::assert_snapshot!(message("gr.conventions{'view'}"), @"scene.lua:1: gr.conventions: argument 1: expected a table such as {view=\"direction\"}, got 1 = the text 'view' in it");
}

#[test]
fn materials() {
    let scene = only_scene(&format!(
        "gr.material({{0.1, 0.2, 0.3}}, {{0.4, 0.5, 0.6}}, 7)
         gr.refl_material({{1, 1, 1}}, {{0, 0, 0}}, 0, 0.5)
         gr.refl_material({{1, 1, 1}}, {{0, 0, 0}}, 0, 0.5, 0.125, -1)
         gr.refl_material({{1, 1, 1}}, {{0, 0, 0}}, 0, 0.5, 0, 1.5)
         root = gr.node('root') {RENDER}"
    ));
    let [phong, mirror, glossy, glass] = scene.graph.materials.as_slice() else { panic!("not four materials") };
    assert_eq!((phong.diffuse, phong.specular), (Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.4, 0.5, 0.6)));
    assert_eq!((phong.shininess, phong.reflection, phong.glossy, phong.ior), (7.0, 0.0, 0.0, None));
    assert_eq!((mirror.reflection, mirror.glossy, mirror.ior), (0.5, 0.0, None));
    assert_eq!((glossy.reflection, glossy.glossy, glossy.ior), (0.5, 0.125, None));
    assert_eq!((glass.reflection, glass.glossy, glass.ior), (0.5, 0.0, Some(1.5)));
}

#[test]
fn a_shape_without_material_is_warned_of_once() {
    let sandbox = Sandbox::new();
    let summary = sandbox.run(&format!("root = gr.sphere('bare') gr.sphere('elsewhere') {RENDER}\n{RENDER}")).unwrap();
    assert_eq!(summary.pictures, 2);
    let warnings: Vec<String> = summary.warnings.iter().map(|warning| sandbox.shorten(warning)).collect();
    assert_eq!(warnings, ["scene.lua:1: 'bare' has no material and is drawn in mid-grey"]);
}

#[test]
fn several_pictures_in_order_and_the_script_goes_on() {
    let mut sandbox = Sandbox::new();
    sandbox.options = ScriptOptions { frame: 7, seed: 11, ..ScriptOptions::default() };
    let scenes = sandbox
        .load(
            "local root = gr.node('root')
             for i = 1, 3 do
               root:translate(1, 0, 0)
               gr.render(root, i .. '-' .. gr.frame_cmd() .. '.png', 8, 6, {0,0,5}, {0,0,0}, {0,1,0}, 50, {0,0,0}, {})
             end",
        )
        .unwrap();
    let outputs: Vec<_> = scenes.iter().map(|scene| scene.output.display().to_string()).collect();
    assert_eq!(outputs, ["1-7.png", "2-7.png", "3-7.png"]);
    // Each scene keeps the state of its moment.
    let places: Vec<f64> = scenes.iter().map(|scene| node(scene, "root").transform.translation.x).collect();
    assert_eq!(places, [1.0, 2.0, 3.0]);
    assert!(scenes.iter().all(|scene| scene.sampling.seed == 11));
}

#[test]
fn the_frame_of_a_plain_run_is_zero() {
    assert_eq!(only_scene(&format!("assert(gr.frame_cmd() == 0) root = gr.node('root') {RENDER}")).size, [8, 6]);
}

#[test]
fn an_error_of_the_renderer_ends_the_script_and_comes_out_unchanged() {
    let ways = [
        "RENDER",
        "while true do pcall(function() RENDER end) end",
        "while true do xpcall(function() RENDER end, function(e) RENDER return e end) end",
        "local c = coroutine.create(function() RENDER end) while true do coroutine.resume(c) end",
        "local f = coroutine.wrap(function() RENDER end) while true do pcall(f) end",
        "while true do load(function() RENDER end) end",
        "while true do pcall(pcall, function() RENDER end) end",
        "local t <close> = setmetatable({}, {__close = function() RENDER end}) RENDER",
        "for i = 1, 9 do pcall(error, setmetatable({}, {__tostring = function() RENDER end})) end pcall(function() RENDER end)",
    ];
    for way in ways {
        let sandbox = Sandbox::new();
        sandbox.write("scene.lua", format!("root = gr.node('root') {}", way.replace("RENDER", RENDER)));
        let mut calls = 0;
        let error = run_scene(&sandbox.scene(), &sandbox.options, &mut |_| {
            calls += 1;
            Err(Error::Device("the lamp is out".to_owned()))
        });
        assert!(matches!(&error, Err(Error::Device(message)) if message == "the lamp is out"), "{way}: {error:?}");
        assert_eq!(calls, 1, "{way}");
    }
}

#[test]
fn surplus_arguments_are_ignored_with_one_warning_a_function() {
    let sandbox = Sandbox::new();
    let summary = sandbox.run("gr.sphere('a', 1)\ngr.sphere('b', 2)\ngr.cube('c', nil)").unwrap();
    let warnings: Vec<String> = summary.warnings.iter().map(|warning| sandbox.shorten(warning)).collect();
    assert_eq!(
        warnings,
        ["scene.lua:1: gr.sphere takes at most 1 argument; the others are ignored (said once for each function)"]
    );
}
