//! The film: exact sums, means, transfer, alpha, and files that are whole or not there.

use gpu_trace::film::{
    FILM_SCALE, Film, OutputFormat, check_writable, decode_srgb, encode, quantise, write_atomically, write_picture,
};
use gpu_trace::layout::FilmPixel;
use gpu_trace::scene::Transfer;
use gpu_trace::{Error, Result};
use image::{DynamicImage, Rgb, Rgba};
use proptest::prelude::*;
use std::fs;
use std::io;
use std::path::Path;
use tempfile::TempDir;

/// A film of one pixel with this mean, at 3 samples.
fn film_of(mean: [f64; 4]) -> Film {
    let mut film = Film::new(1, 1);
    film.samples = 3;
    film.pixels[0] = mean.map(|value| (value * FILM_SCALE * 3.0).round() as i64);
    film
}

fn split(sums: [i64; 4]) -> FilmPixel {
    FilmPixel { low: sums.map(|sum| sum as u32), high: sums.map(|sum| (sum as u64 >> 32) as u32) }
}

fn entries(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    names.map(|name| name.into_string().expect("an ASCII name")).collect()
}

fn film_strategy() -> impl Strategy<Value = Film> {
    let sums = prop::array::uniform4(-(1_i64 << 44)..1 << 44);
    (prop::collection::vec(sums, 6), 0..1000_u32).prop_map(|(pixels, samples)| Film {
        width: 3,
        height: 2,
        samples,
        pixels,
    })
}

proptest! {
    #[test]
    fn films_merge_in_any_order(a in film_strategy(), b in film_strategy(), c in film_strategy()) {
        let merge = |films: [&Film; 3]| -> Film {
            let mut sum = Film::new(3, 2);
            for film in films {
                sum.merge(film).expect("films of one size");
            }
            sum
        };
        let sum = merge([&a, &b, &c]);
        prop_assert_eq!(&sum, &merge([&c, &a, &b]));
        prop_assert_eq!(&sum, &merge([&b, &c, &a]));
        prop_assert_eq!(sum.samples, a.samples + b.samples + c.samples);
        prop_assert_eq!(sum.pixels[5][3], a.pixels[5][3] + b.pixels[5][3] + c.pixels[5][3]);
    }

    /// Bands hold two's complement in two words: negative sums and carries past 32 bits come through.
    #[test]
    fn bands_add_as_64_bit_integers(sums in prop::collection::vec(prop::array::uniform4(-(1_i64 << 62)..1 << 62), 4)) {
        let mut film = Film::new(2, 3);
        let band: Vec<FilmPixel> = sums.iter().copied().map(split).collect();
        film.add_band(1, &band);
        prop_assert_eq!(&film.pixels[..2], &[[0; 4]; 2]);
        prop_assert_eq!(&film.pixels[2..], sums.as_slice());
    }

    /// The nearest of 256 levels is never further than half a level, for values of the range.
    #[test]
    fn quantising_takes_the_nearest_level(value in 0.0..=1.0_f64) {
        prop_assert!((f64::from(quantise(value)) - value * 255.0).abs() <= 0.5 + 1e-12);
    }

    #[test]
    fn srgb_is_undone_by_its_inverse(value in 0.0..=1.0_f64) {
        prop_assert!((decode_srgb(encode(Transfer::Srgb, value)) - value).abs() < 2e-6);
    }
}

#[test]
fn a_carry_and_a_borrow_cross_the_words() {
    let mut film = Film::new(1, 1);
    for sums in [[0xffff_ffff, -1, 1, 0], [1, 1, -2, -(1 << 32)]] {
        film.add_band(0, &[split(sums)]);
    }
    assert_eq!(film.pixels[0], [1 << 32, 0, -1, -(1 << 32)]);
}

#[test]
fn a_band_past_the_last_row_is_cut_off() {
    let mut film = Film::new(1, 2);
    film.add_band(1, &[split([1; 4]), split([2; 4])]);
    film.add_band(9, &[split([3; 4])]);
    assert_eq!(film.pixels, [[0; 4], [1; 4]]);
}

