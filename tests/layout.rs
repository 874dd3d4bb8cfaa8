//! The structures that cross to the GPU: naga's view of `shaders/types.wgsl` against rustc's of `src/layout.rs`.

use gpu_trace::layout::*;
use gpu_trace::shader;
use naga::proc::Layouter;
use naga::{ArraySize, Expression, Literal, Module, ScalarKind, TypeInner};
use std::collections::BTreeSet;
use std::mem::offset_of;

/// The WGSL type that a Rust type stands for. Atomics count as what they hold.
trait Twin {
    const WGSL: &'static str;
}
macro_rules! wgsl_types {
    ($($rust:ty => $wgsl:literal),* $(,)?) => { $(impl Twin for $rust { const WGSL: &'static str = $wgsl; })* };
}
wgsl_types! {
    f32 => "f32", u32 => "u32", glam::Vec3 => "vec3<f32>", glam::Vec4 => "vec4<f32>", glam::UVec2 => "vec2<u32>",
    glam::UVec4 => "vec4<u32>", AffineRows => "mat3x4<f32>", [u32; 4] => "vec4<u32>", [u32; 256] => "array<u32, 256>",
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Field {
    name: String,
    offset: usize,
    size: usize,
    wgsl: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Struct {
    name: String,
    size: usize,
    fields: Vec<Field>,
}

fn field<S, T: Twin>(name: &str, offset: usize, _: fn(&S) -> &T) -> Field {
    Field { name: name.into(), offset, size: size_of::<T>(), wgsl: T::WGSL.into() }
}

macro_rules! rust_struct {
    ($name:ident { $($field:ident),* $(,)? }) => {{
        // Without `..`, a field that is missing here does not compile.
        let $name { $($field: _),* } = <$name as bytemuck::Zeroable>::zeroed();
        Struct {
            name: stringify!($name).into(),
            size: size_of::<$name>(),
            fields: vec![$(field(stringify!($field), offset_of!($name, $field), |s: &$name| &s.$field)),*],
        }
    }};
}

fn rust_structs() -> Vec<Struct> {
    vec![
        rust_struct!(Frame {
            eye,
            lens_edge,
            right,
            tan_half_fov,
            up,
            focus_distance,
            forward,
            aspect,
            ambient,
            seed,
            background_bottom,
            flags,
            background_top,
            max_depth,
            medium,
            image_size,
            plane_count,
            bounded_count,
            light_count,
            pass_count,
            shadow_count,
            light_samples,
            deep_light_samples,
            glossy_samples,
            mist,
            background_image,
            pixel_spread,
            mist_count,
            mist_root,
            pad0,
            pad1,
        }),
        rust_struct!(Dispatch {
            sample_index,
            sample_count,
            pass_index,
            band_row,
            band_rows,
            first_block,
            block_count,
            tile_stride,
            portions,
            takes_work,
            canary_turns,
        }),
        rust_struct!(Node { grid, children, x, y, z, unused }),
        rust_struct!(Instance { object_from_world, shape, material, root, flags, world_from_object, parameters }),
        rust_struct!(Triangle { p0, n0, p1, n1, p2, n2, uv0, uv1, uv2, flags }),
        rust_struct!(Material {
            diffuse,
            shininess,
            specular,
            reflection,
            emission,
            glossy,
            ior,
            density,
            noise_z,
            flags,
            texture,
            bump,
            medium,
            mist_step,
        }),
        rust_struct!(Light { position, kind, colour, radius, falloff, pad0, u, pad1, v, pad2 }),
        rust_struct!(FilmPixel { low, high }),
        rust_struct!(Status { flags, taken, pad1, pad2, rays }),
    ]
}

macro_rules! rust_constants {
    ($($name:ident)*) => { vec![$((stringify!($name).to_owned(), $name)),*] };
}

fn rust_constants() -> Vec<(String, u32)> {
    rust_constants![
        NONE
        FRAME_SAMPLE_CENTRE FRAME_SAMPLE_CORNER FRAME_TRANSPARENT FRAME_BLINN
        SHAPE_SPHERE SHAPE_CUBE SHAPE_CYLINDER SHAPE_CONE SHAPE_TORUS SHAPE_PLANE SHAPE_MESH
        TRIANGLE_SMOOTH
        MATERIAL_TEXTURE_REPLACES MATERIAL_NOISE_BUMP MATERIAL_MIST INSTANCE_SEEN INSTANCE_SHADES INSTANCE_MIST
        LIGHT_POINT LIGHT_PARALLELOGRAM LIGHT_SPHERE
        STATUS_LOOP_BOUND STATUS_STACK_FULL STATUS_NOT_FINITE STATUS_SATURATED STATUS_MIST_CROSSINGS
        RAY_CAMERA RAY_SHADOW RAY_REFLECTED RAY_REFRACTED RAY_KINDS RAY_SLOTS
    ]
}

fn types_module() -> Module {
    let part = shader::part("shaders/types.wgsl").expect("shaders/types.wgsl is linked");
    naga::front::wgsl::parse_str(part.text).expect("shaders/types.wgsl is valid")
}

fn wgsl_structs(module: &Module) -> Vec<Struct> {
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).expect("every type has a layout");
    let describe = |member: &naga::StructMember| Field {
        name: member.name.clone().unwrap_or_default(),
        offset: member.offset as usize,
        size: layouter[member.ty].size as usize,
        wgsl: type_name(module, member.ty),
    };
    let structs = module.types.iter().filter_map(|(_, ty)| match &ty.inner {
        TypeInner::Struct { members, span } => Some(Struct {
            name: ty.name.clone().unwrap_or_default(),
            size: *span as usize,
            fields: members.iter().map(describe).collect(),
        }),
        _ => None,
    });
    structs.collect()
}

fn type_name(module: &Module, ty: naga::Handle<naga::Type>) -> String {
    let scalar_name = |scalar: naga::Scalar| match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 4) => "f32".to_owned(),
        (ScalarKind::Uint, 4) => "u32".to_owned(),
        other => format!("{other:?}"),
    };
    match module.types[ty].inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => scalar_name(scalar),
        TypeInner::Vector { size, scalar } => format!("vec{}<{}>", size as u32, scalar_name(scalar)),
        TypeInner::Matrix { columns, rows, scalar } => {
            format!("mat{}x{}<{}>", columns as u32, rows as u32, scalar_name(scalar))
        }
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
            format!("array<{}, {count}>", type_name(module, base))
        }
        ref other => format!("{other:?}"),
    }
}

