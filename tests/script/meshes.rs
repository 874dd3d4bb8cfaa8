//! OBJ files, table meshes, and the skeleton from before 2015.

use super::{RENDER, Sandbox, message};
use glam::{Vec2, Vec3};
use gpu_trace::scene::{Mesh, Shape, load_obj};
use std::sync::Arc;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn obj(content: impl AsRef<[u8]>) -> Result<Mesh, String> {
    let sandbox = Sandbox::new();
    sandbox.write("m.obj", content);
    load_obj(&sandbox.folder().join("m.obj")).map_err(|error| sandbox.shorten(&error.to_string()))
}

/// The corners of each triangle as positions: what counts, whatever the numbering.
fn corners(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|corner| mesh.positions[corner as usize])).collect()
}

fn table_mesh(script: &str) -> Arc<Mesh> {
    let scenes = Sandbox::new().load(&format!("{script} {RENDER}")).unwrap();
    match &scenes[0].graph.node(scenes[0].root).geometry.as_ref().unwrap().shape {
        Shape::Mesh(mesh) => Arc::clone(mesh),
        other => panic!("not a mesh: {other:?}"),
    }
}

#[test]
fn all_forms_of_corners_mean_the_same_faces() {
    let extra = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\n";
    let plain = obj(format!("{SQUARE}f 1 2 3\nf 1 3 4\n")).unwrap();
    for faces in [
        "f 1 2 3 4",
        "f -4 -3 -2 -1",
        "f 1/1 2/2 3/3 4/4",
        "f 1//1 2//1 3//1 4//1",
        "f 1/1/1 2/2/1 3/3/1 4/4/1",
        "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1",
        "f 1 2 3 # a comment\nf 1 3 4",
        "o one\ng two\nusemtl red\ns 1\nf 1 2 3\ng three\nf 1 3 4",
        "f 1 \\\n 2 3 4",
    ] {
        let mesh = obj(format!("{SQUARE}{extra}{faces}\n")).unwrap();
        assert_eq!(corners(&mesh), corners(&plain), "{faces}");
    }
}

#[test]
fn normals_and_texture_coordinates_are_kept() {
    let mesh = obj(format!("{SQUARE}vt 0.5 0.25\nvn 0 0 2\nf 1/1/1 2/1/1 3/1/1\n")).unwrap();
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(mesh.uvs, [Vec2::new(0.5, 0.25); 3]);
    let flat = obj(format!("{SQUARE}vn 0 0 1\nf 1 2 3\n")).unwrap();
    assert!(flat.normals.is_empty() && flat.uvs.is_empty());
}

#[test]
fn faces_without_normals_among_others_stay_flat() {
    let mesh = obj(format!("{SQUARE}vn 0 0 1\nvt 1 0\nf 1 2 3\nf 1//1 3//1 4//1\nf 2/1 3/1 4/1\n")).unwrap();
    assert_eq!(mesh.triangles.len(), 3);
    assert_eq!((mesh.normals.len(), mesh.uvs.len()), (mesh.positions.len(), mesh.positions.len()));
    let normals = |face: usize| mesh.triangles[face].map(|corner| mesh.normals[corner as usize]);
    let uvs = |face: usize| mesh.triangles[face].map(|corner| mesh.uvs[corner as usize]);
    assert_eq!((normals(0), normals(1), normals(2)), ([Vec3::ZERO; 3], [Vec3::Z; 3], [Vec3::ZERO; 3]));
    assert_eq!((uvs(0), uvs(2)), ([Vec2::ZERO; 3], [Vec2::X; 3]));
}

#[test]
fn polygons_become_fans_and_degenerate_faces_vanish() {
    let pentagon = obj("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 3 0\nv -1 1 0\nf 1 2 3 4 5\n").unwrap();
    assert_eq!(pentagon.triangles.len(), 3);
    let mesh = obj(format!("{SQUARE}v 2 0 0\nf 1 1 2\nf 1 2 5\nf 1 2\nl 1 2\np 1\nf 1 2 3\n")).unwrap();
    assert_eq!(corners(&mesh), [[Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0)]]);
}

#[test]
fn weights_colours_and_foreign_letters_are_read_over() {
    let mesh =
        obj(b"# caf\xe9\nv 2 0 0 2\nv 0 1 0 0.5 0.5 0.5\r\nv 0 0 1 # up\nmtllib none.mtl\nusemtl\nf 1 2 3\n").unwrap();
    assert_eq!(corners(&mesh), [[Vec3::X, Vec3::Y, Vec3::Z]]);
}