#[test]
fn films_that_do_not_fit_are_not_merged() {
    let mut film = film_of([0.5; 4]);
    let before = film.clone();
    let error = film.merge(&Film::new(2, 1)).expect_err("another size").to_string();
    assert!(error.contains("2x1") && error.contains("1x1"), "{error}");
    let many = Film { samples: u32::MAX, ..before.clone() };
    assert!(film.merge(&many).is_err(), "the number of samples does not fit 32 bits");
    assert_eq!(film, before);
}

#[test]
fn sizes_are_checked() {
    assert!(Film::check_size(1, 1).is_ok() && Film::check_size(16384, 16384).is_ok());
    for (width, height) in [(0, 5), (5, 0), (16384, 16385), (u32::MAX, u32::MAX)] {
        assert!(Film::check_size(width, height).is_err(), "{width}x{height}");
    }
}

#[test]
fn radiance_is_the_mean_unclamped() {
    let mut film = Film::new(2, 2);
    film.samples = 2;
    film.pixels[3] = [3.0, -1.0, 0.5, 2.0].map(|sum: f64| (sum * FILM_SCALE) as i64);
    assert_eq!(film.radiance(1, 1), [1.5, -0.5, 0.25, 1.0]);
    assert_eq!(film.radiance(1, 0), [0.0; 4]);
    assert_eq!(Film::new(1, 1).radiance(0, 0), [0.0; 4], "no samples");
}

#[test]
fn linear_values_are_rounded_to_the_nearest_and_clamped() {
    for (value, expected) in [
        (0.0, 0),
        (0.49 / 255.0, 0),
        (0.51 / 255.0, 1),
        (127.49 / 255.0, 127),
        (127.51 / 255.0, 128),
        (254.51 / 255.0, 255),
        (1.0, 255),
        (7.0, 255),
        (-0.5, 0),
    ] {
        let image = film_of([value, value, value, 1.0]).resolve(Transfer::Linear, false).into_rgb8();
        assert_eq!(image.get_pixel(0, 0), &Rgb([expected; 3]), "{value}");
    }
    assert_eq!(quantise(f64::NAN), 0);
}

/// Values of IEC 61966-2-1 as they are tabulated everywhere: 18 % grey is 118, middle grey 188.
#[test]
fn srgb_follows_the_standard() {
    for (linear, expected) in [(0.0, 0), (0.002, 7), (0.18, 118), (0.5, 188), (1.0, 255), (3.0, 255), (-1.0, 0)] {
        let film = film_of([linear, linear, linear, 1.0]);
        let image = film.resolve(Transfer::Srgb, false).into_rgb8();
        assert_eq!(image.get_pixel(0, 0), &Rgb([expected; 3]), "{linear}");
    }
    // The two pieces of the curve meet.
    let [below, above] = [0.003_130_7, 0.003_130_9].map(|linear| encode(Transfer::Srgb, linear));
    assert!((below - above).abs() < 1e-5, "{below} {above}");
}

#[test]
fn transparent_pictures_have_straight_alpha() {
    // A quarter of the pixel is covered by (0.8, 0.4, 0): the sums hold colour times coverage.
    let film = film_of([0.2, 0.1, 0.0, 0.25]);
    let image = film.resolve(Transfer::Linear, true);
    assert!(matches!(image, DynamicImage::ImageRgba8(_)));
    assert_eq!(image.into_rgba8().get_pixel(0, 0), &Rgba([204, 102, 0, 64]));
    // The curve is for colours; alpha stays linear.
    let curved = film.resolve(Transfer::Srgb, true).into_rgba8();
    assert_eq!(curved.get_pixel(0, 0), &Rgba([231, 170, 0, 64]));
    let nothing = film_of([0.0; 4]).resolve(Transfer::Srgb, true).into_rgba8();
    assert_eq!(nothing.get_pixel(0, 0), &Rgba([0; 4]));
}

