//! Text in lines, and in portions of whole lines.

use std::borrow::Cow;

/// The lines of a text, those joined that a backslash at the end continues, each with the number of lines before it.
pub fn joined_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (number, line) = lines.next()?;
        let Some(start) = before_backslash(line) else { return Some((number, Cow::Borrowed(line))) };
        let mut joined = start.to_owned();
        for (_, line) in lines.by_ref() {
            joined.push(' ');
            let start = before_backslash(line);
            joined.push_str(start.unwrap_or(line));
            if start.is_none() {
                break;
            }
        }
        Some((number, Cow::Owned(joined)))
    })
}

fn before_backslash(line: &str) -> Option<&str> {
    let line = line.trim_ascii_end();
    line.as_bytes().ends_with(b"\\").then(|| &line[..line.len() - 1])
}

/// Cuts the text into portions of at least `size` bytes, the last one excepted, between lines that are not to be joined.
pub fn portions(text: &str, size: usize) -> Vec<&str> {
    let mut portions = Vec::new();
    let mut rest = text;
    while rest.len() > size {
        let mut end = size;
        // The first line is a fragment, which may hide a backslash.
        for (i, line) in rest.as_bytes()[size..].split_inclusive(|byte| *byte == b'\n').enumerate() {
            end += line.len();
            if i > 0 && !line.trim_ascii_end().ends_with(b"\\") {
                break;
            }
        }
        let (portion, after) = rest.split_at(end);
        portions.push(portion);
        rest = after;
    }
    portions.push(rest);
    portions
}