#[test]
fn bad_obj_files_name_the_line() {
    insta::assert_snapshot!(obj("v 0 0\n").unwrap_err(), @"m.obj: line 1: position parse error");
    insta::assert_snapshot!(obj(format!("{SQUARE}\nf 1 2 x\n")).unwrap_err(), @"m.obj: line 6: face parse error");
    insta::assert_snapshot!(obj(format!("{SQUARE}f 1 2/1 3\n")).unwrap_err(), @"m.obj: line 5: face parse error");
    insta::assert_snapshot!(obj(format!("{SQUARE}f 1 2 3\nf 1 2 9\n")).unwrap_err(), @"m.obj: line 6: the face refers to vertex 9; there are 4, counted from 1 or back from -1");
    insta::assert_snapshot!(obj(format!("{SQUARE}f 0 1 2\n")).unwrap_err(), @"m.obj: line 5: the face refers to vertex 0; there are 4, counted from 1 or back from -1");
    insta::assert_snapshot!(obj("v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n").unwrap_err(), @"m.obj: line 3: the face refers to vertex -3; there are 2, counted from 1 or back from -1");
    insta::assert_snapshot!(obj(format!("{SQUARE}vn 0 0 1\nf 1//1 2//2 3//1\n")).unwrap_err(), @"m.obj: line 6: the face refers to normal 2; there are 1, counted from 1 or back from -1");
    insta::assert_snapshot!(obj(format!("{SQUARE}vt 0 0\nf 1/0 2/1 3/1\n")).unwrap_err(), @"m.obj: line 6: the face refers to texture coordinate 0; there are 1, counted from 1 or back from -1");
    insta::assert_snapshot!(obj(SQUARE).unwrap_err(), @"m.obj: there is no face with an area in it");
    insta::assert_snapshot!(obj("").unwrap_err(), @"m.obj: there is no face with an area in it");
    insta::assert_snapshot!(obj("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap_err(), @"m.obj: it has coordinates that are not finite numbers");
    insta::assert_snapshot!(obj("\x00\x01\x02 PNG").unwrap_err(), @"m.obj: there is no face with an area in it");
    let sandbox = Sandbox::new();
    sandbox.write("m.obj", "v 0 0\n");
    assert_eq!(
        sandbox.failure("\ngr.mesh('m', 'm.obj')").0,
        "scene.lua:2: gr.mesh: argument 2: m.obj: line 1: position parse error"
    );
}

#[test]
fn table_meshes_count_from_zero() {
    let mesh = table_mesh(
        "root = gr.mesh('m', {{0,0,0}, {1,0,0}, {1,1,0}, {'0','1',0}}, {{0,1,2}, {0,2,'3'}, {0,1,2,3}, {1,1,2}})",
    );
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[3], Vec3::Y);
    assert_eq!(mesh.name, "m");
    let hexagon = table_mesh(
        "local verts, face = {}, {} for i = 0, 5 do verts[i + 1] = {math.cos(i), math.sin(i), 0} face[i + 1] = i end
         root = gr.mesh('m', verts, {face})",
    );
    assert_eq!(hexagon.triangles.len(), 4);
}

#[test]
fn bad_table_meshes_name_the_vertex_or_face() {
    let verts = "{{0,0,0}, {1,0,0}, {0,1,0}}";
    for (arguments, expected) in [
        (
            verts.to_owned(),
            "argument 3: expected a table of faces, each a table of vertex numbers counted from 0, got nil",
        ),
        (
            format!("{verts}, {{{{0,1,2}}, {{0,1,3}}}}"),
            "argument 3: face [2]: there is no vertex 3; the 3 vertices are counted from 0",
        ),
        (
            format!("{verts}, {{{{0,1,-1}}}}"),
            "argument 3: face [1]: expected a table of vertex numbers counted from 0, got -1 at [3]",
        ),
        (
            format!("{verts}, {{{{0,1,1.5}}}}"),
            "argument 3: face [1]: expected a table of vertex numbers counted from 0, got 1.5 at [3]",
        ),
        (format!("{verts}, {{{{0,1}}}}"), "argument 3: face [1]: a face needs at least 3 vertices, got 2"),
        (format!("{verts}, {{5}}"), "argument 3: face [1]: expected a table of vertex numbers counted from 0, got 5"),
        (format!("{verts}, {{}}"), "argument 3: the mesh has no face with an area"),
        (format!("{verts}, {{{{0,0,1}}}}"), "argument 3: the mesh has no face with an area"),
        ("{{0,0,0}, {1,0}}, {}".to_owned(), "argument 2: vertex [2]: expected a table of 3 numbers, got 2 values"),
        (
            "{{0,0,0}, {1,0,1/0}}, {}".to_owned(),
            "argument 2: vertex [2]: expected a table of 3 numbers, got inf at [3]",
        ),
        ("{{0,0,0}, 7}, {}".to_owned(), "argument 2: vertex [2]: expected a table of 3 numbers, got 7 at [2]"),
    ] {
        assert_eq!(message(&format!("gr.mesh('m', {arguments})")), format!("scene.lua:1: gr.mesh: {expected}"));
    }
}

const OLD: &str = "root = gr.node('root') root:translate(1, 0, 0) root:scale(2, 2, 2) ";

fn old_skeleton(script: &str) -> (f64, Vec<String>) {
    let sandbox = Sandbox::new();
    sandbox.write("t.obj", format!("{SQUARE}f 1 2 3\n"));
    let script = format!("{OLD}{script} {RENDER}");
    let x = sandbox.load(&script).unwrap()[0].graph.nodes[0].transform.translation.x;
    (x, sandbox.run(&script).unwrap().warnings.iter().map(|warning| sandbox.shorten(warning)).collect())
}

#[test]
fn the_old_skeleton_is_recognised_and_post_multiplies() {
    assert_eq!(old_skeleton("gr.mesh('m', 't.obj'):set_material(gr.material({1,1,1},{0,0,0},1))"), (2.0, vec![]));
    for sign in ["gr.mesh('m', {{0,0,0}, {1,0,0}, {0,1,0}}, {{0,1,2}})", "require('readobj')"] {
        let (x, warnings) = old_skeleton(sign);
        assert_eq!(x, 1.0, "{sign}");
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(
            warnings[0].starts_with("scene.lua:1: ") && warnings[0].contains("pre-2015 skeleton"),
            "{}",
            warnings[0]
        );
    }
    let stated = "gr.conventions{transforms='pre'} require('readobj')";
    assert_eq!(old_skeleton(stated), (2.0, vec![]));
}

#[test]
fn readobj_is_there_and_the_scenes_own_comes_first() {
    let sandbox = Sandbox::new();
    sandbox.write("t.obj", format!("{SQUARE}f 1 2 3 4\n"));
    let scenes = sandbox.load(&format!("require('readobj') root = gr.mesh('m', readobj('t.obj')) {RENDER}")).unwrap();
    match &scenes[0].graph.nodes[0].geometry.as_ref().unwrap().shape {
        Shape::Mesh(mesh) => assert_eq!(mesh.triangles.len(), 2),
        other => panic!("not a mesh: {other:?}"),
    }
    sandbox.write("readobj.lua", "function readobj() error('my own') end");
    assert_eq!(sandbox.failure("require 'readobj'\nreadobj('t.obj')").0, "readobj.lua:1: my own");
}

#[test]
fn meshes_by_keys_are_nested_or_flat() {
    let nested = table_mesh(
        "root = gr.mesh{name='m', positions={{0,0,0}, {1,0,0}, {1,1,0}, {0,1,0}}, faces={{0,1,2,3}},
         normals={{0,0,3}, {0,0,1}, {0,0,0}, {0,2,0}}, uvs={{0,0}, {1,0}, {1,1}, {0,0.25}}}",
    );
    let flat = table_mesh(
        "root = gr.mesh{name='m', positions={0,0,0, 1,0,0, 1,1,0, '0',1,0}, faces={0,1,2, 0,2,'3'},
         normals={0,0,3, 0,0,1, 0,0,0, 0,2,0}, uvs={0,0, 1,0, 1,1, 0,0.25}}",
    );
    assert_eq!(nested, flat);
    assert_eq!(flat.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(flat.positions[3], Vec3::Y);
    assert_eq!(flat.normals, [Vec3::Z, Vec3::Z, Vec3::ZERO, Vec3::Y]);
    // A mesh holds v as OBJ files do.
    assert_eq!(flat.uvs, [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.75)]);
    let sandbox = Sandbox::new();
    sandbox.write("t.obj", format!("{SQUARE}f 1 2 3\n"));
    let scenes = sandbox.load(&format!("root = gr.mesh{{name='t', file='t.obj'}} {RENDER}")).unwrap();
    let root = &scenes[0].graph.nodes[0];
    assert_eq!(root.name, "t");
    assert!(matches!(&root.geometry.as_ref().unwrap().shape, Shape::Mesh(mesh) if mesh.triangles.len() == 1));
}

