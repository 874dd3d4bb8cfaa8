//! YUV4MPEG2, uncompressed, which video programs read from a pipe: `W`idth, `H`eight, `F`rame rate, progressive, square
//! pixels, and three full planes a frame (C444), of limited range.

use super::{FrameSink, Shape};
use image::DynamicImage;
use std::io::{self, Write};

pub(super) struct Y4m<W: Write> {
    out: W,
}

impl<W: Write> Y4m<W> {
    pub fn new(mut out: W, shape: &Shape) -> io::Result<Self> {
        let Shape { width, height, rate, .. } = shape;
        let (numerator, denominator) = (rate.numerator(), rate.denominator());
        writeln!(
            out,
            "YUV4MPEG2 W{width} H{height} F{numerator}:{denominator} Ip A1:1 C444 XYSCSS=444 XCOLORRANGE=LIMITED"
        )?;
        Ok(Y4m { out })
    }
}

impl<W: Write + Send> FrameSink for Y4m<W> {
    fn add(&mut self, picture: &DynamicImage) -> io::Result<()> {
        let rgb = picture.to_rgb8();
        let mut planes = [const { Vec::new() }; 3];
        for pixel in rgb.pixels() {
            for (plane, value) in planes.iter_mut().zip(rgb_to_ycbcr(pixel.0)) {
                plane.push(value);
            }
        }
        self.out.write_all(b"FRAME\n")?;
        planes.iter().try_for_each(|plane| self.out.write_all(plane))?;
        self.out.flush()
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.out.flush()
    }
}

/// Y'CbCr of ITU-R BT.601 in limited range, Y' in 16..=235, Cb and Cr in 16..=240 about 128, from R'G'B' in 0..=255:
/// what programs take an untagged y4m stream to hold. Rounded to the nearest, so that the way back is off by 2 of 255
/// at most.
pub fn rgb_to_ycbcr([red, green, blue]: [u8; 3]) -> [u8; 3] {
    const KR: f64 = 0.299;
    const KB: f64 = 0.114;
    let [red, green, blue] = [red, green, blue].map(|value| f64::from(value) / 255.0);
    let luma = KR * red + (1.0 - KR - KB) * green + KB * blue;
    let chroma = |value: f64, weight: f64| 128.0 + 224.0 * (value - luma) / (2.0 * (1.0 - weight));
    [16.0 + 219.0 * luma, chroma(blue, KB), chroma(red, KR)].map(|value| value.round() as u8)
}
