//! MP4 by an installed ffmpeg, which gets the frames through a pipe.

use super::super::AtomicFile;
use super::super::unfinished::{self, Registration};
use super::{FrameSink, Shape};
use crate::{Error, Result};
use image::{DynamicImage, RgbImage};
use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Constant rate factor of x264: from here down the loss is hard to see.
const QUALITY: &str = "18";

/// The last lines of ffmpeg's messages that an error repeats.
const MESSAGE_LINES: usize = 4;

/// How often to look whether ffmpeg is done. Waiting for it would keep others from ending it.
const POLL: Duration = Duration::from_millis(5);

/// # Errors
/// [`Error::Device`] where there is no ffmpeg that runs.
pub(super) fn check_ffmpeg() -> Result<()> {
    let run = Command::new("ffmpeg")
        .arg("-version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    let why = match run {
        Ok(status) if status.success() => return Ok(()),
        Ok(status) => format!("'ffmpeg -version' ended with {status}"),
        Err(error) if error.kind() == io::ErrorKind::NotFound => "none is installed".to_owned(),
        Err(error) => error.to_string(),
    };
    Err(Error::Device(format!(
        "an MP4 clip takes ffmpeg, and {why}; install it (Debian and Ubuntu: apt-get install ffmpeg), or write .gif, \
         .apng or numbered PNG files"
    )))
}

pub(super) struct Mp4 {
    /// Before the file, so that it ends first and makes it no second time.
    ffmpeg: Ffmpeg,
    file: AtomicFile,
}

impl Mp4 {
    pub fn new(file: AtomicFile, shape: &Shape) -> io::Result<Self> {
        let mut command = Command::new("ffmpeg");
        let size = format!("{}x{}", even(shape.width), even(shape.height));
        command.args(["-hide_banner", "-loglevel", "error", "-y"]);
        command.args(["-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", &size]);
        command.args(["-framerate", &shape.rate.to_string(), "-i", "pipe:0", "-an"]);
        command.args(["-vf", "scale=out_color_matrix=bt709:out_range=limited,format=yuv420p"]);
        command.args(["-c:v", "libx264", "-crf", QUALITY]);
        command.args([
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "bt709",
            "-color_range",
            "tv",
        ]);
        command.args(["-movflags", "+faststart", "-f", "mp4"]).arg(file.temporary_path());
        Ok(Mp4 { ffmpeg: Ffmpeg::start(command)?, file })
    }
}

impl FrameSink for Mp4 {
    fn add(&mut self, picture: &DynamicImage) -> io::Result<()> {
        let picture = with_even_edges(picture.to_rgb8());
        self.ffmpeg.write(picture.as_raw())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        let Mp4 { file, ffmpeg } = *self;
        ffmpeg.finish()?;
        file.commit()
    }
}

/// The next even number: H.264 stores colours for two by two pixels.
fn even(edge: u32) -> u32 {
    edge.next_multiple_of(2)
}

/// The picture with its last column and row doubled where their number is odd.
fn with_even_edges(picture: RgbImage) -> RgbImage {
    let (width, height) = picture.dimensions();
    if (even(width), even(height)) == (width, height) {
        return picture;
    }
    RgbImage::from_fn(even(width), even(height), |x, y| *picture.get_pixel(x.min(width - 1), y.min(height - 1)))
}

/// A running ffmpeg, which is ended as it is dropped.
struct Ffmpeg {
    child: Arc<Mutex<Child>>,
    input: Option<ChildStdin>,
    messages: Option<JoinHandle<String>>,
    _registration: Registration,
}

impl Ffmpeg {
    fn start(mut command: Command) -> io::Result<Self> {
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        // A group of its own: Ctrl-C is for us to judge, and ffmpeg would end its clip there.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let (child, registration) = unfinished::register(|| {
            let child = Arc::new(Mutex::new(command.spawn()?));
            let to_end = Arc::clone(&child);
            Ok::<_, io::Error>((child, Box::new(move || end(&mut lock(&to_end))) as _))
        })?;
        let (input, errors) = {
            let mut child = lock(&child);
            (child.stdin.take(), child.stderr.take())
        };
        let messages = errors.map(|mut errors| {
            thread::spawn(move || {
                let mut bytes = Vec::new();
                // What can't be read can't be told.
                let _ = errors.read_to_end(&mut bytes);
                String::from_utf8_lossy(&bytes).into_owned()
            })
        });
        Ok(Ffmpeg { child, input, messages, _registration: registration })
    }

    /// # Errors
    /// With ffmpeg's own words where it has ended.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let written = self.input.as_mut().map_or(Ok(()), |input| input.write_all(bytes));
        match written {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(self.failure(self.wait()?)),
            other => other,
        }
    }

    /// Lets it come to its end.
    fn finish(mut self) -> io::Result<()> {
        self.input = None;
        let status = self.wait()?;
        if status.success() { Ok(()) } else { Err(self.failure(status)) }
    }

    fn wait(&self) -> io::Result<ExitStatus> {
        loop {
            if let Some(status) = lock(&self.child).try_wait()? {
                return Ok(status);
            }
            thread::sleep(POLL);
        }
    }

    fn failure(&mut self, status: ExitStatus) -> io::Error {
        let messages = self.messages.take().and_then(|messages| messages.join().ok()).unwrap_or_default();
        let lines: Vec<&str> = messages.lines().filter(|line| !line.trim().is_empty()).collect();
        let last = lines[lines.len().saturating_sub(MESSAGE_LINES)..].join("\n  ");
        io::Error::other(format!("ffmpeg has failed ({status}):\n  {last}"))
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        self.input = None;
        end(&mut lock(&self.child));
    }
}

fn end(child: &mut Child) {
    // Both fail where it has ended by itself.
    let _ = child.kill();
    let _ = child.wait();
}

fn lock(child: &Mutex<Child>) -> MutexGuard<'_, Child> {
    child.lock().unwrap_or_else(PoisonError::into_inner)
}