#[test]
fn smooth_normals_are_weighted_by_angle() {
    // A corner of a cube, one face of which is cut in two at the corner: by area or by number it would weigh double.
    let mesh = table_mesh(
        "root = gr.mesh{smooth=true, positions={0,0,0, 1,0,0, 1,1,0, 0,1,0, 0,0,-1, 9,9,9},
         faces={0,1,2, 0,2,3, 0,4,1, 0,3,4}}",
    );
    let corner = Vec3::new(-1.0, -1.0, 1.0).normalize();
    assert!((mesh.normals[0] - corner).length() < 1e-6, "{:?}", mesh.normals);
    assert_eq!(mesh.normals[2], Vec3::Z);
    assert_eq!(mesh.normals[5], Vec3::ZERO);
}

#[test]
fn bad_meshes_by_keys_name_the_key_and_the_place() {
    let mesh = |extra: &str| format!("positions={{0,0,0, 1,0,0, 0,1,0}}, faces={{0,1,2}}{extra}");
    for (keys, expected) in [
        (mesh(", normal={}"), "unknown key 'normal'; did you mean 'normals'?"),
        (mesh(", file='a.obj'"), "cannot stand together with 'file'"),
        (mesh(", smooth=true, normals={0,0,1, 0,0,1, 0,0,1}"), "key 'smooth': cannot stand together with 'normals'"),
        (mesh(", smooth=1"), "key 'smooth': expected true or false, got 1"),
        (mesh(", normals={0,0,1}"), "key 'normals': expected one for each of the 3 vertices, got 1"),
        (mesh(", normals={{0,0,1}, {0,1}}"), "key 'normals': normal [2]: expected a table of 3 numbers, got 2 values"),
        (mesh(", uvs={0,0, 1,0, 0}"), "key 'uvs': expected 2 numbers for each uv, got 5 in all"),
        (mesh(", uvs={0,0, 1,'x'}"), "key 'uvs': expected a number at [4], got the text 'x'"),
        (
            "faces={0,1,2}".to_owned(),
            "key 'positions': expected a table of tables of 3 numbers, or of numbers, 3 for each vertex, got nil",
        ),
        ("positions={0,0,0, 1,nil,0}, faces={}".to_owned(), "key 'positions': expected a number at [5], got nil"),
        (
            "positions={0,0,0, 1,0}, faces={}".to_owned(),
            "key 'positions': expected 3 numbers for each vertex, got 5 in all",
        ),
        (
            "positions={{0,0,0}}".to_owned(),
            "key 'faces': expected a table of faces, each a table of vertex numbers counted from 0, or of such \
             numbers, 3 a triangle, got nil",
        ),
        (
            "positions={{0,0,0}}, faces={0,0,0, 0,0,1}".to_owned(),
            "key 'faces': triangle at [4] to [6]: there is no vertex 1; the 1 vertices are counted from 0",
        ),
        (
            "positions={{0,0,0}}, faces={0,0.5,0}".to_owned(),
            "key 'faces': expected a vertex number counted from 0 at [2], got 0.5",
        ),
        (
            "positions={{0,0,0}}, faces={0,0}".to_owned(),
            "key 'faces': expected 3 vertex numbers for each triangle, got 2 in all",
        ),
        (
            "positions={{0,0,0}}, faces={{0,0,0}, {0,-1,0}}".to_owned(),
            "key 'faces': face [2]: expected a table of vertex numbers counted from 0, got -1 at [2]",
        ),
        ("positions={{0,0,0}}, faces={{0,0,0}}".to_owned(), "key 'faces': the mesh has no face with an area"),
    ] {
        let got = message(&format!("gr.mesh{{{keys}}}"));
        assert!(got.starts_with("scene.lua:1: gr.mesh: ") && got.ends_with(expected), "{got}\n{expected}");
    }
}

