//! Joins the files under `shaders/` into one WGSL program, checks it, and says where an error lies.
//!
//! WGSL resolves names at module scope whatever their order, so the parts are simply set one after another; what is
//! kept is where each begins, so that an error names the file and line that its author wrote.

use crate::{Error, Result};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{ShaderStage, Span};
use std::error::Error as StdError;

/// One WGSL file: its path from the root of the repository, and its text.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    pub path: &'a str,
    pub text: &'a str,
}

macro_rules! parts {
    ($($path:literal)*) => {
        &[$(Part { path: concat!("shaders/", $path), text: include_str!(concat!("../shaders/", $path)) }),*]
    };
}

/// The renderer's shaders, as every device can run them. A new file is listed here and nowhere else.
pub const PARTS: &[Part<'static>] = parts![
    "types.wgsl"
    "bindings.wgsl"
    "memory/words/buffers.wgsl"
    "memory/words/nodes.wgsl"
    "memory/words/stack.wgsl"
    "memory/words/lane.wgsl"
    "memory/words/work.wgsl"
    "tally.wgsl"
    "blocks.wgsl"
    "math/elementary.wgsl"
    "math/rng.wgsl"
    "math/sampling.wgsl"
    "math/roots.wgsl"
    "math/offset.wgsl"
    "math/noise.wgsl"
    "geometry/hit.wgsl"
    "geometry/revolution.wgsl"
    "geometry/sphere.wgsl"
    "geometry/cube.wgsl"
    "geometry/cylinder.wgsl"
    "geometry/cone.wgsl"
    "geometry/torus.wgsl"
    "geometry/plane.wgsl"
    "geometry/triangle.wgsl"
    "geometry/instance.wgsl"
    "geometry/bvh.wgsl"
    "geometry/parameterisation.wgsl"
    "shading/material.wgsl"
    "shading/light.wgsl"
    "shading/texture.wgsl"
    "shading/bump.wgsl"
    "shading/detail.wgsl"
    "shading/medium.wgsl"
    "shading/background.wgsl"
    "dimensions.wgsl"
    "ray.wgsl"
    "camera.wgsl"
    "path.wgsl"
    "film.wgsl"
    "kernels/render.wgsl"
];

const WORDS: &str = "shaders/memory/words/";
/// Have the functions of the files of their names in [`WORDS`], and take their place.
const PAIRS: &[Part<'static>] = parts!["memory/pairs/buffers.wgsl" "memory/pairs/nodes.wgsl" "memory/pairs/stack.wgsl"];
/// Likewise, together with [`PAIRS`].
const SHARED: &[Part<'static>] = parts!["memory/shared/nodes.wgsl" "memory/shared/lane.wgsl" "memory/shared/work.wgsl"];

/// How a kernel reaches what it reads and writes most (nodes, instances, triangles, the stack of the traversal), and its
/// next pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryAccess {
    /// By words of 32 bits, as core WebGPU has them (`shaders/memory/words`).
    Words,
    /// By integers of 64 bits, where the device has them (`shaders/memory/pairs`).
    Pairs,
    /// As by pairs, but a node that lanes of a subgroup visit together is loaded by one of them, and subgroups take
    /// pixels as they come (`shaders/memory/shared`).
    SharedPairs,
}

impl MemoryAccess {
    /// From what runs everywhere to what asks most of a device.
    pub const ALL: [MemoryAccess; 3] = [MemoryAccess::Words, MemoryAccess::Pairs, MemoryAccess::SharedPairs];

    /// [`PARTS`] with this access.
    pub fn parts(self) -> Vec<Part<'static>> {
        let replacements = match self {
            MemoryAccess::Words => Vec::new(),
            MemoryAccess::Pairs => PAIRS.to_vec(),
            MemoryAccess::SharedPairs => [PAIRS, SHARED].concat(),
        };
        let file_name = |part: &Part<'static>| part.path.rsplit('/').next();
        let replaced = |part: &Part<'static>| {
            let same_name = |other: &&Part<'static>| file_name(other) == file_name(part);
            // The last one, as SHARED goes before PAIRS.
            replacements.iter().rfind(same_name).filter(|_| part.path.starts_with(WORDS)).copied()
        };
        PARTS.iter().map(|part| replaced(part).unwrap_or(*part)).collect()
    }

    /// What the parts need beyond core WebGPU.
    fn capabilities(self) -> Capabilities {
        match self {
            MemoryAccess::Words => Capabilities::empty(),
            MemoryAccess::Pairs => Capabilities::SHADER_INT64,
            MemoryAccess::SharedPairs => Capabilities::SHADER_INT64 | Capabilities::SUBGROUP,
        }
    }
}

/// The entry point of `shaders/kernels/render.wgsl`.
pub const RENDER_ENTRY_POINT: &str = "render";

/// The part of [`PARTS`] at `path` (`"shaders/types.wgsl"`).
pub fn part(path: &str) -> Option<Part<'static>> {
    PARTS.iter().find(|part| part.path == path).copied()
}

/// Parts that were joined, parsed and validated.
#[derive(Debug)]
pub struct Program {
    text: JoinedText,
    module: naga::Module,
    info: ModuleInfo,
}

