//! The comparison of pictures, on pictures whose differences are known, and on some that it must reject.

use gpu_trace::film::{Comparison, Mask, compare_images, compare_masked};
use image::{DynamicImage, Rgb, RgbImage, Rgba, RgbaImage};

/// A smooth picture with an edge in it.
fn pattern() -> RgbImage {
    RgbImage::from_fn(40, 25, |x, y| if x < 20 { Rgb([(x * 5) as u8, (y * 8) as u8, 60]) } else { Rgb([220, 180, 40]) })
}

fn compare(a: RgbImage, b: RgbImage) -> Comparison {
    compare_images(&DynamicImage::ImageRgb8(a), &DynamicImage::ImageRgb8(b)).expect("pictures of one size")
}

#[test]
fn a_picture_is_like_itself() {
    let comparison = compare(pattern(), pattern());
    let expected =
        Comparison { flip_mean: 0.0, psnr_db: f64::INFINITY, differing_share: 0.0, max_difference: 0, pixels: 1000 };
    assert_eq!(comparison, expected);
    assert_eq!(comparison.to_string(), "FLIP mean 0.0000  PSNR inf dB  0.00 % of pixels differ by more than 2/255");
}

#[test]
fn one_pixel_off_by_three_is_found_and_by_two_is_not() {
    for (difference, share) in [(2, 0.0), (3, 0.001)] {
        let mut other = pattern();
        other.get_pixel_mut(7, 7)[1] += difference;
        let comparison = compare(pattern(), other);
        assert_eq!(comparison.differing_share, share);
        assert_eq!(comparison.max_difference, difference);
        // One channel of 3000: the mean square is d² / 3000.
        let psnr = 10.0 * (255.0_f64.powi(2) * 3000.0 / f64::from(difference).powi(2)).log10();
        assert!((comparison.psnr_db - psnr).abs() < 1e-9, "{comparison}");
        assert!(comparison.flip_mean > 0.0 && comparison.flip_mean < 0.001, "{comparison}");
    }
}

#[test]
fn the_line_shows_share_and_decibels() {
    let mut other = pattern();
    for x in 0..10 {
        other.get_pixel_mut(x, 3)[2] -= 60;
    }
    let comparison = compare(pattern(), other);
    assert_eq!(comparison.differing_share, 0.01);
    let line = comparison.to_string();
    // 10 log10(255² * 3000 / (10 * 60²)) = 37.3 dB.
    assert!(line.ends_with("  PSNR 37.3 dB  1.00 % of pixels differ by more than 2/255"), "{line}");
}

/// Black against white is the largest error there is, wherever the filters look.
#[test]
fn opposite_pictures_are_as_different_as_can_be() {
    let comparison = compare(RgbImage::new(16, 16), RgbImage::from_pixel(16, 16, Rgb([255; 3])));
    assert!(comparison.flip_mean > 0.9 && comparison.flip_mean <= 1.0, "{comparison}");
    assert_eq!((comparison.psnr_db, comparison.differing_share, comparison.max_difference), (0.0, 1.0, 255));
}

/// Negative control: what parity tests accept (FLIP at most 0.002, 0.1 % of the pixels) a shifted picture fails.
#[test]
fn a_shifted_picture_is_rejected() {
    let original = pattern();
    let shifted = RgbImage::from_fn(40, 25, |x, y| *original.get_pixel(x.saturating_sub(1), y));
    let comparison = compare(original, shifted);
    assert!(comparison.flip_mean > 0.002 && comparison.differing_share > 0.001, "{comparison}");
}

#[test]
fn pictures_of_one_pixel_are_compared() {
    let comparison = compare(RgbImage::new(1, 1), RgbImage::from_pixel(1, 1, Rgb([3, 0, 0])));
    assert_eq!((comparison.differing_share, comparison.pixels), (1.0, 1));
}

#[test]
fn sizes_must_match() {
    let [a, b] = [(3, 4), (4, 3)].map(|(width, height)| DynamicImage::new_rgb8(width, height));
    let error = compare_images(&a, &b).expect_err("two sizes").to_string();
    assert!(error.contains("3x4") && error.contains("4x3"), "{error}");
}

#[test]
fn the_mask_takes_the_reference_where_it_covers() {
    // Covered in the left half; the other picture has a wrong background, and one wrong pixel inside.
    let reference = RgbaImage::from_fn(10, 10, |x, _| if x < 5 { Rgba([90, 60, 30, 255]) } else { Rgba([0; 4]) });
    let mut other = RgbImage::from_fn(10, 10, |x, _| if x < 5 { Rgb([90, 60, 30]) } else { Rgb([0, 0, 250]) });
    let reference = DynamicImage::ImageRgba8(reference);
    let outside = compare_masked(&reference, &DynamicImage::ImageRgb8(other.clone()), Mask::Alpha).expect("comparable");
    assert_eq!((outside.flip_mean, outside.differing_share, outside.pixels), (0.0, 0.0, 50));
    other.get_pixel_mut(2, 2)[0] = 200;
    let inside = compare_masked(&reference, &DynamicImage::ImageRgb8(other.clone()), Mask::Alpha).expect("comparable");
    assert_eq!((inside.differing_share, inside.max_difference), (0.02, 110));
    assert!(inside.flip_mean > 0.0);
    // Without the mask the background counts, and so does alpha.
    let all = compare_images(&reference, &DynamicImage::ImageRgb8(other)).expect("comparable");
    assert_eq!((all.differing_share, all.max_difference, all.pixels), (0.51, 255, 100));
}

/// An object that the second picture lacks is inside the mask, whatever that picture's alpha says.
#[test]
fn a_missing_object_is_not_masked_away() {
    let reference = DynamicImage::ImageRgba8(RgbaImage::from_pixel(8, 8, Rgba([200, 100, 50, 255])));
    let comparison = compare_masked(&reference, &DynamicImage::new_rgba8(8, 8), Mask::Alpha).expect("comparable");
    assert_eq!(comparison.differing_share, 1.0);
}

#[test]
fn a_mask_needs_alpha_that_is_not_empty() {
    let [opaque, empty] = [DynamicImage::new_rgb8(2, 2), DynamicImage::new_rgba8(2, 2)];
    let error = compare_masked(&opaque, &empty, Mask::Alpha).expect_err("no alpha").to_string();
    assert!(error.contains("alpha"), "{error}");
    let error = compare_masked(&empty, &opaque, Mask::Alpha).expect_err("nothing covered").to_string();
    assert!(error.contains("empty"), "{error}");
}

#[test]
fn what_transparent_pixels_hold_does_not_matter_but_alpha_does() {
    let rgba = |pixel| DynamicImage::ImageRgba8(RgbaImage::from_pixel(4, 4, Rgba(pixel)));
    let hidden = compare_images(&rgba([255, 0, 0, 0]), &rgba([0, 255, 0, 0])).expect("comparable");
    assert_eq!(hidden.max_difference, 0);
    let coverage = compare_images(&rgba([0, 0, 0, 255]), &rgba([0, 0, 0, 100])).expect("comparable");
    assert_eq!((coverage.max_difference, coverage.differing_share), (155, 1.0));
}
