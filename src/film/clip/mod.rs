//! Clips: pictures one after another in one file or stream. To add a format: a variant of [`ClipFormat`], and a file
//! beside this one with a [`FrameSink`].

mod apng;
mod gif;
mod mp4;
mod y4m;

pub use y4m::rgb_to_ycbcr;

use super::{AtomicFile, Film, check_writable};
use crate::scene::{FrameRate, Transfer};
use crate::{Error, Result};
use image::DynamicImage;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

const ACTION: &str = "write the clip";

/// A kind of clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipFormat {
    /// 256 colours a frame, for ever repeated; transparent or not, with nothing between.
    Gif,
    /// As PNG, for ever repeated.
    Apng,
    /// H.264 (yuv420p, Rec. 709), by an installed ffmpeg.
    Mp4,
    /// Uncompressed YUV4MPEG2 on standard output, for other programs.
    Y4m,
}

impl ClipFormat {
    /// Every format that can be written to a file.
    pub const FILES: &[ClipFormat] = &[ClipFormat::Gif, ClipFormat::Apng, ClipFormat::Mp4];

    /// The format that a file's name, in either case, or '-' asks for.
    pub fn from_path(path: &Path) -> Option<Self> {
        if path == Path::new("-") {
            return Some(ClipFormat::Y4m);
        }
        let extension = path.extension()?;
        Self::FILES.iter().copied().find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }

    /// The ending of its files' names, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            ClipFormat::Gif => "gif",
            ClipFormat::Apng => "apng",
            ClipFormat::Mp4 => "mp4",
            ClipFormat::Y4m => "y4m",
        }
    }

    fn shows_transparency(self) -> bool {
        matches!(self, ClipFormat::Gif | ClipFormat::Apng)
    }
}

/// Takes the frames of a clip, in order.
trait FrameSink: Send {
    /// Adds a frame: `Rgb8`, or `Rgba8` in a transparent clip of a format that can show it. All have one size.
    fn add(&mut self, picture: &DynamicImage) -> io::Result<()>;

    /// Completes the clip and gives it its name. A sink that is dropped before leaves nothing behind.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// What a sink has to know before its first frame.
struct Shape {
    width: u32,
    height: u32,
    transparent: bool,
    frames: u32,
    rate: FrameRate,
}

/// A clip in the making.
pub struct ClipWriter {
    path: PathBuf,
    format: ClipFormat,
    frames: u32,
    rate: FrameRate,
    open: Option<(Shape, Box<dyn FrameSink>)>,
}

impl ClipWriter {
    /// A clip of that many frames. Nothing is made yet.
    ///
    /// # Errors
    /// [`Error::File`] where the clip cannot be written there; [`Error::Device`] where it takes ffmpeg and there is
    /// none.
    pub fn new(path: &Path, format: ClipFormat, frames: u32, rate: FrameRate) -> Result<Self> {
        if format != ClipFormat::Y4m {
            check_writable(ACTION, path)?;
        }
        if format == ClipFormat::Mp4 {
            mp4::check_ffmpeg()?;
        }
        Ok(ClipWriter { path: path.to_owned(), format, frames, rate, open: None })
    }

    /// Adds a frame. The first one decides the size, and whether the clip is transparent.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Scene`] for a frame that is not like the first.
    pub fn add(&mut self, film: &Film, transfer: Transfer, transparent: bool) -> Result<()> {
        let size = (film.width, film.height);
        if let Some((Shape { width, height, transparent: first, .. }, _)) = &self.open
            && ((*width, *height), *first) != (size, transparent)
        {
            let describe = |(width, height), transparent| {
                format!("{width}x{height} and {}", if transparent { "transparent" } else { "opaque" })
            };
            return Err(Error::Scene(format!(
                "the frames of a clip must be alike: this one is {}, the first is {}",
                describe(size, transparent),
                describe((*width, *height), *first)
            )));
        }
        let mut add = || {
            let (_, sink) = match &mut self.open {
                Some(open) => open,
                open @ None => {
                    let (frames, rate) = (self.frames, self.rate);
                    let shape = Shape { width: film.width, height: film.height, transparent, frames, rate };
                    let sink = open_sink(&self.path, self.format, &shape)?;
                    open.insert((shape, sink))
                }
            };
            sink.add(&film.resolve(transfer, transparent && self.format.shows_transparency()))
        };
        add().map_err(|source| Error::file(ACTION, shown(&self.path), source))
    }

    /// Completes the clip: only now is it there under its name.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(self) -> Result<()> {
        let Some((_, sink)) = self.open else { return Ok(()) };
        sink.finish().map_err(|source| Error::file(ACTION, shown(&self.path), source))
    }
}

/// The clip's name in messages.
fn shown(path: &Path) -> &Path {
    if path == Path::new("-") { Path::new("standard output") } else { path }
}

fn open_sink(path: &Path, format: ClipFormat, shape: &Shape) -> io::Result<Box<dyn FrameSink>> {
    let file = || AtomicFile::create(path, &format!(".{}", format.extension()));
    Ok(match format {
        ClipFormat::Gif => Box::new(gif::Gif::new(file()?, shape)?),
        ClipFormat::Apng => Box::new(apng::Apng::new(file()?, shape)?),
        ClipFormat::Mp4 => Box::new(mp4::Mp4::new(file()?, shape)?),
        ClipFormat::Y4m => Box::new(y4m::Y4m::new(BufWriter::new(io::stdout()), shape)?),
    })
}
