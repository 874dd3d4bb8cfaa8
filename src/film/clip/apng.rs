//! Animated PNG: every frame in full, 8 bits a channel, with alpha in a transparent clip.

use super::super::AtomicFile;
use super::{FrameSink, Shape};
use image::DynamicImage;
use png::{BitDepth, ColorType, Encoder, EncodingError, Writer};
use std::fs::File;
use std::io::{self, BufWriter};

pub(super) struct Apng {
    file: AtomicFile,
    writer: Writer<BufWriter<File>>,
}

impl Apng {
    pub fn new(file: AtomicFile, shape: &Shape) -> io::Result<Self> {
        let mut encoder = Encoder::new(BufWriter::new(file.handle()?), shape.width, shape.height);
        encoder.set_color(if shape.transparent { ColorType::Rgba } else { ColorType::Rgb });
        encoder.set_depth(BitDepth::Eight);
        // Repeated for ever.
        encoder.set_animated(shape.frames, 0).map_err(io_error)?;
        encoder.set_frame_delay(shape.rate.denominator(), shape.rate.numerator()).map_err(io_error)?;
        Ok(Apng { file, writer: encoder.write_header().map_err(io_error)? })
    }
}

impl FrameSink for Apng {
    fn add(&mut self, picture: &DynamicImage) -> io::Result<()> {
        self.writer.write_image_data(picture.as_bytes()).map_err(io_error)
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.writer.finish().map_err(io_error)?;
        self.file.commit()
    }
}

fn io_error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
