//! How scripts fail: the place, the message and the calls.

use super::{Sandbox, message, relative_to_working_folder};
use gpu_trace::Error;
use gpu_trace::script::{ScriptOptions, load_scene};
use std::path::Path;

#[test]
fn bad_arguments_name_the_place_the_function_and_the_argument() {
    let cases = [
        ("gr.node()", "gr.node: argument 1: expected a name, got nil"),
        ("gr.node({})", "gr.node: argument 1: expected a name, got an empty table"),
        ("gr.joint('j', {0,0}, {0,0,0})", "gr.joint: argument 2: expected a table of 3 numbers, got 2 values"),
        (
            "gr.joint('j', {0,0,0}, {0,'x',0})",
            "gr.joint: argument 3: expected a table of 3 numbers, got the text 'x' at [2]",
        ),
        ("gr.sphere(true)", "gr.sphere: argument 1: expected a name, got true"),
        ("gr.nh_sphere('s', {0,0,0}, 0)", "gr.nh_sphere: argument 3: expected a radius above 0, got 0"),
        ("gr.nh_sphere('s', {0,0,0,0}, 1)", "gr.nh_sphere: argument 2: expected a table of 3 numbers, got 4 values"),
        ("gr.nh_box('b', {0,0,0}, 0)", "gr.nh_box: argument 3: expected a size other than 0, got 0"),
        ("gr.torus('t', -1)", "gr.torus: argument 2: expected a radius above 0, got -1"),
        ("gr.torus('t', 1, 0)", "gr.torus: argument 3: expected a radius above 0, got 0"),
        ("gr.node('n'):translate(1, 2)", "gr.translate: argument 3: expected a number, got nil"),
        ("gr.translate(gr.node('n'), 1, 2)", "gr.translate: argument 4: expected a number, got nil"),
        ("gr.node('n'):translate(1, 0/0, 2)", "gr.translate: argument 2: expected a number, got NaN"),
        ("gr.node('n'):translate(1, 1e300, 2)", "gr.translate: argument 2: expected a number, got 1"),
        ("gr.node('n'):scale(1, 0, 1)", "gr.scale: argument 2: expected a factor other than 0, got 0"),
        ("gr.node('n'):rotate('w', 1)", "gr.rotate: argument 1: expected an axis 'x', 'y' or 'z', got the text 'w'"),
        ("gr.node('n'):rotate('x')", "gr.rotate: argument 2: expected an angle in degrees, got nil"),
        ("gr.node('n'):add_child(3)", "gr.add_child: argument 1: expected a node, got 3"),
        ("gr.node('n'):add_child()", "gr.add_child: argument 1: expected a node, got nil"),
        ("gr.add_child(gr.material({1,1,1},{0,0,0},1))", "gr.add_child: argument 1: expected a node, got a material"),
        (
            "gr.sphere('n'):set_material(gr.node('m'))",
            "gr.set_material: argument 1: expected a material, got the node 'm'",
        ),
        ("gr.node('n'):set_material(gr.material({1,1,1},{0,0,0},1))", "gr.set_material: 'n' has no shape"),
        ("gr.material({1,1,1}, {0,0,0}, -1)", "gr.material: argument 3: expected a shininess of at least 0, got -1"),
        ("gr.material({1,1,1}, {0,0}, 1)", "gr.material: argument 2: expected a table of 3 numbers, got 2 values"),
        ("gr.material(1, {0,0,0}, 1)", "gr.material: argument 1: expected a table of 3 numbers, got 1"),
        (
            "gr.refl_material({1,1,1}, {0,0,0}, 1, -0.5)",
            "gr.refl_material: argument 4: expected a reflectance of at least 0, got -0.5",
        ),
        (
            "gr.refl_material({1,1,1}, {0,0,0}, 1, 1, -1)",
            "gr.refl_material: argument 5: expected the edge of the glossy square, at least 0, got -1",
        ),
        (
            "gr.refl_material({1,1,1}, {0,0,0}, 1, 1, 0, 0)",
            "gr.refl_material: argument 6: expected a refractive index above 0, or -1 for none, got 0",
        ),
        (
            "gr.light({0,0,0}, {1,1,1}, {0,0,0})",
            "gr.light: argument 3: expected attenuation {c0, c1, c2}, none below 0 and one above, got a table of 3 values",
        ),
        ("gr.light({0,0}, {1,1,1}, {1,0,0})", "gr.light: argument 1: expected a table of 3 numbers, got 2 values"),
        ("gr.mesh('m', 5)", "gr.mesh: argument 2: expected the name of an OBJ file or a table of vertices, got 5"),
        (
            "gr:node('n')",
            "gr.node: called with ':' on something else: expected a name, got a table with names; write gr.node(…)",
        ),
    ];
    for (line, expected) in cases {
        let got = message(&format!("\n\n{line}"));
        assert!(got.starts_with(&format!("scene.lua:3: {expected}")), "{line}\n gave {got}");
    }
}

