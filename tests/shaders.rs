//! Linking and specialising the WGSL program, and where its errors are said to lie.

use gpu_trace::Error;
use gpu_trace::flatten::{FeatureSet, flatten};
use gpu_trace::gpu::probe::LOOP_PROBE;
use gpu_trace::script::{ScriptOptions, load_scene};
use gpu_trace::shader::{MemoryAccess, PARTS, Part, Program, RENDER_ENTRY_POINT};
use std::collections::BTreeSet;
use std::path::Path;

fn override_names(program: &Program) -> Vec<String> {
    program.module().overrides.iter().filter_map(|(_, o)| o.name.clone()).collect()
}

fn shader_error(parts: &[Part]) -> String {
    match Program::link(parts) {
        Err(Error::Shader(message)) => message,
        other => panic!("a shader error was expected: {other:?}"),
    }
}

/// The renderer's parts with more text at the end of one of them, and the line on which that text stands.
fn with_appended(path: &str, text: &'static str) -> (Vec<Part<'static>>, usize) {
    let mut parts = PARTS.to_vec();
    let part = parts.iter_mut().find(|part| part.path == path).expect("the part is linked");
    let line = part.text.matches('\n').count() + 1;
    part.text = format!("{}{text}", part.text).leak();
    (parts, line)
}

fn files_under(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).expect("a folder of shaders") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files_under(&path, found);
        } else {
            let root = Path::new(env!("CARGO_MANIFEST_DIR"));
            let relative = path.strip_prefix(root).expect("a path under the root");
            found.insert(relative.to_string_lossy().replace('\\', "/"));
        }
    }
}

