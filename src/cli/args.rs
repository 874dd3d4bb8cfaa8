//! What may stand on the command line. Whatever can be judged without a scene is judged here.

use clap::{Args, Parser, Subcommand, ValueEnum};
use gpu_trace::animation::FrameRange;
use gpu_trace::device::DeviceChoice;
use gpu_trace::film::{Film, Mask};
use gpu_trace::scene::FrameRate;
use gpu_trace::script::ConventionOverrides;
use std::path::PathBuf;
use std::str::FromStr;

const EXAMPLES: &str = "\
Examples:
  gpu-trace scenes/first.lua                    render it on the best device there is
  gpu-trace scenes/first.lua -o out.png --size 1920x1080 --samples 64
  gpu-trace swing.lua 12                        frame 12 of an animation: gr.frame_cmd() gives 12
  gpu-trace swing.lua --frames 1..100 -o out/frame-%04d.png --resume
  gpu-trace swing.lua --frames 1..100 -o swing.gif          or swing.apng, or swing.mp4 by an installed ffmpeg
  gpu-trace swing.lua --frames 1..100 -o - | ffplay -       uncompressed (y4m) through a pipe
  gpu-trace scene.lua --device cpu -q --json -  no talk, the figures as JSON on standard output
  gpu-trace doctor                              the devices, and whether they compute right
  gpu-trace compare a.png b.png --fail-above 0.002

The exit code is 0 when every picture was written, 2 for wrong arguments, 130 after an interrupt, else 1.
Ctrl-C ends a picture or a clip, which then is not written; of numbered frames it lets the one in hand be finished.
A second Ctrl-C ends the program at once. No file is ever left half-written.
A scene whose file is called 'doctor', 'compare' or 'help' is reached as './doctor'.";

/// Render a scene that is described by a Lua program
#[derive(Debug, Parser)]
#[command(name = "gpu-trace", version, after_help = EXAMPLES, max_term_width = 120)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true, arg_required_else_help = true)]
#[command(
    override_usage = "gpu-trace [OPTIONS] SCENE.lua [FRAME]\n       gpu-trace [OPTIONS] SCENE.lua --frames A..B[:STEP] [-o NAME-%04d.png|CLIP]\n       gpu-trace doctor\n       gpu-trace compare A.png B.png [--mask alpha] [--fail-above X]"
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,

    #[command(flatten)]
    pub render: Option<RenderArguments>,

    /// Say nothing on standard error but errors
    #[arg(short, long, global = true, conflicts_with = "verbose", help_heading = "Messages", display_order = 100)]
    pub quiet: bool,

    /// Say more; -vv for debugging. RUST_LOG chooses module by module
    #[arg(short, long, global = true, action = clap::ArgAction::Count, help_heading = "Messages", display_order = 101)]
    pub verbose: u8,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// List the devices with their limits, and test that each computes what the CPU does
    Doctor,
    /// Compare two PNG pictures: FLIP, PSNR, and the share of pixels that differ
    Compare(CompareArguments),
}

#[derive(Debug, Args)]
pub struct RenderArguments {
    /// The Lua program that describes the scene
    #[arg(value_name = "SCENE.lua")]
    pub scene: PathBuf,

    /// The number that gr.frame() gives the scene, 0 if left out
    #[arg(value_name = "FRAME", allow_negative_numbers = true, conflicts_with = "frames")]
    pub frame: Option<u32>,

    /// Write the picture here, and not where the scene says; for scenes that render one picture. With --frames: a .png
    /// with %d or %04d for the frame's number, or a clip: .gif, .apng, .mp4, or '-' for y4m on standard output
    #[arg(short, long, value_name = "OUT", help_heading = "Picture")]
    pub output: Option<PathBuf>,

    /// Render these frames, both ends included; each runs the script anew, with its number from gr.frame()
    #[arg(long, value_name = "A..B[:STEP]", allow_hyphen_values = true, help_heading = "Animation")]
    pub frames: Option<FrameRange>,

    /// Frames a second, of clips and for gr.time(): a number, or a fraction such as 30000/1001
    #[arg(long, value_name = "N", default_value = "25", allow_hyphen_values = true, help_heading = "Animation")]
    pub fps: FrameRate,