#[test]
fn render_checks_each_argument() {
    let good = ["n", "'f'", "8", "6", "{0,0,5}", "{0,0,0}", "{0,1,0}", "50", "{0,0,0}", "{}", "1", "1", "1", "1", "0"];
    let cases = [
        (1, "5", "expected a node, got 5"),
        (2, "''", "expected the name of the picture's file, got the text ''"),
        (3, "0.5", "expected a width of 1 to 65535 pixels, got 0.5"),
        (3, "65536", "expected a width of 1 to 65535 pixels, got 65536"),
        (4, "-1", "expected a height of 1 to 65535 pixels, got -1"),
        (5, "{0,0}", "expected a table of 3 numbers, got 2 values"),
        (6, "{0,0,5}", "expected a point to look at that is not the eye itself (or view=\"direction\"), got {0, 0, 5}"),
        (7, "{0,0,2}", "expected an up that is not along the direction of view {0, 0, -1}, got {0, 0, 2}"),
        (7, "{0,0,0}", "expected an up that is not along the direction of view {0, 0, -1}, got {0, 0, 0}"),
        (8, "180", "expected a vertical angle of view between 0 and 180 degrees, got 180"),
        (8, "0", "expected a vertical angle of view between 0 and 180 degrees, got 0"),
        (9, "nil", "expected a table of 3 numbers, got nil"),
        (10, "nil", "expected a table of lights, got nil"),
        (10, "{n}", "expected a table of lights, got the node 'n' at [1]"),
        (11, "0", "expected AA to be a whole number from 1 to 65535, got 0"),
        (12, "1.5", "expected GLOSSY to be a whole number from 1 to 65535, got 1.5"),
        (13, "'many'", "expected SHADOW to be a whole number from 1 to 65535, got the text 'many'"),
        (14, "-3", "expected DOF to be a whole number from 1 to 65535, got -3"),
        (15, "-0.5", "expected LENS, the edge of the lens, to be at least 0, got -0.5"),
    ];
    for (position, value, expected) in cases {
        let mut arguments = good;
        arguments[position - 1] = value;
        let got = message(&format!("local n = gr.node('n')\ngr.render({})", arguments.join(", ")));
        assert_eq!(got, format!("scene.lua:2: gr.render: argument {position}: {expected}"));
    }
    let many = message(&format!("local n = gr.node('n')\ngr.render({}, 5000)", good[..10].join(", ")));
    assert_eq!(many, "scene.lua:2: gr.render: AA² · DOF is more than 16777216 camera samples");
}

#[test]
fn unknown_functions_get_the_nearest_name() {
    insta::assert_snapshot!(message("\nlocal s = gr.shpere('s')"), @"scene.lua:2: gr.shpere: no such function; did you mean gr.sphere?");
    insta::assert_snapshot!(message("gr.node('n'):tranlsate(1, 2, 3)"), @"scene.lua:1: gr.tranlsate: no such function; did you mean gr.translate?");
    insta::assert_snapshot!(message("gr.material({1,1,1},{0,0,0},1):polish()"), @"scene.lua:1: gr.polish: no such function");
    insta::assert_snapshot!(message("gr.subsurface_material()"), @"scene.lua:1: gr.subsurface_material: no such function");
    insta::assert_snapshot!(message("function gr.mine() end\ngr.mine2()"), @"scene.lua:2: gr.mine2: no such function; did you mean gr.mine?");
    // A name may be asked for without calling it.
    assert!(Sandbox::new().run("if gr.hologram then error('no') end").is_ok());
    // Another table's missing function is not ours.
    insta::assert_snapshot!(message("local t = {} t.shpere()"), @"scene.lua:1: attempt to call a nil value (field 'shpere')");
}

#[test]
fn calls_are_listed_innermost_first() {
    let script = "local function leaf()
  gr.scale(5)
end
local t = {}
function t.build()
  leaf()
  return 1
end
function t:twice()
  local x = t.build()
  return x
end
t:twice()";
    let (message, calls) = Sandbox::new().failure(script);
    assert_eq!(message, "scene.lua:2: gr.scale: argument 1: expected a node, got 5");
    assert_eq!(
        calls,
        [
            "in function 'leaf' (scene.lua:2)",
            "in function 'build' (scene.lua:6)",
            "in method 'twice' (scene.lua:10)",
            "in the main chunk (scene.lua:13)"
        ]
    );
    let shown = Error::Script { message: "m".to_owned(), calls }.to_string();
    assert!(shown.starts_with("m\n  in function 'leaf' (scene.lua:2)\n"), "{shown}");
    assert_eq!(Sandbox::new().failure("error('top')"), ("scene.lua:1: top".to_owned(), Vec::new()));
}

