//! How alike two pictures are: FLIP (Andersson et al. 2020), PSNR, and the share of pixels that differ visibly.

use crate::{Error, Result};
use image::{DynamicImage, ImageError, ImageReader, RgbaImage};
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8};
use std::fmt;
use std::path::Path;

/// Channels of a pixel may differ by this much, in units of 1/255, before the pixel counts as differing.
const TOLERATED_DIFFERENCE: u8 = 2;

/// Which pixels are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mask {
    /// All of them.
    #[default]
    None,
    /// Those where the first picture, the reference, has an alpha above 0. What the second shows elsewhere is
    /// ignored, and so is its alpha.
    Alpha,
}

/// The outcome of [`compare_images`], over the compared pixels. `Display` is the line of `gpu-trace compare`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean of the FLIP error in [0, 1], at 67 pixels a degree of the eye's field (a 4K monitor at 0.7 m).
    pub flip_mean: f64,
    /// Peak signal-to-noise ratio in decibels against a peak of 255; infinite for identical pictures.
    pub psnr_db: f64,
    /// Share in [0, 1] of the pixels with a channel that differs by more than 2/255.
    pub differing_share: f64,
    /// The largest difference of any channel, in units of 1/255.
    pub max_difference: u8,
    /// How many pixels were compared.
    pub pixels: u64,
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "FLIP mean {:.4}  PSNR {:.1} dB  {:.2} % of pixels differ by more than {TOLERATED_DIFFERENCE}/255",
            self.flip_mean,
            self.psnr_db,
            100.0 * self.differing_share
        )
    }
}

/// Reads a picture file for [`compare_images`].
///
/// # Errors
/// [`Error::File`] where it cannot be read, [`Error::Format`] where it does not hold a picture.
pub fn read_picture(path: &Path) -> Result<DynamicImage> {
    let action = "read the picture";
    let file_error = |source| Error::file(action, path, source);
    let reader = ImageReader::open(path).and_then(ImageReader::with_guessed_format).map_err(file_error)?;
    reader.decode().map_err(|error| match error {
        ImageError::IoError(source) => Error::file(action, path, source),
        other => Error::Format { path: path.to_owned(), message: other.to_string() },
    })
}

/// Compares two pictures of the same size, all of their pixels; see [`compare_masked`].
///
/// # Errors
/// As [`compare_masked`].
pub fn compare_images(reference: &DynamicImage, test: &DynamicImage) -> Result<Comparison> {
    compare_masked(reference, test, Mask::None)
}

/// Compares the pixels of two pictures of the same size that lie inside the mask.
///
/// Colours are compared as they look over black (multiplied by alpha), so that what a fully transparent pixel holds
/// does not matter. Alpha is a fourth channel where either picture has one and no mask is used; FLIP, a measure of
/// colours, leaves it out.
///
/// # Errors
/// [`Error::Scene`] where the sizes differ, the mask is empty or wants an alpha that the reference does not have, or
/// the pictures have 2^28 pixels or more.
pub fn compare_masked(reference: &DynamicImage, test: &DynamicImage, mask: Mask) -> Result<Comparison> {
    let (width, height) = (reference.width(), reference.height());
    if (width, height) != (test.width(), test.height()) {
        return Err(Error::Scene(format!(
            "the pictures differ in size: {width}x{height} and {}x{}",
            test.width(),
            test.height()
        )));
    }
    // FLIP counts bytes in 32 bits.
    if u64::from(width) * u64::from(height) >= 1 << 28 {
        return Err(Error::Scene(format!("pictures of {width}x{height} are too large to compare")));
    }
    if mask == Mask::Alpha && !reference.color().has_alpha() {
        return Err(Error::Scene("the first picture has no alpha channel to take the mask from".to_owned()));
    }
    let compare_alpha = mask == Mask::None && (reference.color().has_alpha() || test.color().has_alpha());

    let [mut a, mut b] = [reference, test].map(|picture| over_black(picture.to_rgba8()));
    let masked = a.pixels().map(|pixel| mask == Mask::None || pixel[3] > 0).collect::<Vec<bool>>();
    let pixels = masked.iter().filter(|&&inside| inside).count() as u64;
    if pixels == 0 {
        return Err(Error::Scene("the mask is empty: the first picture's alpha is 0 everywhere".to_owned()));
    }

    let channels = if compare_alpha { 4 } else { 3 };
    let (mut squares, mut differing, mut max_difference) = (0_u64, 0_u64, 0_u8);
    for ((a, b), inside) in a.pixels_mut().zip(b.pixels_mut()).zip(&masked) {
        if !inside {
            // Alike outside the mask, so that FLIP's filters carry nothing in from there.
            (a.0, b.0) = ([0; 4], [0; 4]);
            continue;
        }
        let differences = a.0.iter().zip(&b.0).take(channels).map(|(a, b)| a.abs_diff(*b));
        let mut largest = 0;
        for difference in differences {
            squares += u64::from(difference).pow(2);
            largest = largest.max(difference);
        }
        differing += u64::from(largest > TOLERATED_DIFFERENCE);
        max_difference = max_difference.max(largest);
    }

    let mean_square = squares as f64 / (pixels * channels as u64) as f64;
    Ok(Comparison {
        flip_mean: flip_mean(a, b, &masked, pixels),
        psnr_db: 10.0 * (255.0 * 255.0 / mean_square).log10(),
        differing_share: differing as f64 / pixels as f64,
        max_difference,
        pixels,
    })
}

fn flip_mean(reference: RgbaImage, test: RgbaImage, masked: &[bool], pixels: u64) -> f64 {
    let [reference, test] = [reference, test].map(|picture| {
        let rgb = DynamicImage::ImageRgba8(picture).into_rgb8();
        FlipImageRgb8::with_data(rgb.width(), rgb.height(), &rgb)
    });
    let errors = nv_flip::flip(reference, test, DEFAULT_PIXELS_PER_DEGREE).to_vec();
    let inside = errors.iter().zip(masked).filter(|(_, inside)| **inside);
    inside.map(|(error, _)| f64::from(*error)).sum::<f64>() / pixels as f64
}

/// Multiplies the colours by alpha, which stays.
fn over_black(mut picture: RgbaImage) -> RgbaImage {
    for pixel in picture.pixels_mut() {
        let alpha = u32::from(pixel[3]);
        for channel in &mut pixel.0[..3] {
            *channel = ((u32::from(*channel) * alpha + 127) / 255) as u8;
        }
    }
    picture
}
