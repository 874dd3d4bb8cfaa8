//! The parser against tobj, and against itself with the text cut otherwise.

use super::*;
use proptest::prelude::*;

/// Sizes of portions: a line or two, some lines, all.
const SIZES: [usize; 3] = [1, 40, usize::MAX];

/// For each corner of each triangle, its position, texture coordinate and normal: what counts, whatever the numbering.
fn corners(mesh: &Mesh) -> Vec<(Vec3, Option<Vec2>, Option<Vec3>)> {
    let corner = |&i: &u32| {
        let i = i as usize;
        (mesh.positions[i], mesh.uvs.get(i).copied(), mesh.normals.get(i).copied())
    };
    mesh.triangles.iter().flatten().map(corner).collect()
}

fn by_tobj(text: &str) -> Vec<(Vec3, Option<Vec2>, Option<Vec3>)> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| Ok(Default::default()))
        .unwrap_or_else(|error| panic!("{error} in\n{text}"));
    let of_model = |mesh: &tobj::Mesh| {
        let corner = |&i: &u32| {
            let i = i as usize;
            let uv = (!mesh.texcoords.is_empty()).then(|| Vec2::from_slice(&mesh.texcoords[2 * i..]));
            let normal = (!mesh.normals.is_empty()).then(|| Vec3::from_slice(&mesh.normals[3 * i..]));
            let unit = normal.map(|normal| normal.try_normalize().unwrap_or(Vec3::ZERO));
            (Vec3::from_slice(&mesh.positions[3 * i..]), uv, unit)
        };
        let corners: Vec<_> = mesh.indices.iter().map(corner).collect();
        let with_area = corners.chunks_exact(3).filter(|of| has_area([of[0].0, of[1].0, of[2].0]));
        with_area.flatten().copied().collect::<Vec<_>>()
    };
    models.iter().flat_map(|model| of_model(&model.mesh)).collect()
}

/// A file of random lines whose corners have this form: (texture coordinates, normals).
fn file(form: (bool, bool)) -> impl Strategy<Value = String> {
    let number = || prop_oneof![(-9..9i32).prop_map(|i| i.to_string()), (-1e3..1e3f32).prop_map(|x| format!("{x:e}"))];
    let numbers = move |keyword: &'static str, count: usize| {
        prop::collection::vec(number(), count).prop_map(move |numbers| format!("{keyword} {}", numbers.join("  ")))
    };
    let corner = (0..50usize, 0..50usize, 0..50usize, any::<bool>());
    let line = prop_oneof![
        4 => numbers("v", 3),
        1 => (numbers("v", 3), 1..9).prop_map(|(line, weight)| format!("{line} {weight}")),
        2 => numbers("vt", 2),
        2 => numbers("\tvn", 3).prop_map(|line| line + "\r"),
        1 => prop::sample::select(vec!["", "# v 1 2 3", "g a b", "s off", "l 1 2", "vp 1"]).prop_map(str::to_owned),
        4 => prop::collection::vec(corner, 1..7).prop_map(|corners| {
            let corners = corners.iter().map(|(v, vt, vn, backwards)| format!(" {v}/{vt}/{vn}/{backwards}"));
            corners.fold("f".to_owned(), |line, corner| line + &corner)
        }),
    ];
    // Each kind is there before the first face.
    let start = "v 1 2 3\nv 1 2 4\nv 3 1 5\nvt 0 1\nvn 0 1 0\n";
    prop::collection::vec(line, 1..60).prop_map(move |lines| {
        let lines = start.lines().chain(lines.iter().map(String::as_str));
        let mut counts = [0i64; 3];
        let mut text = String::new();
        for line in lines {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => counts[0] += 1,
                Some("vt") => counts[1] += 1,
                Some("vn") => counts[2] += 1,
                Some("f") => {
                    text += "f";
                    for corner in words {
                        text += &spelled(corner, counts, form);
                    }
                    text += "\n";
                    continue;
                }
                _ => {}
            }
            text += line;
            text += "\n";
        }
        text
    })
}

/// A corner among what the file has so far.
fn spelled(corner: &str, counts: [i64; 3], (texture, normal): (bool, bool)) -> String {
    let parts: Vec<&str> = corner.split('/').collect();
    let backwards = parts[3] == "true";
    let index = |kind: usize| {
        let index = parts[kind].parse::<i64>().unwrap() % counts[kind];
        (if backwards { index - counts[kind] } else { index + 1 }).to_string()
    };
    match (texture, normal) {
        (false, false) => format!(" {}", index(0)),
        (true, false) => format!(" {}/{}", index(0), index(1)),
        (false, true) => format!(" {}//{}", index(0), index(2)),
        (true, true) => format!(" {}/{}/{}", index(0), index(1), index(2)),
    }
}

proptest! {
    #[test]
    fn files_are_read_as_by_tobj(text in (any::<bool>(), any::<bool>()).prop_flat_map(file)) {
        let expected = by_tobj(&text);
        for size in SIZES {
            match parse(&text, size) {
                Ok(mesh) => prop_assert_eq!(corners(&mesh), expected.clone(), "{}", text),
                Err(message) => {
                    prop_assert_eq!(message, "there is no face with an area in it");
                    prop_assert!(expected.is_empty());
                }
            }
        }
    }

    /// Whatever the file holds, it ends in a mesh or a message, and in the same wherever it is cut.
    #[test]
    fn any_text_is_read_the_same_however_it_is_cut(text in "([vftn]{1,2}|[-0-9./]{1,4}|[ \\\\\r\n#é\u{0}]){0,80}") {
        let whole = parse(&text, usize::MAX);
        for size in SIZES {
            prop_assert_eq!(&parse(&text, size), &whole);
        }
    }
}

#[test]
fn portions_end_where_no_line_goes_on() {
    let text = "v 1\\\n2\nv \\ \n \\\n\n3\n\n\\";
    for size in 0..text.len() + 2 {
        let cut = portions(text, size);
        assert_eq!(cut.concat(), text);
        let whole: Vec<_> = lines::joined_lines(text).map(|(_, line)| line.into_owned()).collect();
        let of_portions: Vec<_> =
            cut.iter().flat_map(|text| lines::joined_lines(text)).map(|(_, line)| line.into_owned()).collect();
        assert_eq!(of_portions, whole, "{cut:?}");
    }
}

#[test]
fn the_first_bad_line_is_named_however_the_file_is_cut() {
    let text = "v 0 0 0\nv 1 \\\n0 0\nv 0 1 0\nf 1 2 3\nf 1 2 -4 # far\nf 1 2 x\nf 1 2 9\n";
    for size in SIZES {
        let message = parse(text, size).unwrap_err();
        assert_eq!(message, "line 6: the face refers to vertex -4; there are 3, counted from 1 or back from -1");
    }
}

#[test]
fn corners_of_a_kind_share_a_vertex() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n";
    let mesh = parse(text, usize::MAX).unwrap();
    assert_eq!((mesh.positions.len(), mesh.triangles), (4, vec![[0, 1, 2], [0, 2, 3]]));
}