#[test]
fn errors_of_lua_itself_are_plain() {
    insta::assert_snapshot!(message("local x = \n\nnil + 1"), @"scene.lua:3: attempt to perform arithmetic on a nil value");
    insta::assert_snapshot!(message("\nnothing.here = 1"), @"scene.lua:2: attempt to index a nil value (global 'nothing')");
    insta::assert_snapshot!(message("error('mine')"), @"scene.lua:1: mine");
    insta::assert_snapshot!(message("\nerror('bare', 0)"), @"scene.lua:2: bare");
    insta::assert_snapshot!(message("\nerror({})"), @"scene.lua:2: the script raised an error that is not text but a table");
    insta::assert_snapshot!(message("error(setmetatable({}, {__tostring = function() return 'spoken' end}))"), @"scene.lua:1: spoken");
    insta::assert_snapshot!(message("error()"), @"scene.lua:1: the script raised an error without a message");
    insta::assert_snapshot!(message("assert(false)"), @"scene.lua:1: assertion failed!");
    insta::assert_snapshot!(message("string.rep()"), @"scene.lua:1: bad argument #1 to 'rep' (string expected, got no value)");
    insta::assert_snapshot!(message("\nmath.random(0/0)"), @"scene.lua:2: bad argument #1 to 'random' (number has no integer representation)");
    insta::assert_snapshot!(message("coroutine.wrap(function()\n gr.node() end)()"), @"scene.lua:2: gr.node: argument 1: expected a name, got nil");
    insta::assert_snapshot!(message("load('x = = 1', 'part')()"), @"scene.lua:1: attempt to call a nil value");
    insta::assert_snapshot!(message("assert(load('x = = 1'))"), @"scene.lua:1: (load):1: unexpected symbol near '='");
    insta::assert_snapshot!(message("load('\\nerror(1 + nil)')()"), @"(load):2: attempt to perform arithmetic on a nil value");
}

#[test]
fn a_caught_error_is_clean_text() {
    let script = "local ok, problem = pcall(gr.node, {1})
        assert(not ok and type(problem) == 'string')
        error(problem, 0)";
    insta::assert_snapshot!(message(script), @"scene.lua:1: gr.node: argument 1: expected a name, got a table of 1 value");
    let script = "local seen
        xpcall(function() gr.node('n'):scale(0, 1, 1) end, function(problem) seen = problem end)
        error(seen, 0)";
    insta::assert_snapshot!(message(script), @"scene.lua:2: gr.scale: argument 1: expected a factor other than 0, got 0");
    assert!(Sandbox::new().run("assert(select(2, pcall(error, 12)) == 12)").is_ok());
}

#[test]
fn syntax_errors_have_a_place() {
    insta::assert_snapshot!(message("local a = 1\nlocal = 2"), @"scene.lua:2: <name> expected near '='");
    insta::assert_snapshot!(message("#!/usr/bin/env gpu-trace\nfor"), @"scene.lua:2: <name> expected near <eof>");
    insta::assert_snapshot!(message("\x1bLua"), @"scene.lua: attempt to load a binary chunk (mode is 't')");
}

#[test]
fn too_deep_recursion_is_an_error() {
    let (message, calls) = Sandbox::new().failure("local function f()\n return 1 + f()\nend\nf()");
    assert!(message.starts_with("scene.lua:2: stack overflow"), "{message}");
    assert!(calls.len() < 20, "{}", calls.len());
}

#[test]
fn a_missing_script_is_a_file_error() {
    let error = load_scene(Path::new("no/such/scene.lua"), &ScriptOptions::default()).unwrap_err();
    assert!(error.to_string().starts_with("cannot read the scene 'no/such/scene.lua': "), "{error}");
}

#[test]
fn file_names_stay_as_the_user_gave_them() {
    let folder =
        tempfile::Builder::new().prefix("gpu-trace-test-").tempdir_in(std::env::current_dir().unwrap()).unwrap();
    for name in ["s.lua", "a-name-that-is-far-longer-than-what-lua-itself-would-show-in-a-message.lua"] {
        let path = relative_to_working_folder(folder.path()).join(name);
        for script in ["\nlocal x = nil + 1", "\nlocal = 1", "\ngr.node()"] {
            std::fs::write(&path, script).unwrap();
            let message = load_scene(&path, &ScriptOptions::default()).unwrap_err().to_string();
            assert!(message.starts_with(&format!("{}:2: ", path.display())), "{message}");
        }
    }
}
