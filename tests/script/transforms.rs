//! Nodes: transforms in both orders, joints, instances, cycles, placed shapes.

use super::{RENDER, Sandbox, message, node, only_scene};
use glam::{DAffine3, DVec3};
use gpu_trace::scene::Shape;
use gpu_trace::script::ScriptOptions;

fn assert_close(got: DVec3, expected: DVec3) {
    assert!((got - expected).length() < 1e-12, "got {got}, expected {expected}");
}

const STEPS: &str = "root = gr.node('root')
    root:translate(1, 0, 0)
    root:scale(2, 3, 4)
    root:rotate('z', 90) ";

#[test]
fn transforms_pre_multiply_by_default() {
    let scene = only_scene(&format!("{STEPS}{RENDER}"));
    let transform = node(&scene, "root").transform;
    // Translated, scaled, then turned: (1,0,0) -> (2,0,0) -> (4,0,0) -> (0,4,0).
    assert_close(transform.transform_point3(DVec3::X), DVec3::new(0.0, 4.0, 0.0));
    assert_close(transform.transform_point3(DVec3::Y), DVec3::new(-3.0, 2.0, 0.0));
}

#[test]
fn transforms_post_multiply_on_request() {
    let scene = only_scene(&format!("gr.conventions{{transforms='post'}} {STEPS}{RENDER}"));
    // Turned, scaled, then translated: (1,0,0) -> (0,1,0) -> (0,3,0) -> (1,3,0).
    assert_close(node(&scene, "root").transform.transform_point3(DVec3::X), DVec3::new(1.0, 3.0, 0.0));
}

#[test]
fn the_order_holds_for_nodes_made_before_it_was_stated() {
    let before = only_scene(&format!("gr.conventions{{transforms='post'}} {STEPS}{RENDER}"));
    let after = only_scene(&format!("{STEPS} gr.conventions{{transforms='post'}} {RENDER}"));
    assert_eq!(node(&before, "root").transform, node(&after, "root").transform);
    assert_ne!(node(&only_scene(&format!("{STEPS}{RENDER}")), "root").transform, node(&after, "root").transform);
}

#[test]
fn the_command_line_wins_over_the_script() {
    let mut sandbox = Sandbox::new();
    let script = format!("gr.conventions{{transforms='pre'}} {STEPS}{RENDER}");
    let pre = sandbox.load(&script).unwrap().remove(0);
    sandbox.options = ScriptOptions { conventions: "transforms=post".parse().unwrap(), ..ScriptOptions::default() };
    let post = sandbox.load(&script).unwrap().remove(0);
    assert_close(node(&pre, "root").transform.transform_point3(DVec3::X), DVec3::new(0.0, 4.0, 0.0));
    assert_close(node(&post, "root").transform.transform_point3(DVec3::X), DVec3::new(1.0, 3.0, 0.0));
}

#[test]
fn rotations_are_right_handed_about_each_axis_in_either_case() {
    for (axis, from, to) in
        [("x", DVec3::Y, DVec3::Z), ("Y", DVec3::Z, DVec3::X), ("Z", DVec3::X, DVec3::Y), ("y", DVec3::X, DVec3::NEG_Z)]
    {
        let scene = only_scene(&format!("root = gr.node('root') root:rotate('{axis}', 90) {RENDER}"));
        assert_close(node(&scene, "root").transform.transform_vector3(from), to);
    }
}

#[test]
fn mirroring_is_legal() {
    let scene = only_scene(&format!("root = gr.sphere('root') root:scale(-1, 1, 1) {RENDER}"));
    assert!(node(&scene, "root").transform.matrix3.determinant() < 0.0);
}

#[test]
fn a_joint_turns_about_x_then_y_before_its_other_transforms() {
    for order in ["pre", "post"] {
        let scene = only_scene(&format!(
            "gr.conventions{{transforms='{order}'}}
             root = gr.joint('root', {{-90, 90, 180}}, {{0, 90, 90}})
             root:translate(10, 0, 0) {RENDER}"
        ));
        // x: (0,1,0) -> (0,0,1); y: (0,0,1) -> (1,0,0); then the translation.
        assert_close(node(&scene, "root").transform.transform_point3(DVec3::Y), DVec3::new(11.0, 0.0, 0.0));
    }
}

#[test]
fn one_node_under_two_parents_is_shared() {
    let scene = only_scene(&format!(
        "root = gr.node('root')
         local ball = gr.sphere('ball')
         for i = 1, 2 do
           local arm = gr.node('arm' .. i)
           arm:add_child(ball)
           root:add_child(arm)
         end
         root:add_child(ball)
         {RENDER}"
    ));
    assert_eq!(scene.graph.nodes.len(), 4);
    let ball = node(&scene, "arm1").children[0];
    assert_eq!(node(&scene, "arm2").children, [ball]);
    assert!(node(&scene, "root").children.contains(&ball));
    assert_eq!(scene.graph.node(ball).name, "ball");
}