#[test]
fn meshes_by_keys_are_no_sign_of_the_old_skeleton() {
    let script = "gr.mesh{positions={0,0,0, 1,0,0, 0,1,0}, faces={0,1,2}}";
    assert_eq!(old_skeleton(script), (2.0, vec![]));
}

#[test]
fn a_mesh_may_be_shared_under_another_material() {
    let script = "local a = gr.mesh{positions={0,0,0, 1,0,0, 0,1,0}, faces={0,1,2}}
                  root = gr.node('n') root:add_child(a) root:add_child(gr.mesh{name='b', same_as=a})";
    let scenes = Sandbox::new().load(&format!("{script} {RENDER}")).unwrap();
    let nodes = scenes[0].graph.nodes.iter().filter_map(|node| node.geometry.as_ref());
    let meshes: Vec<_> = nodes
        .filter_map(|geometry| match &geometry.shape {
            Shape::Mesh(mesh) => Some(Arc::as_ptr(mesh)),
            _ => None,
        })
        .collect();
    assert_eq!(meshes.len(), 2);
    assert_eq!(meshes[0], meshes[1]);
    for (arguments, expected) in [
        ("{same_as=gr.sphere('s')}", "key 'same_as': expected a node with a mesh"),
        ("{same_as=3}", "key 'same_as': expected a node, got 3"),
        ("{same_as=gr.sphere('s'), faces={0,1,2}}", "cannot stand together with"),
    ] {
        let text = message(&format!("gr.mesh{arguments}"));
        assert!(text.contains("scene.lua:1: gr.mesh: ") && text.contains(expected), "{text}");
    }
}
