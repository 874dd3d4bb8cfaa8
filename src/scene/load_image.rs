//! Image files, through the `image` crate.

use super::{Image, Texels};
use crate::error::{Error, Result};
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;

/// Pixels along an edge that an image may have.
const LARGEST_EDGE: u32 = 16384;
/// Bytes that an image may take while it is decoded, and as texels: 16384 x 8192 of 8 bits a channel.
const LARGEST_MEMORY: u64 = 512 << 20;

/// Loads an image: PNG, JPEG, BMP, TGA, GIF (the first picture), WebP, QOI, PNM, Radiance HDR or OpenEXR. The contents
/// decide which it is, not the name; TGA alone has no mark of its own and needs its extension.
///
/// Values are used as they stand, without undoing a transfer curve; 16 bits a channel are rounded to 8, grey and palette
/// images become RGBA. HDR and OpenEXR keep their floats but for what no picture can show: NaN becomes 0, infinities the
/// largest number. A photograph is turned as its camera noted.
///
/// # Errors
/// [`Error::File`] if the file cannot be read; [`Error::Format`] if it is no image, is damaged or cut short, has no
/// pixels, more than 16384 on an edge, or would take more than 512 MiB. The size is checked before memory is taken.
pub fn load_image(path: &Path) -> Result<Image> {
    let fail = |message: String| Error::Format { path: path.to_owned(), message };
    let read = |source| Error::file("read the image", path, source);
    let length = std::fs::metadata(path).map_err(read)?.len();
    if length > LARGEST_MEMORY {
        return Err(fail(format!("the file has {} MiB, more than {} MiB", length >> 20, LARGEST_MEMORY >> 20)));
    }
    let mut bytes = std::fs::read(path).map_err(read)?;
    // How older Radiance files begin, which the decoder does not know.
    if bytes.starts_with(b"#?RGBE") {
        bytes.splice(.."#?RGBE".len(), *b"#?RADIANCE");
    }
    let format = recognise(path, &bytes).map_err(fail)?;
    // A decoder that panics on a damaged file is no reason to lose the pictures rendered so far.
    let picture = panic::catch_unwind(AssertUnwindSafe(|| decode(&bytes, format)))
        .unwrap_or_else(|_| Err(format!("the {} data are damaged", name_of(format))))
        .map_err(fail)?;
    Ok(pack(path.display().to_string(), picture))
}

fn recognise(path: &Path, bytes: &[u8]) -> Result<ImageFormat, String> {
    if bytes.is_empty() {
        return Err("the file is empty".to_owned());
    }
    let by_name = || ImageFormat::from_path(path).ok().filter(|format| *format == ImageFormat::Tga);
    match image::guess_format(bytes).ok().or_else(by_name) {
        Some(format) if format.reading_enabled() => Ok(format),
        Some(format) => Err(format!("it is {}, which is not supported; {EXPECTED}", name_of(format))),
        None => Err(format!("this is no image of a known kind; {EXPECTED}")),
    }
}

const EXPECTED: &str = "expected PNG, JPEG, BMP, TGA, GIF, WebP, QOI, PNM, HDR or EXR";

fn name_of(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Png => "PNG",
        ImageFormat::Jpeg => "JPEG",
        ImageFormat::Gif => "GIF",
        ImageFormat::WebP => "WebP",
        ImageFormat::Pnm => "PNM",
        ImageFormat::Tiff => "TIFF",
        ImageFormat::Tga => "TGA",
        ImageFormat::Dds => "DDS",
        ImageFormat::Bmp => "BMP",
        ImageFormat::Ico => "an icon",
        ImageFormat::Hdr => "HDR",
        ImageFormat::OpenExr => "EXR",
        ImageFormat::Farbfeld => "Farbfeld",
        ImageFormat::Avif => "AVIF",
        ImageFormat::Qoi => "QOI",
        _ => "of another kind",
    }
}

fn decode(bytes: &[u8], format: ImageFormat) -> Result<DynamicImage, String> {
    let explain = |error: ImageError| match error {
        ImageError::IoError(source) if source.kind() == std::io::ErrorKind::UnexpectedEof => {
            format!("the {} data end too early", name_of(format))
        }
        ImageError::Limits(_) => format!("decoding it takes more than {} MiB", LARGEST_MEMORY >> 20),
        other => format!("the {} data cannot be read: {other}", name_of(format)),
    };
    let mut limits = Limits::default();
    limits.max_alloc = Some(LARGEST_MEMORY);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(explain)?;
    check_size(decoder.dimensions(), decoder.total_bytes(), is_float(format))?;
    if format == ImageFormat::Jpeg && !is_whole_jpeg(bytes) {
        // The decoder would fill the rest with grey.
        return Err("the JPEG data end too early".to_owned());
    }
    let orientation = decoder.orientation().map_err(explain)?;
    let mut picture = DynamicImage::from_decoder(decoder).map_err(explain)?;
    picture.apply_orientation(orientation);
    Ok(picture)
}

fn is_float(format: ImageFormat) -> bool {
    matches!(format, ImageFormat::Hdr | ImageFormat::OpenExr)
}

fn check_size((width, height): (u32, u32), decoded: u64, float: bool) -> Result<(), String> {
    if width == 0 || height == 0 {
        return Err(format!("it has no pixels ({width} x {height})"));
    }
    if width.max(height) > LARGEST_EDGE {
        return Err(format!("it is {width} x {height} pixels, more than {LARGEST_EDGE} on an edge"));
    }
    let texel = if float { size_of::<[f32; 3]>() } else { size_of::<[u8; 4]>() };
    let needed = (u64::from(width) * u64::from(height) * texel as u64).max(decoded);
    if needed > LARGEST_MEMORY {
        let (needed, most) = (needed.div_ceil(1 << 20), LARGEST_MEMORY >> 20);
        return Err(format!("it is {width} x {height} pixels, which take {needed} MiB, more than {most} MiB"));
    }
    Ok(())
}

/// Whether the end marker follows the last scan. In a scan's data no byte 0xFF stands before anything that could be
/// mistaken for a marker (ITU-T T.81, B.1.1.5), and thumbnails in the header come before the scans.
fn is_whole_jpeg(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xFF, marker]);
    match (last(0xDA), last(0xD9)) {
        (Some(scan), Some(end)) => end > scan,
        _ => false,
    }
}

fn pack(name: String, picture: DynamicImage) -> Image {
    let (width, height) = (picture.width(), picture.height());
    let texels = match picture {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let pixels = picture.into_rgb32f();
            Texels::Rgb32F(pixels.pixels().map(|pixel| pixel.0.map(presentable)).collect())
        }
        other => Texels::Rgba8(other.into_rgba8().pixels().map(|pixel| pixel.0).collect()),
    };
    Image { name, width, height, texels }
}

fn presentable(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(f32::MIN, f32::MAX) }
}