    /// What gr.frames() gives the scene: the frames of the whole animation [default: those of --frames; 1 without]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Animation")]
    pub total_frames: Option<u32>,

    /// Leave out the frames whose numbered files are there and whole
    #[arg(long, requires = "frames", help_heading = "Animation")]
    pub resume: bool,

    /// Go on with the other numbered frames after one that failed; the exit code is 1 all the same
    #[arg(long, requires = "frames", help_heading = "Animation")]
    pub keep_going: bool,

    /// Frames that are prepared at a time (script and flattening) while another is rendered; each takes memory
    #[arg(long, value_name = "N", requires = "frames", default_value_t = 2, allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=64), help_heading = "Animation")]
    pub jobs: u16,

    /// Width and height in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", help_heading = "Picture")]
    pub size: Option<Size>,

    /// Leave the pixels transparent where camera rays meet nothing
    #[arg(long, help_heading = "Picture")]
    pub transparent: bool,

    /// Camera samples a pixel, in place of the scene's
    #[arg(long, allow_negative_numbers = true, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 24), help_heading = "Sampling")]
    pub samples: Option<u32>,

    /// Seed of all random numbers, math.random's included [default: the scene's]
    #[arg(long, allow_negative_numbers = true, value_name = "N", help_heading = "Sampling")]
    pub seed: Option<u32>,

    /// Noise of its own in every frame: a seed from --seed (or the scene's) and the frame's number. math.random stays
    #[arg(long, help_heading = "Sampling")]
    pub seed_per_frame: bool,

    /// The most reflections and refractions one after another, in place of the scene's
    #[arg(long, allow_negative_numbers = true, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1000), help_heading = "Sampling")]
    pub max_depth: Option<u32>,

    /// How to read the scene where programs differ: view=point|direction, transforms=pre|post,
    /// specular=phong|blinn, sample=centre|corner, joined by commas
    #[arg(long, value_name = "K=V,…", value_parser = parse_conventions, help_heading = "Scene")]
    pub conventions: Option<ConventionOverrides>,

    /// auto (a GPU, else software Vulkan, else the CPU), gpu (anything but the CPU), cpu, or part of a device's name
    #[arg(long, value_name = "DEVICE", default_value = "auto", value_parser = parse_device, help_heading = "Device")]
    pub device: DeviceChoice,

    /// Let the GPU check the bounds of every array and loop, which is slower
    #[arg(long, help_heading = "Device")]
    pub checked: bool,

    /// Write what was rendered and how fast, one JSON object a picture and line, and one at the end of a batch; '-' is
    /// standard output
    #[arg(long, value_name = "FILE", help_heading = "Messages")]
    pub json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// The reference
    #[arg(value_name = "A.png")]
    pub reference: PathBuf,

    /// The picture to judge
    #[arg(value_name = "B.png")]
    pub test: PathBuf,

    /// alpha: compare only the pixels where A's alpha is above 0
    #[arg(long)]
    pub mask: Option<MaskName>,

    /// Exit with 1 where the FLIP mean, in [0, 1], is above this
    #[arg(long, allow_negative_numbers = true, value_name = "X", value_parser = parse_threshold)]
    pub fail_above: Option<f64>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum MaskName {
    Alpha,
}

impl From<MaskName> for Mask {
    fn from(name: MaskName) -> Self {
        match name {
            MaskName::Alpha => Mask::Alpha,
        }
    }
}

/// Width and height in pixels, as "640x480".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |part: &str| part.parse::<u32>().ok();
        let (width, height) = text
            .split_once(['x', 'X', '×'])
            .and_then(|(width, height)| number(width).zip(number(height)))
            .ok_or("expected a width and a height in pixels, such as 640x480")?;
        Film::check_size(width, height).map_err(|error| error.to_string())?;
        Ok(Size([width, height]))
    }
}

fn parse_conventions(text: &str) -> Result<ConventionOverrides, String> {
    text.parse().map_err(|error: <ConventionOverrides as FromStr>::Err| error.to_string())
}

fn parse_device(text: &str) -> Result<DeviceChoice, String> {
    if text.is_empty() {
        return Err("expected auto, gpu, cpu, or part of a device's name".to_owned());
    }
    text.parse().map_err(|error| match error {})
}

fn parse_threshold(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a number that is not negative".to_owned()),
    }
}
