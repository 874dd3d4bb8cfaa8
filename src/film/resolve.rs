//! From sums to means, and from means to 8-bit pixels.

use super::transfer::{encode, quantise};
use super::{FILM_SCALE, Film};
use crate::scene::Transfer;
use image::{DynamicImage, Rgb, RgbImage, Rgba, RgbaImage};

impl Film {
    /// Mean of a pixel's samples: linear (red, green, blue, coverage), the colours multiplied by the coverage, and
    /// neither clamped. A film without samples is black and uncovered.
    ///
    /// # Panics
    /// Where the pixel lies outside the picture.
    pub fn radiance(&self, x: u32, y: u32) -> [f32; 4] {
        assert!(x < self.width && y < self.height, "pixel ({x}, {y}) of a {}x{} film", self.width, self.height);
        self.mean(self.pixels[y as usize * self.width as usize + x as usize]).map(|value| value as f32)
    }

    /// The picture as 8-bit values: means clamped to [0, 1], through the transfer curve, rounded to the nearest.
    ///
    /// An opaque picture (`Rgb8`) shows the colours as they are. A transparent one (`Rgba8`) has straight alpha, as
    /// PNG wants it: the colours are divided by the coverage, and alpha is the coverage, which is linear whatever the
    /// curve. Pixels that nothing covers are (0, 0, 0, 0).
    pub fn resolve(&self, transfer: Transfer, transparent: bool) -> DynamicImage {
        // Clamping first keeps the curve off negative values, where it is not defined.
        let value = |linear: f64| quantise(encode(transfer, linear.clamp(0.0, 1.0)));
        if transparent {
            let mut image = RgbaImage::new(self.width, self.height);
            for (pixel, sum) in image.pixels_mut().zip(&self.pixels) {
                let [red, green, blue, coverage] = self.mean(*sum);
                if coverage > 0.0 {
                    let [red, green, blue] = [red, green, blue].map(|channel| value(channel / coverage));
                    *pixel = Rgba([red, green, blue, quantise(coverage)]);
                }
            }
            DynamicImage::ImageRgba8(image)
        } else {
            let mut image = RgbImage::new(self.width, self.height);
            for (pixel, sum) in image.pixels_mut().zip(&self.pixels) {
                let [red, green, blue, _] = self.mean(*sum);
                *pixel = Rgb([red, green, blue].map(value));
            }
            DynamicImage::ImageRgb8(image)
        }
    }

    fn mean(&self, sum: [i64; 4]) -> [f64; 4] {
        let unit = FILM_SCALE * f64::from(self.samples.max(1));
        sum.map(|value| value as f64 / unit)
    }
}
