use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The name of a numbered file: one %d, %Nd or %0Nd stands for the frame's number, as in C; %% is a percent sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FramePattern {
    before: String,
    after: String,
    /// Least number of characters, and what fills them up.
    width: usize,
    fill: char,
}

/// The widest number; file names end at 255 characters anyway.
const MAX_WIDTH: usize = 99;

impl FramePattern {
    pub fn path(&self, frame: u32) -> PathBuf {
        let digits = frame.to_string();
        let fill: String = std::iter::repeat_n(self.fill, self.width.saturating_sub(digits.len())).collect();
        format!("{}{fill}{digits}{}", self.before, self.after).into()
    }
}

impl FromStr for FramePattern {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = "expected one %d, %4d or %04d, where the frame's number goes (and %% for a percent sign)";
        let mut number = None;
        let (mut before, mut current) = (String::new(), String::new());
        let mut rest = text;
        while let Some((plain, tail)) = rest.split_once('%') {
            current.push_str(plain);
            if let Some(tail) = tail.strip_prefix('%') {
                current.push('%');
                rest = tail;
                continue;
            }
            let (digits, tail) = tail.split_once('d').ok_or(expected)?;
            let width = if digits.is_empty() { Ok(0) } else { digits.parse::<usize>() };
            let width = width.ok().filter(|width| *width <= MAX_WIDTH && !digits.starts_with('+')).ok_or(expected)?;
            if number.is_some() {
                return Err(expected.to_owned());
            }
            number = Some((width, if digits.starts_with('0') { '0' } else { ' ' }));
            before = std::mem::take(&mut current);
            rest = tail;
        }
        current.push_str(rest);
        let (width, fill) = number.ok_or(expected)?;
        Ok(FramePattern { before, after: current, width, fill })
    }
}

/// Whether the file at `path` is a PNG from its mark to its end. Files that this program writes are whole or not there;
/// others' may have been cut off.
pub fn is_whole_png(path: &Path) -> bool {
    const MARK: &[u8] = b"\x89PNG\r\n\x1a\n";
    /// No data, the name, and the checksum.
    const END: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";
    let ends = || -> std::io::Result<([u8; 8], [u8; 12])> {
        let (mut mark, mut end) = ([0; 8], [0; 12]);
        let mut file = File::open(path)?;
        file.read_exact(&mut mark)?;
        file.seek(SeekFrom::End(-12))?;
        file.read_exact(&mut end)?;
        Ok((mark, end))
    };
    ends().is_ok_and(|(mark, end)| mark == MARK && end == END)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_filled_up() {
        for (pattern, frame, expected) in [
            ("%d.png", 7, "7.png"),
            ("out/frame-%04d.png", 7, "out/frame-0007.png"),
            ("%4d.png", 7, "   7.png"),
            ("%02d.png", 12345, "12345.png"),
            ("100%%-%d%%.png", 7, "100%-7%.png"),
        ] {
            let parsed: FramePattern = pattern.parse().unwrap_or_else(|error| panic!("{pattern}: {error}"));
            assert_eq!(parsed.path(frame), Path::new(expected), "{pattern}");
        }
    }

    #[test]
    fn other_patterns_are_refused() {
        for pattern in
            ["frame.png", "%d-%d.png", "%x.png", "%", "%%d.png", "%-4d.png", "%+4d.png", "%1000d.png", "%5.png"]
        {
            assert!(pattern.parse::<FramePattern>().is_err(), "{pattern}");
        }
    }
}
