//! Image files: what each kind gives, and what damaged, huge and mislabelled ones are answered with.

use gpu_trace::Error;
use gpu_trace::scene::{Image, Texels, load_image};
use image::codecs::png::PngEncoder;
use image::{DynamicImage, ExtendedColorType, ImageBuffer, ImageEncoder, ImageFormat, Rgb, RgbaImage};
use std::fs;
use std::io::Cursor;
use std::path::PathBuf;
use tempfile::TempDir;

/// A file that lives as long as the test.
struct File {
    _folder: TempDir,
    path: PathBuf,
}

fn file(name: &str, bytes: impl AsRef<[u8]>) -> File {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    File { _folder: folder, path }
}

fn load(name: &str, bytes: impl AsRef<[u8]>) -> Image {
    load_image(&file(name, bytes).path).unwrap()
}

/// The message after the file's path.
fn problem(name: &str, bytes: impl AsRef<[u8]>) -> String {
    let file = file(name, bytes);
    let error = load_image(&file.path).unwrap_err();
    assert!(matches!(&error, Error::Format { path, .. } if *path == file.path), "{error:?}");
    error.to_string().strip_prefix(&format!("{}: ", file.path.display())).unwrap().to_owned()
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// Every pixel another colour, all opaque.
fn colourful(width: u32, height: u32) -> RgbaImage {
    ImageBuffer::from_fn(width, height, |x, y| image::Rgba([(40 * x) as u8, (60 * y) as u8, (7 * x * y) as u8, 255]))
}

fn rgba(image: &Image) -> &[[u8; 4]] {
    match &image.texels {
        Texels::Rgba8(texels) => texels,
        Texels::Rgb32F(_) => panic!("floats"),
    }
}

fn floats(image: &Image) -> &[[f32; 3]] {
    match &image.texels {
        Texels::Rgb32F(texels) => texels,
        Texels::Rgba8(_) => panic!("bytes"),
    }
}

fn png(width: u32, height: u32, colour: ExtendedColorType, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(data, width, height, colour).unwrap();
    bytes
}

#[test]
fn lossless_kinds_keep_every_value_from_the_top_row() {
    let picture = colourful(5, 3);
    let expected: Vec<[u8; 4]> = picture.pixels().map(|pixel| pixel.0).collect();
    let opaque = DynamicImage::ImageRgba8(picture).into_rgb8().into();
    for (format, name) in [
        (ImageFormat::Png, "a.png"),
        (ImageFormat::Bmp, "a.bmp"),
        (ImageFormat::Tga, "a.TGA"),
        (ImageFormat::WebP, "a.webp"),
        (ImageFormat::Qoi, "a.qoi"),
        (ImageFormat::Pnm, "a.ppm"),
    ] {
        let image = load(name, encoded(&opaque, format));
        assert_eq!((image.width, image.height), (5, 3), "{name}");
        assert_eq!(rgba(&image), expected, "{name}");
        assert!(image.name.ends_with(name));
    }
}

#[test]
fn alpha_grey_and_palette_become_rgba() {
    let image = load("a.png", png(2, 1, ExtendedColorType::Rgba8, &[1, 2, 3, 4, 5, 6, 7, 0]));
    assert_eq!(rgba(&image), [[1, 2, 3, 4], [5, 6, 7, 0]]);
    let image = load("g.png", png(2, 1, ExtendedColorType::L8, &[9, 200]));
    assert_eq!(rgba(&image), [[9, 9, 9, 255], [200, 200, 200, 255]]);
    let image = load("ga.png", png(1, 1, ExtendedColorType::La8, &[9, 7]));
    assert_eq!(rgba(&image), [[9, 9, 9, 7]]);
    // A palette of two colours at one bit a pixel, the second half transparent: pixels 1, 0, 1.
    let palette = png_chunks(&[
        (b"IHDR", &[0, 0, 0, 3, 0, 0, 0, 1, 1, 3, 0, 0, 0]),
        (b"PLTE", &[10, 20, 30, 40, 50, 60]),
        (b"tRNS", &[255, 128]),
        (b"IDAT", &stored_zlib(&[0, 0b1010_0000])),
        (b"IEND", &[]),
    ]);
    assert_eq!(rgba(&load("p.png", palette)), [[40, 50, 60, 128], [10, 20, 30, 255], [40, 50, 60, 128]]);
}

#[test]
fn sixteen_bits_are_rounded_to_eight() {
    // 128.49 and 128.51 of 257 steps each, and the ends.
    let values: [u16; 6] = [0, 128, 129, 128 * 257 + 128, 128 * 257 + 129, 65535];
    let data: Vec<u8> = values.iter().flat_map(|value| value.to_ne_bytes()).collect();
    let image = load("a.png", png(6, 1, ExtendedColorType::L16, &data));
    let reds: Vec<u8> = rgba(&image).iter().map(|texel| texel[0]).collect();
    assert_eq!(reds, [0, 0, 1, 128, 129, 255]);
}

#[test]
fn a_jpeg_is_close_to_its_picture() {
    let flat = RgbaImage::from_pixel(16, 8, image::Rgba([200, 100, 50, 255]));
    let image = load("a.jpg", encoded(&DynamicImage::ImageRgba8(flat).into_rgb8().into(), ImageFormat::Jpeg));
    assert_eq!((image.width, image.height), (16, 8));
    for texel in rgba(&image) {
        let apart = [200u8, 100, 50].iter().zip(texel).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        assert!(apart <= 3 && texel[3] == 255, "{texel:?}");
    }
}

#[test]
fn the_first_picture_of_a_gif() {
    let image = load("a.gif", encoded(&colourful(2, 2).into(), ImageFormat::Gif));
    assert_eq!(rgba(&image), [[0, 0, 0, 255], [40, 0, 0, 255], [0, 60, 0, 255], [40, 60, 7, 255]]);
}

#[test]
fn radiance_and_exr_stay_floats() {
    let values = [[0.25f32, 1.0, 1024.0], [0.0, 0.5, 2.0]];
    let picture = DynamicImage::ImageRgb32F(ImageBuffer::from_fn(2, 1, |x, _| Rgb(values[x as usize])));
    for (format, name) in [(ImageFormat::Hdr, "a.hdr"), (ImageFormat::OpenExr, "a.exr")] {
        let image = load(name, encoded(&picture, format));
        for (got, wanted) in floats(&image).iter().flatten().zip(values.iter().flatten()) {
            // Radiance's pixels share an exponent: the small values beside 1024 are lost.
            let tolerance = if format == ImageFormat::Hdr { 4.1 } else { 0.0 };
            assert!((got - wanted).abs() <= tolerance, "{name}: {got} for {wanted}");
        }
    }
    let old = String::from_utf8_lossy(&encoded(&picture, ImageFormat::Hdr)[..]).starts_with("#?RADIANCE");
    assert!(old, "the mark that the next file lacks");
    let text = b"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x20\x81".to_vec();
    assert_eq!(floats(&load("old.hdr", text)), [[1.0, 0.5, 0.25]]);
}

#[test]
fn no_float_is_nan_or_infinite() {
    let values = [[f32::NAN, f32::INFINITY, f32::NEG_INFINITY], [-1.0, 0.0, f32::MAX]];
    let picture = DynamicImage::ImageRgb32F(ImageBuffer::from_fn(2, 1, |x, _| Rgb(values[x as usize])));
    let image = load("a.exr", encoded(&picture, ImageFormat::OpenExr));
    assert_eq!(floats(&image), [[0.0, f32::MAX, f32::MIN], [-1.0, 0.0, f32::MAX]]);
}

#[test]
fn the_contents_decide_and_not_the_name() {
    let bytes = encoded(&colourful(3, 2).into(), ImageFormat::Png);
    for name in ["a.jpg", "a.exr", "a", "a.tga"] {
        assert_eq!(load(name, &bytes).width, 3, "{name}");
    }
    let text = "v 0 0 0\n";
    insta::assert_snapshot!(problem("a.png", text), @"this is no image of a known kind; expected PNG, JPEG, BMP, TGA, GIF, WebP, QOI, PNM, HDR or EXR");
    insta::assert_snapshot!(problem("a.tga", text), @"the TGA data end too early");
    insta::assert_snapshot!(problem("a.png", ""), @"the file is empty");
    insta::assert_snapshot!(problem("a.png", b"II*\0\x08\0\0\0\0\0\0\0"), @"it is TIFF, which is not supported; expected PNG, JPEG, BMP, TGA, GIF, WebP, QOI, PNM, HDR or EXR");
}

#[test]
fn a_missing_file_and_a_folder_are_file_errors() {
    let folder = tempfile::tempdir().unwrap();
    let missing = load_image(&folder.path().join("gone.png")).unwrap_err();
    assert!(missing.to_string().starts_with("cannot read the image '"), "{missing}");
    assert!(matches!(load_image(folder.path()), Err(Error::File { action: "read the image", .. })));
}

#[test]
fn files_cut_short_are_errors_wherever_the_cut_is() {
    let opaque: DynamicImage = DynamicImage::ImageRgba8(colourful(20, 20)).into_rgb8().into();
    let float = DynamicImage::ImageRgb32F(opaque.to_rgb32f());
    for (format, name, picture) in [
        (ImageFormat::Png, "a.png", &opaque),
        (ImageFormat::Jpeg, "a.jpg", &opaque),
        (ImageFormat::Bmp, "a.bmp", &opaque),
        (ImageFormat::Tga, "a.tga", &opaque),
        (ImageFormat::Gif, "a.gif", &opaque),
        (ImageFormat::WebP, "a.webp", &opaque),
        (ImageFormat::Pnm, "a.ppm", &opaque),
        (ImageFormat::Hdr, "a.hdr", &float),
        (ImageFormat::OpenExr, "a.exr", &float),
    ] {
        let whole = encoded(picture, format);
        load(name, &whole);
        for kept in (0..whole.len() * 9 / 10).step_by(whole.len().div_ceil(23)) {
            let file = file(name, &whole[..kept]);
            let outcome = load_image(&file.path);
            assert!(matches!(outcome, Err(Error::Format { .. })), "{name}: {kept} of {} bytes", whole.len());
        }
    }
    let jpeg = encoded(&opaque, ImageFormat::Jpeg);
    insta::assert_snapshot!(problem("a.jpg", &jpeg[..jpeg.len() - 2]), @"the JPEG data end too early");
    let whole = encoded(&opaque, ImageFormat::Png);
    insta::assert_snapshot!(problem("a.png", &whole[..whole.len() / 2]), @"the PNG data end too early");
}

#[test]
fn damaged_files_do_not_panic() {
    let picture: DynamicImage = DynamicImage::ImageRgba8(colourful(6, 5)).into_rgb8().into();
    let float = DynamicImage::ImageRgb32F(picture.to_rgb32f());
    let mut errors = 0;
    for (format, name) in [
        (ImageFormat::Png, "a.png"),
        (ImageFormat::Jpeg, "a.jpg"),
        (ImageFormat::Bmp, "a.bmp"),
        (ImageFormat::Tga, "a.tga"),
        (ImageFormat::Gif, "a.gif"),
        (ImageFormat::WebP, "a.webp"),
        (ImageFormat::Qoi, "a.qoi"),
        (ImageFormat::Pnm, "a.ppm"),
        (ImageFormat::Hdr, "a.hdr"),
        (ImageFormat::OpenExr, "a.exr"),
    ] {
        let source = if [ImageFormat::Hdr, ImageFormat::OpenExr].contains(&format) { &float } else { &picture };
        let whole = encoded(source, format);
        for turn in 0..60usize {
            let mut damaged = whole.clone();
            let at = turn * 7919 % damaged.len();
            damaged[at] ^= (1 << (turn % 8)) as u8 | 0x80;
            match load_image(&file(name, &damaged).path) {
                Ok(image) => assert!(image.width > 0 && image.height > 0),
                Err(Error::Format { .. }) => errors += 1,
                Err(other) => panic!("{name}: {other:?}"),
            }
        }
    }
    assert!(errors > 100, "only {errors} of 600 damaged files were refused");
}

#[test]
fn huge_images_are_refused_before_they_are_decoded() {
    // Kilobytes that claim gigabytes: the header alone is read.
    let bomb = |width: u32, height: u32, bits: u8| {
        let mut header = Vec::new();
        header.extend(width.to_be_bytes());
        header.extend(height.to_be_bytes());
        header.extend([bits, 6, 0, 0, 0]);
        png_chunks(&[(b"IHDR", &header), (b"IDAT", &stored_zlib(&[0; 100])), (b"IEND", &[])])
    };
    insta::assert_snapshot!(problem("a.png", bomb(1_000_000, 1_000_000, 8)), @"it is 1000000 x 1000000 pixels, more than 16384 on an edge");
    insta::assert_snapshot!(problem("a.png", bomb(16385, 1, 8)), @"it is 16385 x 1 pixels, more than 16384 on an edge");
    insta::assert_snapshot!(problem("a.png", bomb(16384, 16384, 8)), @"it is 16384 x 16384 pixels, which take 1024 MiB, more than 512 MiB");
    insta::assert_snapshot!(problem("a.png", bomb(16384, 8192, 16)), @"it is 16384 x 8192 pixels, which take 1024 MiB, more than 512 MiB");
    insta::assert_snapshot!(problem("a.ppm", "P6 60000 60000 255\n"), @"it is 60000 x 60000 pixels, more than 16384 on an edge");
    insta::assert_snapshot!(problem("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\n"), @"it is 16384 x 16384 pixels, which take 3072 MiB, more than 512 MiB");
}

#[test]
fn images_without_pixels_are_refused() {
    let none = png_chunks(&[(b"IHDR", &[0, 0, 0, 0, 0, 0, 0, 1, 8, 6, 0, 0, 0]), (b"IEND", &[])]);
    insta::assert_snapshot!(problem("a.png", none), @"the PNG data cannot be read: Format error decoding Png: Invalid image dimensions");
    insta::assert_snapshot!(problem("a.qoi", b"qoif\0\0\0\0\0\0\0\x01\x04\0"), @"the QOI data cannot be read: Format error decoding Qoi: invalid image dimensions: 0x1");
    insta::assert_snapshot!(problem("a.tga", [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 24, 0]), @"the TGA data cannot be read: Format error decoding Tga: Invalid empty image");
}

/// A PNG of these chunks, with their checksums.
fn png_chunks(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, data) in chunks {
        bytes.extend((data.len() as u32).to_be_bytes());
        bytes.extend(*kind);
        bytes.extend(*data);
        let checked = kind.iter().chain(data.iter());
        let crc = checked.fold(!0u32, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 * (crc & 1)))
        });
        bytes.extend((!crc).to_be_bytes());
    }
    bytes
}

/// The data as one stored block (RFC 1950, RFC 1951 section 3.2.4).
fn stored_zlib(data: &[u8]) -> Vec<u8> {
    let length = data.len() as u16;
    let mut bytes = vec![0x78, 0x01, 1];
    bytes.extend(length.to_le_bytes());
    bytes.extend((!length).to_le_bytes());
    bytes.extend(data);
    let (a, b) = data.iter().fold((1u32, 0u32), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % 65521;
        (a, (b + a) % 65521)
    });
    bytes.extend(((b << 16) | a).to_be_bytes());
    bytes
}