#[test]
fn pictures_are_read_back_as_they_were_written() -> Result<()> {
    let folder = TempDir::new().expect("a temporary folder");
    let mut film = Film::new(5, 3);
    film.samples = 1;
    for (index, pixel) in film.pixels.iter_mut().enumerate() {
        *pixel = [index as f64 / 15.0, 0.5, 1.0, 0.5].map(|value| (value * FILM_SCALE) as i64);
    }
    for transparent in [false, true] {
        let path = folder.path().join(format!("new/folders/{transparent}.PNG"));
        write_picture(&film, &path, Transfer::Srgb, transparent)?;
        let read = image::open(&path).expect("a picture");
        assert_eq!(read, film.resolve(Transfer::Srgb, transparent));
        assert_eq!(read.color().has_alpha(), transparent);
    }
    assert_eq!(entries(&folder.path().join("new/folders")).len(), 2, "no temporary files stay");
    Ok(())
}

#[test]
fn other_formats_are_refused_by_name() {
    for name in ["picture.jpg", "picture", "png", ".png", "picture.png.bak"] {
        let error = OutputFormat::from_path(Path::new(name)).expect_err(name).to_string();
        assert!(error.contains(".png") && error.contains(name), "{error}");
    }
    assert_eq!(OutputFormat::from_path(Path::new("a.b/c.PnG")).ok(), Some(OutputFormat::Png));
}

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path().join("file.txt");
    fs::write(&path, "old").expect("a writable folder");
    let error = write_atomically("write the test", &path, |out| {
        out.write_all(b"half of the new")?;
        Err(io::Error::other("the disk is full"))
    })
    .expect_err("the closure's error");
    assert!(matches!(&error, Error::File { action: "write the test", .. }));
    assert!(error.to_string().ends_with("the disk is full"), "{error}");
    assert_eq!(fs::read_to_string(&path).ok().as_deref(), Some("old"));
    assert_eq!(entries(folder.path()), ["file.txt"]);
}

#[test]
fn what_cannot_be_written_is_known_before() {
    let folder = TempDir::new().expect("a temporary folder");
    let file = folder.path().join("file");
    fs::write(&file, "").expect("a writable folder");
    let long = "x".repeat(300);
    // Not a folder above, a folder in the way, a name that no file system takes.
    for path in [file.join("a.png"), folder.path().to_owned(), folder.path().join(long), file.join("b/c/d.png")] {
        assert!(check_writable("test", &path).is_err(), "{}", path.display());
        assert!(write_atomically("test", &path, |_| Ok(())).is_err(), "{}", path.display());
    }
    check_writable("test", &folder.path().join("not/yet/there.png")).expect("folders can be made");
    check_writable("test", &file).expect("a file can be replaced");
    assert_eq!(entries(folder.path()), ["file"], "checking makes nothing");
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).expect("a file").permissions().mode() & 0o777
    }

    #[test]
    fn permissions_are_those_of_any_created_file_or_stay() {
        let folder = TempDir::new().expect("a temporary folder");
        let [plain, ours] = ["plain", "ours"].map(|name| folder.path().join(name));
        fs::write(&plain, "").expect("a writable folder");
        write_atomically("test", &ours, |_| Ok(())).expect("a writable folder");
        assert_eq!(mode(&ours), mode(&plain), "the umask decides");
        fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).expect("our own file");
        write_atomically("test", &ours, |_| Ok(())).expect("a writable file");
        assert_eq!(mode(&ours), 0o640);
    }

    #[test]
    fn a_link_stays_and_its_target_is_replaced() {
        let folder = TempDir::new().expect("a temporary folder");
        let [target, link] = ["target", "link"].map(|name| folder.path().join(name));
        fs::write(&target, "old").expect("a writable folder");
        symlink(&target, &link).expect("a link");
        write_atomically("test", &link, |out| out.write_all(b"new")).expect("a writable file");
        assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
        assert_eq!(fs::read_to_string(&target).ok().as_deref(), Some("new"));
    }
}