#[test]
fn every_file_under_shaders_is_linked() {
    let mut on_disk = BTreeSet::new();
    files_under(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders"), &mut on_disk);
    let parts = MemoryAccess::ALL.map(MemoryAccess::parts).concat();
    let linked: BTreeSet<String> = parts.iter().chain([&LOOP_PROBE]).map(|part| part.path.to_owned()).collect();
    assert_eq!(on_disk, linked);
}

#[test]
fn the_program_validates_with_every_feature_alone_on_and_alone_off() {
    for access in MemoryAccess::ALL {
        let program = Program::renderer(access, &[]).unwrap();
        let names = override_names(&program);
        assert!(names.len() >= 12, "only {} overrides", names.len());
        let validate = |value: &dyn Fn(usize) -> bool| {
            let overrides: Vec<_> = names.iter().enumerate().map(|(i, name)| (name.as_str(), value(i))).collect();
            program.validate_permutation(RENDER_ENTRY_POINT, &overrides).unwrap();
        };
        validate(&|_| true);
        validate(&|_| false);
        for chosen in 0..names.len() {
            validate(&|i| i == chosen);
            validate(&|i| i != chosen);
        }
    }
}

/// Devices without integers of 64 bits or subgroups can run what they are given.
#[test]
fn only_access_by_words_keeps_to_core_webgpu() {
    Program::link(&MemoryAccess::Words.parts()).unwrap();
    for access in [MemoryAccess::Pairs, MemoryAccess::SharedPairs] {
        let message = shader_error(&access.parts());
        assert!(message.contains("SHADER_INT64"), "{message}");
    }
}

#[test]
fn the_program_does_not_depend_on_the_order_of_its_parts() {
    let mut parts = PARTS.to_vec();
    parts.reverse();
    let reversed = Program::link(&parts).unwrap();
    let program = Program::renderer(MemoryAccess::Words, &[]).unwrap();
    assert_eq!(reversed.module().functions.len(), program.module().functions.len());
    assert_eq!(reversed.module().entry_points.len(), program.module().entry_points.len());
    reversed.validate_permutation(RENDER_ENTRY_POINT, &[]).unwrap();
}

#[test]
fn the_loop_probe_validates() {
    let program = Program::link(&[LOOP_PROBE]).unwrap();
    program.validate_permutation("single_loop", &[]).unwrap();
    program.validate_permutation("nested_loops", &[]).unwrap();
}

#[test]
fn errors_name_the_part_line_and_column() {
    // A word that is no WGSL, a type that does not fit, a name that is not declared; and what only validation sees:
    // a uniform array whose elements are not 16 bytes apart.
    let cases = [
        ("shaders/types.wgsl", "nonsense", 1),
        ("shaders/geometry/hit.wgsl", "fn bad() -> f32 { return 1u; }", 26),
        ("shaders/tally.wgsl", "fn bad() -> f32 { return absent; }", 26),
        ("shaders/bindings.wgsl", "@group(0) @binding(10) var<uniform> bad: array<f32, 4>;", 24),
    ];
    for (path, text, column) in cases {
        let (parts, line) = with_appended(path, text);
        let message = shader_error(&parts);
        let place = format!("{path}:{line}:");
        assert!(message.starts_with(&place), "{place} was expected: {message}");
        let found = message[place.len()..].split(':').next().and_then(|text| text.parse::<usize>().ok());
        assert_eq!(found, Some(column), "{message}");
    }
}

#[test]
fn columns_count_characters() {
    let message = shader_error(&[Part { path: "a.wgsl", text: "/* Ørsted, Gauß */ nonsense" }]);
    assert!(message.starts_with("a.wgsl:1:20: "), "{message}");
}

#[test]
fn a_name_declared_twice_is_shown_in_both_parts() {
    let first = Part { path: "first.wgsl", text: "\nconst TWICE: u32 = 1u;" };
    let second = Part { path: "second.wgsl", text: "// a comment\n\nconst TWICE: u32 = 2u;" };
    let message = shader_error(&[first, second]);
    assert!(message.contains("first.wgsl:2:7: "), "{message}");
    assert!(message.contains("second.wgsl:3:7: "), "{message}");
}

#[test]
fn a_part_listed_twice_is_an_error() {
    let part = Part { path: "a.wgsl", text: "" };
    assert_eq!(shader_error(&[part, part]), "a.wgsl: this part is listed twice");
}

#[test]
fn a_wrong_permutation_is_rejected() {
    let text = "override HAS_A: bool = true;
override DIVIDED: u32 = 1u / select(0u, 1u, HAS_A);
@group(0) @binding(0) var<storage, read_write> out: u32;
@compute @workgroup_size(1) fn kernel() { out = DIVIDED; }";
    let program = Program::link(&[Part { path: "a.wgsl", text }]).unwrap();
    program.validate_permutation("kernel", &[("HAS_A", true)]).unwrap();
    let message = |entry_point, overrides| match program.validate_permutation(entry_point, overrides) {
        Err(Error::Shader(message)) => message,
        other => panic!("a shader error was expected: {other:?}"),
    };
    assert!(message("kernel", &[("HAS_A", false)]).contains("HAS_A = false"));
    assert!(message("kernel", &[("HAS_B", true)]).contains("HAS_B"));
    assert!(message("absent", &[]).contains("absent"));
}

#[test]
fn every_override_is_a_feature() {
    let program = Program::renderer(MemoryAccess::Words, &[]).unwrap();
    let declared: BTreeSet<String> = override_names(&program).into_iter().collect();
    let set: BTreeSet<String> = FeatureSet::ALL_ON.overrides().into_iter().map(|(name, _)| name.to_owned()).collect();
    assert_eq!(declared, set);
    assert!(FeatureSet::ALL_ON.overrides().into_iter().all(|(_, value)| value));
    assert!(FeatureSet::ALL_OFF.overrides().into_iter().all(|(_, value)| !value));
}

/// The permutations that users meet first.
#[test]
fn the_program_validates_with_the_features_of_every_scene() {
    let program = Program::renderer(MemoryAccess::Words, &[]).unwrap();
    let mut permutations = BTreeSet::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "lua") {
            let scenes = load_scene(&path, &ScriptOptions::default()).unwrap_or_else(|error| panic!("{error}"));
            for scene in scenes {
                let features = flatten(&scene).unwrap_or_else(|error| panic!("{error}")).features;
                program.validate_permutation(RENDER_ENTRY_POINT, &features.overrides()).unwrap();
                permutations.insert(features.overrides());
            }
        }
    }
    assert!(permutations.len() >= 4, "the scenes have only {} permutations", permutations.len());
}
