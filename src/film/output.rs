//! The picture formats, and which one a file name asks for. To add a format: a variant here, and a file beside
//! `png.rs` that encodes a film.

use super::Film;
use super::atomic::write_atomically;
use super::png::encode_png;
use crate::scene::Transfer;
use crate::{Error, Result};
use std::io::{self, Write};
use std::path::Path;

/// A kind of picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputFormat {
    Png,
}

impl OutputFormat {
    /// Every format that can be written.
    pub const ALL: &[OutputFormat] = &[OutputFormat::Png];

    /// The ending of its files' names, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            OutputFormat::Png => "png",
        }
    }

    fn encode(self, film: &Film, transfer: Transfer, transparent: bool, out: &mut dyn Write) -> io::Result<()> {
        match self {
            OutputFormat::Png => encode_png(film, transfer, transparent, out),
        }
    }

    /// The format that the ending of a file's name asks for, in either case.
    ///
    /// # Errors
    /// [`Error::Format`], which names the supported endings.
    pub fn from_path(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default();
        let format = Self::ALL.iter().find(|format| extension.eq_ignore_ascii_case(format.extension()));
        format.copied().ok_or_else(|| Error::Format { path: path.to_owned(), message: Self::expected() })
    }

    /// What the names of pictures end in, for messages.
    pub fn expected() -> String {
        let supported: Vec<String> = Self::ALL.iter().map(|format| format!(".{}", format.extension())).collect();
        format!("the name of a picture must end in {}", supported.join(" or "))
    }

    /// Writes the picture; an existing one is replaced only when the new one is complete, and missing folders are
    /// made.
    ///
    /// # Errors
    /// [`Error::File`] where the file cannot be written. The folder then holds what it held before.
    pub fn write(self, film: &Film, path: &Path, transfer: Transfer, transparent: bool) -> Result<()> {
        write_atomically("write the picture", path, |out| self.encode(film, transfer, transparent, out))
    }
}

/// Writes the picture in the format that the ending of the file's name asks for; see [`OutputFormat::write`].
///
/// # Errors
/// As [`OutputFormat::from_path`] and [`OutputFormat::write`].
pub fn write_picture(film: &Film, path: &Path, transfer: Transfer, transparent: bool) -> Result<()> {
    OutputFormat::from_path(path)?.write(film, path, transfer, transparent)
}
