//! Clips decode to the frames that were rendered. Each comparison must also reject the frame after.

use super::*;
use gpu_trace::film::clip::rgb_to_ycbcr;
use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder, RgbImage};
use predicates::prelude::*;
use predicates::str::contains;
use std::io::Cursor;

const FRAMES: u32 = 3;

/// A folder with frames 1 to 3 as `N.png`, and what the program wrote to standard output for the clip.
fn with_clip(scene: &str, output: &str) -> (TempDir, Vec<u8>) {
    let folder = folder(scene);
    program(folder.path(), "scene.lua --frames 1..3 -o %d.png -q --fps 30").assert().success();
    let line = format!("scene.lua --frames 1..3 -o {output} -q --fps 30");
    let run = program(folder.path(), &line).assert().success().stderr("");
    let stdout = run.get_output().stdout.clone();
    (folder, stdout)
}

fn frame(folder: &TempDir, number: u32) -> image::DynamicImage {
    image::open(folder.path().join(format!("{number}.png"))).expect("a frame")
}

fn frames(folder: &TempDir) -> Vec<RgbImage> {
    (1..=FRAMES).map(|number| frame(folder, number).into_rgb8()).collect()
}

fn largest_difference(a: &RgbImage, b: &RgbImage) -> u8 {
    assert_eq!(a.dimensions(), b.dimensions());
    a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

fn mean_difference(a: &RgbImage, b: &RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let sum: f64 = a.iter().zip(b.iter()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    sum / a.len() as f64
}

/// Each decoded frame is near its own, and farther from the next one by far.
fn assert_alike(decoded: &[RgbImage], expected: &[RgbImage], tolerance: f64, measure: fn(&RgbImage, &RgbImage) -> f64) {
    assert_eq!(decoded.len(), expected.len());
    for (index, picture) in decoded.iter().enumerate() {
        let own = measure(picture, &expected[index]);
        assert!(own <= tolerance, "frame {} differs by {own}", index + 1);
        let other = measure(picture, &expected[(index + 1) % expected.len()]);
        assert!(other > 2.0 * tolerance, "frame {} differs from the next by {other} only", index + 1);
    }
}

#[test]
fn y4m_decodes_to_the_frames() {
    let (folder, stream) = with_clip(&swing(""), "-");
    let (header, mut rest) = stream.split_at(stream.iter().position(|byte| *byte == b'\n').expect("a header") + 1);
    let header = String::from_utf8_lossy(header);
    assert!(header.starts_with("YUV4MPEG2 W32 H24 F30:1 Ip A1:1 C444 "), "{header}");
    let mut decoded = Vec::new();
    while !rest.is_empty() {
        let plane = 32 * 24;
        let (mark, data) = rest.split_at(6);
        assert_eq!(mark, b"FRAME\n");
        let pixel = |index: usize| [data[index], data[plane + index], data[2 * plane + index]];
        decoded.push(RgbImage::from_fn(32, 24, |x, y| image::Rgb(ycbcr_to_rgb(pixel((y * 32 + x) as usize)))));
        rest = &data[3 * plane..];
    }
    // A step of Y' is 255/219, of Cb and Cr 255/224 of their ranges: half of each, by the weights of BT.601, comes to
    // less than 2.
    assert_alike(&decoded, &frames(&folder), 2.0, |a, b| f64::from(largest_difference(a, b)));
}

/// The inverse of BT.601 in limited range, by its published matrix of rounded coefficients.
fn ycbcr_to_rgb([y, cb, cr]: [u8; 3]) -> [u8; 3] {
    let (y, cb, cr) = (1.164_384 * (f64::from(y) - 16.0), f64::from(cb) - 128.0, f64::from(cr) - 128.0);
    [y + 1.596_027 * cr, y - 0.391_762 * cb - 0.812_968 * cr, y + 2.017_232 * cb].map(|value| value.round() as u8)
}

#[test]
fn the_colours_of_y4m_have_their_published_values() {
    // 75 % colour bars of ITU-R BT.801, 8 bits, at 100 %: white, yellow, green, blue, black.
    for (rgb, ycbcr) in [
        ([255, 255, 255], [235, 128, 128]),
        ([255, 255, 0], [210, 16, 146]),
        ([0, 255, 0], [145, 54, 34]),
        ([0, 0, 255], [41, 240, 110]),
        ([0, 0, 0], [16, 128, 128]),
    ] {
        assert_eq!(rgb_to_ycbcr(rgb), ycbcr, "{rgb:?}");
    }
    let mut worst = 0;
    for colour in 0..1 << 15 {
        let rgb = [colour & 31, colour >> 5 & 31, colour >> 10].map(|value| (value * 255 / 31) as u8);
        let back = ycbcr_to_rgb(rgb_to_ycbcr(rgb));
        worst = rgb.iter().zip(back).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0).max(worst);
    }
    assert!(worst <= 2, "the way back is off by {worst}");
}

#[test]
fn gif_decodes_to_the_frames() {
    let (folder, _) = with_clip(&swing(""), "clip.gif");
    let decoder = GifDecoder::new(Cursor::new(read(folder.path(), "clip.gif"))).expect("a GIF");
    let decoded = decoder.into_frames().collect_frames().expect("frames");
    let delays: Vec<_> = decoded.iter().map(|frame| frame.delay().numer_denom_ms()).collect();
    // A thirtieth of a second, rounded so that the whole lasts a tenth.
    assert_eq!(delays, [(30, 1), (40, 1), (30, 1)]);
    let pictures: Vec<_> =
        decoded.iter().map(|frame| image::DynamicImage::from(frame.buffer().clone()).into_rgb8()).collect();
    // 256 colours for 768 pixels: each is near one of them.
    assert_alike(&pictures, &frames(&folder), 2.0, mean_difference);
}

#[test]
fn gif_knows_transparency_and_leaves_no_trace_of_the_frame_before() {
    let (folder, _) = with_clip(&swing("gr.background('transparent')"), "clip.gif");
    let decoder = GifDecoder::new(Cursor::new(read(folder.path(), "clip.gif"))).expect("a GIF");
    let decoded = decoder.into_frames().collect_frames().expect("frames");
    for (number, frame_of_clip) in (1..).zip(&decoded) {
        let expected = frame(&folder, number).into_rgba8();
        let (mut seen, mut clear) = (0, 0);
        for (own, other) in expected.pixels().zip(frame_of_clip.buffer().pixels()) {
            assert_eq!(own[3] >= 128, other[3] == 255, "frame {number}: {own:?} became {other:?}");
            if other[3] == 255 { seen += 1 } else { clear += 1 }
        }
        assert!(seen > 50 && clear > 50, "{seen} pixels show something, {clear} nothing");
    }
}

#[test]
fn apng_decodes_to_the_very_frames() {
    for extra in ["", "gr.background('transparent')"] {
        let (folder, _) = with_clip(&swing(extra), "clip.apng");
        let decoder = PngDecoder::new(Cursor::new(read(folder.path(), "clip.apng"))).expect("a PNG");
        assert!(decoder.is_apng().expect("a PNG"), "it is a still picture");
        let decoded = decoder.apng().expect("an APNG").into_frames().collect_frames().expect("frames");
        assert_eq!(decoded.len() as u32, FRAMES);
        for (number, picture) in (1..).zip(&decoded) {
            assert_eq!(*picture.buffer(), frame(&folder, number).into_rgba8(), "frame {number}");
            assert_ne!(*picture.buffer(), frame(&folder, number % FRAMES + 1).into_rgba8(), "frame {number}");
            let (numerator, denominator) = picture.delay().numer_denom_ms();
            assert_eq!((numerator as f64 / f64::from(denominator)).round(), 33.0);
        }
    }
}

const NEEDS_FFMPEG: &str = "this test needs ffmpeg: run tests/run, or 'apt-get install --no-install-recommends ffmpeg'";

#[test]
fn mp4_decodes_to_the_frames() {
    // An odd size, which H.264 in this format lacks: the last row and column are doubled.
    let scene = SWING.replace("__EXTRA__", "").replace("__SIZE__", "63, 47");
    let folder = folder(&scene);
    program(folder.path(), "scene.lua --frames 1..3 -o %d.png -q").assert().success();
    let run = program(folder.path(), "scene.lua --frames 1..3 -o clip.mp4 -q").output().expect("the program");
    assert!(run.status.success(), "{NEEDS_FFMPEG}\n{}", String::from_utf8_lossy(&run.stderr));
    let decoded = Command::new("ffmpeg")
        .current_dir(folder.path())
        .args(["-loglevel", "error", "-i", "clip.mp4", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"])
        .output()
        .expect(NEEDS_FFMPEG)
        .stdout;
    let pictures: Vec<RgbImage> = decoded
        .chunks(64 * 48 * 3)
        .map(|bytes| RgbImage::from_raw(64, 48, bytes.to_vec()).expect("a whole frame"))
        .map(|picture| image::imageops::crop_imm(&picture, 0, 0, 63, 47).to_image())
        .collect();
    // Colours at half the resolution and a loss that is hard to see: on average some steps of 255, most of it at the
    // edges of the ball, while frames differ by the ball's whole width.
    assert_alike(&pictures, &frames(&folder), 4.0, mean_difference);
    assert_eq!(files(folder.path()), ["1.png", "2.png", "3.png", "clip.mp4"]);
}

#[test]
fn without_ffmpeg_an_mp4_is_an_error_before_anything_is_rendered() {
    let folder = folder(&swing(""));
    program(folder.path(), "scene.lua --frames 1..2 -o clip.mp4 --size 8000x8000 --samples 10000")
        .env("PATH", folder.path())
        .timeout(std::time::Duration::from_secs(20))
        .assert()
        .code(1)
        .stderr(contains("apt-get install ffmpeg").and(contains(".gif")).and(contains("rendering on").not()));
    assert_eq!(files(folder.path()), [""; 0]);
}

#[cfg(unix)]
#[test]
fn an_ffmpeg_that_fails_is_quoted() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder(&swing(""));
    let fake = folder.path().join("ffmpeg");
    let script = "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\necho 'Unknown encoder libx264' >&2\nexit 3\n";
    fs::write(&fake, script).expect("a writable folder");
    fs::set_permissions(&fake, fs::Permissions::from_mode(0o755)).expect("a file of ours");
    program(folder.path(), "scene.lua --frames 1..2 -o clip.mp4")
        .env("PATH", format!("{}:/usr/bin:/bin", folder.path().display()))
        .assert()
        .code(1)
        .stderr(contains("Unknown encoder libx264").and(contains("clip.mp4")));
    assert_eq!(files(folder.path()), ["ffmpeg"]);
}

#[test]
fn a_clip_with_a_frame_that_fails_or_is_unlike_the_others_is_not_there() {
    for (extra, message) in [
        ("if gr.frame() == 2 then error('gone') end", "frame 2: scene.lua:13"),
        ("if gr.frame() == 2 then gr.background('transparent') end", "must be alike"),
    ] {
        for output in ["clip.gif", "clip.apng", "clip.mp4"] {
            let folder = folder(&swing(extra));
            program(folder.path(), &format!("scene.lua --frames 1..3 -o {output}"))
                .assert()
                .code(1)
                .stderr(contains(message));
            assert_eq!(files(folder.path()), [""; 0], "{output}");
        }
    }
}
