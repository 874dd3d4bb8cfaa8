//! What the lines say: vertices, texture coordinates, normals and faces.

use super::lines::joined_lines;
use glam::{Vec2, Vec3};
use std::str::{FromStr, SplitAsciiWhitespace};

/// The index of what a corner lacks.
pub const NONE: u32 = u32::MAX;

/// Numbers of lines, and of what they define.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub lines: usize,
    /// Positions, texture coordinates and normals.
    pub defined: [usize; 3],
}

impl Counts {
    pub fn of(text: &str) -> Self {
        let mut counts = Counts { lines: text.bytes().filter(|byte| *byte == b'\n').count(), defined: [0; 3] };
        for (_, line) in joined_lines(text) {
            match line.split_ascii_whitespace().next().map(|word| before_comment(word).as_bytes()) {
                Some(b"v") => counts.defined[0] += 1,
                Some(b"vt") => counts.defined[1] += 1,
                Some(b"vn") => counts.defined[2] += 1,
                _ => {}
            }
        }
        counts
    }

    pub fn plus(self, other: Counts) -> Counts {
        let defined = [0, 1, 2].map(|kind| self.defined[kind] + other.defined[kind]);
        Counts { lines: self.lines + other.lines, defined }
    }
}

/// Indices into all positions, texture coordinates and normals of the file; [`NONE`] where the corner has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    pub position: u32,
    pub uv: u32,
    pub normal: u32,
}

/// What a portion of the file defines, in its order.
#[derive(Debug, Default)]
pub struct Records {
    pub positions: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    /// Of length 1, or zero where the file has no direction.
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[Corner; 3]>,
}

impl Records {
    /// Reads a portion before which the file holds `start`, and `total` in all.
    ///
    /// # Errors
    /// A message with the line, for the first line that cannot be read.
    pub fn parse(text: &str, start: Counts, total: &Counts) -> Result<Records, String> {
        let mut records = Records::default();
        let mut corners = Vec::new();
        for (number, line) in joined_lines(text) {
            let mut words = before_comment(&line).split_ascii_whitespace();
            let outcome = match words.next().map(str::as_bytes) {
                Some(b"v") => position(words).map(|position| records.positions.push(position)),
                Some(b"vt") => numbers(&mut words)
                    .map(|[u, v]| records.uvs.push(Vec2::new(u, v)))
                    .ok_or_else(|| "texcoord parse error".to_owned()),
                Some(b"vn") => numbers(&mut words)
                    .map(|normal| records.normals.push(Vec3::from(normal).try_normalize().unwrap_or(Vec3::ZERO)))
                    .ok_or_else(|| "normal parse error".to_owned()),
                Some(b"f") => {
                    let own = [records.positions.len(), records.uvs.len(), records.normals.len()];
                    let so_far = [0, 1, 2].map(|kind| start.defined[kind] + own[kind]);
                    face(words, so_far, total.defined, &mut corners).map(|()| {
                        let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]);
                        records.triangles.extend(fan);
                    })
                }
                _ => Ok(()),
            };
            outcome.map_err(|message| format!("line {}: {message}", start.lines + number + 1))?;
        }
        Ok(records)
    }
}

fn before_comment(text: &str) -> &str {
    text.bytes().position(|byte| byte == b'#').map_or(text, |end| &text[..end])
}

/// Three coordinates, and maybe a weight; or three and a colour, which is read over.
fn position(mut words: SplitAsciiWhitespace) -> Result<Vec3, String> {
    let parse_error = || "position parse error".to_owned();
    let position = Vec3::from(numbers(&mut words).ok_or_else(parse_error)?);
    let (Some(weight), None) = (words.next(), words.next()) else { return Ok(position) };
    match weight.parse() {
        Ok(0.0) => Err("scaling (w) by zero".to_owned()),
        Ok(weight) => Ok(position / weight),
        Err(_) => Err(parse_error()),
    }
}

fn numbers<const N: usize>(words: &mut SplitAsciiWhitespace) -> Option<[f32; N]> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        *number = f32::from_str(words.next()?).ok()?;
    }
    Some(numbers)
}

/// Reads the corners of a face, none if there are fewer than three, before which the file defines `so_far` and `total`
/// in all.
fn face(
    words: SplitAsciiWhitespace,
    so_far: [usize; 3],
    total: [usize; 3],
    corners: &mut Vec<Corner>,
) -> Result<(), String> {
    corners.clear();
    let parse_error = || "face parse error".to_owned();
    let count = words.clone().count();
    let mut form = None;
    for word in words {
        let parts = corner_parts(word).ok_or_else(parse_error)?;
        // All corners of a face have the same parts.
        let own_form = parts.map(|part| part.is_some());
        if *form.get_or_insert(own_form) != own_form {
            return Err(parse_error());
        }
        if count < 3 {
            continue;
        }
        let mut indices = [NONE; 3];
        for (kind, part) in parts.into_iter().enumerate() {
            if let Some(index) = part {
                indices[kind] = resolve(kind, index, so_far[kind], total[kind])?;
            }
        }
        corners.push(Corner { position: indices[0], uv: indices[1], normal: indices[2] });
    }
    if count == 0 { Err(parse_error()) } else { Ok(()) }
}

/// The indices of `i`, `i/j`, `i//k` or `i/j/k`.
fn corner_parts(word: &str) -> Option<[Option<i64>; 3]> {
    let mut parts = [None; 3];
    for (kind, part) in word.split('/').enumerate() {
        if !part.is_empty() {
            *parts.get_mut(kind)? = Some(part.parse().ok()?);
        }
    }
    parts[0].map(|_| parts)
}

/// Counts an index from 0.
fn resolve(kind: usize, index: i64, so_far: usize, total: usize) -> Result<u32, String> {
    // Some programs write texture coordinates and normals of faces, and leave out what they refer to.
    if kind > 0 && total == 0 {
        return Ok(NONE);
    }
    let from_zero = if index < 0 { so_far as i64 + index } else { index - 1 };
    match u32::try_from(from_zero) {
        Ok(from_zero) if (from_zero as usize) < total && from_zero != NONE => Ok(from_zero),
        _ => Err(format!(
            "the face refers to {} {index}; there are {}, counted from 1 or back from -1",
            ["vertex", "texture coordinate", "normal"][kind],
            if index < 0 { so_far } else { total }
        )),
    }
}
