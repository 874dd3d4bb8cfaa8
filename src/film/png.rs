//! PNG, 8 bits a channel, with alpha where the picture is transparent.

use super::Film;
use crate::scene::Transfer;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ImageEncoder, ImageError};
use std::io::{self, Write};

pub(super) fn encode_png(film: &Film, transfer: Transfer, transparent: bool, out: &mut dyn Write) -> io::Result<()> {
    let image = film.resolve(transfer, transparent);
    PngEncoder::new_with_quality(out, CompressionType::Default, FilterType::Adaptive)
        .write_image(image.as_bytes(), film.width, film.height, image.color().into())
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })
}