fn wgsl_constants(module: &Module) -> Vec<(String, u32)> {
    let value = |constant: &naga::Constant| match module.global_expressions[constant.init] {
        Expression::Literal(Literal::U32(value)) => value,
        ref other => panic!("{:?} is {other:?}, where a u32 literal was expected", constant.name),
    };
    let named = module.constants.iter().filter_map(|(_, c)| Some((c.name.clone()?, value(c))));
    named.collect()
}

/// Everything in which the two lists differ, in either direction.
fn differences(rust: &[Struct], wgsl: &[Struct]) -> Vec<String> {
    let mut differences = Vec::new();
    for ours in rust {
        match wgsl.iter().find(|theirs| theirs.name == ours.name) {
            None => differences.push(format!("{} is not in WGSL", ours.name)),
            Some(theirs) => {
                if ours.size != theirs.size {
                    differences.push(format!("{}: {} bytes, {} in WGSL", ours.name, ours.size, theirs.size));
                }
                for index in 0..ours.fields.len().max(theirs.fields.len()) {
                    let pair = (ours.fields.get(index), theirs.fields.get(index));
                    if pair.0 != pair.1 {
                        differences.push(format!("{}: {:?}, {:?} in WGSL", ours.name, pair.0, pair.1));
                    }
                }
            }
        }
    }
    for theirs in wgsl.iter().filter(|theirs| !rust.iter().any(|ours| ours.name == theirs.name)) {
        differences.push(format!("{} is not in Rust", theirs.name));
    }
    differences
}

/// Names after `keyword` at the starts of lines: what `src/layout.rs` declares.
fn declared(keyword: &str) -> BTreeSet<String> {
    let source = include_str!("../src/layout.rs");
    let name = |rest: &str| rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or("").to_owned();
    source.lines().filter_map(|line| line.strip_prefix(keyword)).map(name).collect()
}

#[test]
fn every_shared_structure_has_one_layout() {
    let wgsl = wgsl_structs(&types_module());
    assert!(wgsl.len() >= 9, "naga found only {} structures", wgsl.len());
    assert_eq!(differences(&rust_structs(), &wgsl), Vec::<String>::new());
}

#[test]
fn every_structure_of_layout_rs_is_compared() {
    let compared: BTreeSet<String> = rust_structs().into_iter().map(|s| s.name).collect();
    assert_eq!(declared("pub struct "), compared);
}

#[test]
fn constants_are_equal_in_both() {
    let rust: BTreeSet<_> = rust_constants().into_iter().collect();
    let wgsl: BTreeSet<_> = wgsl_constants(&types_module()).into_iter().collect();
    assert_eq!(rust, wgsl);
    assert_eq!(declared("pub const "), rust.into_iter().map(|(name, _)| name).collect());
}

#[test]
fn ray_counters_fill_their_array() {
    assert_eq!(<[u32; 256]>::WGSL, format!("array<u32, {}>", RAY_KINDS * RAY_SLOTS));
}

/// Negative control: the comparison has to see a field shifted, swapped, renamed, retyped, left out or added.
#[test]
fn the_comparison_rejects_wrong_twins() {
    let right = "struct FilmPixel { low: vec4<u32>, high: vec4<u32> }";
    let wrong = [
        "struct FilmPixel { @size(32) low: vec4<u32>, high: vec4<u32> }",
        "struct FilmPixel { high: vec4<u32>, low: vec4<u32> }",
        "struct FilmPixel { low: vec4<u32>, hi: vec4<u32> }",
        "struct FilmPixel { low: vec4<f32>, high: vec4<u32> }",
        "struct FilmPixel { low: vec4<u32> }",
        "struct FilmPixel { low: vec4<u32>, high: vec4<u32>, more: u32 }",
        "struct FilmPixels { low: vec4<u32>, high: vec4<u32> }",
    ];
    let compare = |text: &str| {
        let module = naga::front::wgsl::parse_str(text).expect("valid WGSL");
        differences(&[rust_struct!(FilmPixel { low, high })], &wgsl_structs(&module))
    };
    assert_eq!(compare(right), Vec::<String>::new());
    for text in wrong {
        assert!(!compare(text).is_empty(), "not rejected: {text}");
    }
}