impl Program {
    /// Joins, parses and validates the parts, in any order.
    ///
    /// # Errors
    /// [`Error::Shader`], starting with the path, line and column of the part that the error lies in.
    pub fn link(parts: &[Part]) -> Result<Program> {
        // No capability beyond core WebGPU, so that the program runs wherever wgpu does.
        Program::link_with(parts, Capabilities::empty())
    }

    /// The renderer's own program and further parts, for a device that [`Device::memory_access`] says this of.
    ///
    /// # Errors
    /// [`Error::Shader`] as for [`Program::link`].
    ///
    /// [`Device::memory_access`]: crate::gpu::Device::memory_access
    pub fn renderer(access: MemoryAccess, further: &[Part]) -> Result<Program> {
        let parts: Vec<Part> = access.parts().into_iter().chain(further.iter().copied()).collect();
        Program::link_with(&parts, access.capabilities())
    }

    fn link_with(parts: &[Part], capabilities: Capabilities) -> Result<Program> {
        let text = JoinedText::new(parts)?;
        let module = naga::front::wgsl::parse_str(&text.source).map_err(|error| {
            let mut labels = error.labels();
            let first = labels.next().map(|(span, _)| span);
            let mut message = text.describe(first, error.message());
            for (span, label) in labels {
                message.push_str(&format!("\n  {}", text.describe(Some(span), label)));
            }
            for note in error.notes() {
                message.push_str(&format!("\n  note: {note}"));
            }
            Error::Shader(message)
        })?;
        let info = Validator::new(ValidationFlags::all(), capabilities)
            .validate(&module)
            .map_err(|error| Error::Shader(text.describe(narrowest_span(&error), &chain(error.as_inner()))))?;
        Ok(Program { text, module, info })
    }

    /// The joined WGSL source.
    pub fn source(&self) -> &str {
        &self.text.source
    }

    /// The parsed program, before overrides.
    pub fn module(&self) -> &naga::Module {
        &self.module
    }

    /// Validates the program as a pipeline specialises it: `overrides` replaced by constants, and what the entry
    /// point does not reach left out. Overrides that are not listed keep their defaults.
    ///
    /// # Errors
    /// [`Error::Shader`] where the program lacks the entry point or an override, or is not valid with these values.
    pub fn validate_permutation(&self, entry_point: &str, overrides: &[(&str, bool)]) -> Result<()> {
        let stage = ShaderStage::Compute;
        if !self.module.entry_points.iter().any(|entry| entry.stage == stage && entry.name == entry_point) {
            return Err(Error::Shader(format!("the shaders have no compute entry point `{entry_point}`")));
        }
        let constants = overrides.iter().map(|&(name, value)| (name.to_owned(), f64::from(u8::from(value)))).collect();
        naga::back::pipeline_constants::process_overrides(
            &self.module,
            &self.info,
            Some((stage, entry_point)),
            &constants,
        )
        .map(|_| ())
        .map_err(|error| {
            use naga::back::pipeline_constants::PipelineConstantError as Cause;
            let span = if let Cause::ValidationError(error) = &error { narrowest_span(error) } else { None };
            let values: Vec<String> = overrides.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            Error::Shader(format!("{} (with {})", self.text.describe(span, &chain(&error)), values.join(", ")))
        })
    }
}

/// The joined text, and for each part where it begins in it.
#[derive(Debug)]
struct JoinedText {
    source: String,
    starts: Vec<(usize, String)>,
}

impl JoinedText {
    fn new(parts: &[Part]) -> Result<Self> {
        let mut joined = JoinedText { source: String::new(), starts: Vec::new() };
        for part in parts {
            if joined.starts.iter().any(|(_, path)| path == part.path) {
                return Err(Error::Shader(format!("{}: this part is listed twice", part.path)));
            }
            joined.starts.push((joined.source.len(), part.path.to_owned()));
            joined.source.push_str(part.text);
            joined.source.push('\n');
        }
        Ok(joined)
    }

    /// `path:line:column: message`, or the message alone where naga gives no place.
    fn describe(&self, span: Option<Span>, message: &str) -> String {
        let place = span.and_then(Span::to_range).and_then(|range| {
            let (start, path) = self.starts.iter().rev().find(|(start, _)| *start <= range.start)?;
            let before = self.source.get(*start..range.start)?;
            let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
            let line = before.matches('\n').count() + 1;
            let column = before[line_start..].chars().count() + 1;
            Some(format!("{path}:{line}:{column}: "))
        });
        format!("{}{message}", place.unwrap_or_default())
    }
}

/// naga lists spans from the whole function down to the expression; the shortest points best.
fn narrowest_span<E>(error: &naga::WithSpan<E>) -> Option<Span> {
    let spans = error.spans().filter_map(|(span, _)| Some((*span, span.to_range()?.len())));
    spans.min_by_key(|(_, length)| *length).map(|(span, _)| span)
}

/// An error with its causes: naga's outermost message only names the function.
fn chain(error: &dyn StdError) -> String {
    let mut message = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let text = error.to_string();
        // A transparent wrapper repeats its cause.
        if !message.ends_with(&text) {
            message.push_str(": ");
            message.push_str(&text);
        }
        cause = error.source();
    }
    message
}