#[test]
fn geometry_nodes_have_children_too() {
    let scene = only_scene(&format!(
        "root = gr.sphere('root') root:set_material(gr.material({{1,1,1}}, {{0,0,0}}, 1))
         root:add_child(gr.cube('moon')) {RENDER}"
    ));
    assert_eq!(node(&scene, "root").children.len(), 1);
    assert!(node(&scene, "root").geometry.is_some());
}

#[test]
fn cycles_are_refused() {
    let own = message("local a = gr.node('a')\na:add_child(a)");
    assert_eq!(
        own,
        "scene.lua:2: gr.add_child: argument 1: 'a' already has 'a' below it, or is the same node; a node cannot \
         contain itself"
    );
    let long = message(
        "local top = gr.node('top')
         local last = top
         for i = 1, 50 do local next = gr.node('n' .. i) last:add_child(next) last = next end
         last:add_child(gr.sphere('leaf'))
         last:add_child(top)",
    );
    assert!(long.starts_with("scene.lua:5: gr.add_child: argument 1: 'top' already has 'n50' below it"), "{long}");
}

#[test]
fn a_diamond_is_no_cycle() {
    let scene = only_scene(&format!(
        "root = gr.node('root') local a, b, c = gr.node('a'), gr.node('b'), gr.sphere('c')
         root:add_child(a) root:add_child(b) a:add_child(c) b:add_child(c) a:add_child(b) {RENDER}"
    ));
    assert_eq!(node(&scene, "a").children.len(), 2);
}

#[test]
fn shapes_and_their_placements() {
    let scene = only_scene(&format!(
        "root = gr.node('root')
         gr.nh_sphere('ns', {{1, 2, 3}}, 4) gr.nh_box('nb', {{-1, 0, 1}}, 2)
         gr.sphere('s') gr.cube('c') gr.cylinder('cy') gr.cone('co') gr.plane('p')
         gr.torus('t0') gr.torus('t1', 0.25) gr.torus('t2', 3, 0.5) {RENDER}"
    ));
    let geometry = |name| node(&scene, name).geometry.as_ref().unwrap();
    assert!(matches!(geometry("ns").shape, Shape::Sphere));
    assert_close(geometry("ns").placement.transform_point3(DVec3::X), DVec3::new(5.0, 2.0, 3.0));
    assert!(matches!(geometry("nb").shape, Shape::Cube));
    assert_close(geometry("nb").placement.transform_point3(DVec3::ONE), DVec3::new(1.0, 2.0, 3.0));
    assert!(matches!(geometry("s").shape, Shape::Sphere));
    assert_eq!(geometry("s").placement, DAffine3::IDENTITY);
    assert!(matches!(geometry("c").shape, Shape::Cube));
    assert!(matches!(geometry("cy").shape, Shape::Cylinder));
    assert!(matches!(geometry("co").shape, Shape::Cone));
    assert!(matches!(geometry("p").shape, Shape::Plane));
    let torus = |name| match geometry(name).shape {
        Shape::Torus { major, minor } => (major, minor),
        _ => panic!("{name} is no torus"),
    };
    assert_eq!((torus("t0"), torus("t1"), torus("t2")), ((1.0, 0.5), (1.0, 0.25), (3.0, 0.5)));
}

#[test]
fn methods_and_functions_do_the_same() {
    let methods = only_scene(&format!(
        "root = gr.node('root') local c = gr.sphere('c') root:add_child(c) c:translate(1, 2, 3) c:rotate('x', 30)
         c:set_material(gr.material({{1,0,0}}, {{0,0,0}}, 1)) {RENDER}"
    ));
    let functions = only_scene(
        "root = gr.node('root') local c = gr.sphere('c') gr.add_child(root, c) gr.translate(c, '1', '2.0', ' 0x3 ')
         gr.rotate(c, 'X', '30') gr.set_material(c, gr.material({'1',0,0}, {0,0,0}, '1'))
         root:render('a.png', '8.9', 6.5, {0,0,5}, {0,0,0}, {0,1,0}, '50', {0.1,0.1,0.1}, {})",
    );
    assert_eq!(node(&methods, "c").transform, node(&functions, "c").transform);
    assert_eq!(methods.graph.materials, functions.graph.materials);
    assert_eq!(node(&methods, "c").material, node(&functions, "c").material);
    assert_eq!(methods.size, functions.size);
    assert_eq!(methods.camera, functions.camera);
}

#[test]
fn gr_is_the_metatable_of_nodes() {
    let scene = only_scene(&format!(
        "assert(getmetatable(gr.node('x')) == gr and gr.__index == gr)
         function gr.lift(node, height) node:translate(0, height, 0) return node end
         root = gr.node('root'):lift(3) {RENDER}"
    ));
    assert_close(node(&scene, "root").transform.translation, DVec3::new(0.0, 3.0, 0.0));
}

#[test]
fn long_chains_build_in_time_from_either_end() {
    let scene = only_scene(&format!(
        "root = gr.node('root')
         local last = root
         for i = 1, 30000 do local n = gr.node(i) last:add_child(n) last = n end
         local top = gr.node('top')
         for i = 1, 30000 do local n = gr.node(i) n:add_child(top) top = n end
         root:add_child(top) {RENDER}"
    ));
    assert_eq!(scene.graph.nodes.len(), 60002);
}
