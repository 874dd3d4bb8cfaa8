//! GIF: each frame with a palette of its own, by NeuQuant.

use super::super::AtomicFile;
use super::{FrameSink, Shape};
use crate::scene::FrameRate;
use ::gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use image::DynamicImage;
use std::io::{self, BufWriter, Write};

/// From 1 to 30: how few of the pixels the palette is learnt from.
const SPEED: i32 = 10;

pub(super) struct Gif {
    file: AtomicFile,
    encoder: Encoder<BufWriter<std::fs::File>>,
    rate: FrameRate,
    frames: u32,
}

impl Gif {
    pub fn new(file: AtomicFile, shape: &Shape) -> io::Result<Self> {
        let edge = |pixels: u32| {
            u16::try_from(pixels)
                .map_err(|_| io::Error::other(format!("a GIF is at most 65535 pixels wide and high, not {pixels}")))
        };
        let out = BufWriter::new(file.handle()?);
        let mut encoder = Encoder::new(out, edge(shape.width)?, edge(shape.height)?, &[]).map_err(io_error)?;
        encoder.set_repeat(Repeat::Infinite).map_err(io_error)?;
        Ok(Gif { file, encoder, rate: shape.rate, frames: 0 })
    }

    /// How long the next frame is shown, in 1/100 s, so that it ends nearest to where it should: roundings don't add up.
    fn delay(&self) -> u16 {
        let hundredths = |frame: u32| (self.rate.seconds_at(frame) * 100.0).round();
        (hundredths(self.frames + 1) - hundredths(self.frames)) as u16
    }
}

impl FrameSink for Gif {
    fn add(&mut self, picture: &DynamicImage) -> io::Result<()> {
        // Checked as the clip was begun.
        let (width, height) = (picture.width() as u16, picture.height() as u16);
        let mut frame = match picture {
            DynamicImage::ImageRgba8(rgba) => Frame {
                // What shows through is not to be the frame before.
                dispose: DisposalMethod::Background,
                ..Frame::from_rgba_speed(width, height, &mut with_clear_alpha(rgba), SPEED)
            },
            other => Frame::from_rgb_speed(width, height, other.to_rgb8().as_raw(), SPEED),
        };
        frame.delay = self.delay();
        self.encoder.write_frame(&frame).map_err(io_error)?;
        self.frames += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.encoder.into_inner().map_err(io_error)?.flush()?;
        self.file.commit()
    }
}

/// The pixels with an alpha of 0 below one half and 255 from there on: a GIF knows nothing between.
fn with_clear_alpha(rgba: &image::RgbaImage) -> Vec<u8> {
    let mut pixels = rgba.as_raw().clone();
    for pixel in pixels.chunks_exact_mut(4) {
        pixel[3] = if pixel[3] < 128 { 0 } else { 255 };
    }
    pixels
}

fn io_error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}
