//! The command line, as clap reads it.

mod farm;
mod manual;
mod new;
mod preview;
mod report;

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand, ValueEnum};
use marbles_core::Window;

pub(crate) use self::farm::{Engine, FarmArguments, JobArguments};
pub(crate) use self::manual::{CompletionsArguments, ManArguments};
pub(crate) use self::new::NewArguments;
pub(crate) use self::preview::PreviewArguments;
pub(crate) use self::report::ReportArguments;
use crate::base::region;
use crate::sequence::frames::FrameList;

/// Sides of pictures, as in scene files.
const LONGEST_SIDE: u32 = 65_536;
/// More samples than this on a side of a pixel would take longer than anybody waits.
const MOST_SAMPLES: i64 = 1000;
/// More threads than this would only be in each other's way.
const MOST_THREADS: i64 = 1024;
/// A longer list of pixels would say less than a picture of the differences.
const MOST_WORST: i64 = 100_000;

/// Render scenes of spheres to pictures whose pixels are known
#[derive(Debug, Parser)]
#[command(name = "marbles", version, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Render(RenderArguments),
    Preview(PreviewArguments),
    Check(CheckArguments),
    Compare(CompareArguments),
    Merge(MergeArguments),
    Report(ReportArguments),
    Farm(FarmArguments),
    New(NewArguments),
    Completions(CompletionsArguments),
    Man(ManArguments),
}

const RENDER_EXAMPLES: &str = "\
Examples:
  marbles render ball.ron                             ball.png, or ball.0001.png, ball.0002.png, …
  marbles render ball.ron -o out/ball.####.exr        half-float EXR, one file for each frame
  marbles render ball.ron -o b%03d.png --frames 1-9x2,20
  marbles render turn.ron -o turn.apng                a loop that browsers play
  marbles render ball.ron --tolerance 1e-4            every pixel within 0.0001 of its exact value
  marbles render ball.ron --samples 4                 plain supersampling, 4 × 4 points a pixel
  marbles render ball.ron -o small.png --frames 7 --size 150x150

Exit codes:
  0  everything is written, and every pixel met the tolerance
  1  something failed, or some pixel did not meet the tolerance
  2  the command line or the scene file is wrong
  130  interrupted";

/// Render the frames of a scene, one file each
#[derive(Debug, Args)]
#[command(after_help = RENDER_EXAMPLES)]
pub(crate) struct RenderArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    /// File names, with ####, %04d or {frame:04} in place of the frame number; the ending .png or
    /// .exr chooses the format, and .apng has all frames in one file, an animated PNG that plays in
    /// a loop [default: SCENE.png, or SCENE.####.png for several frames, in the current folder]
    #[arg(short, long, value_name = "PATTERN")]
    pub(crate) output: Option<PathBuf>,

    /// Frames in the order of rendering: 7, 1-100, 1-100x2 or 1-100:2 (every other), 9-1:-1
    /// (backward), and several of these with commas [default: all of the scene's]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) frames: Option<FrameList>,

    /// Frames per second, in place of the scene's
    #[arg(long, value_name = "FPS", value_parser = above_zero)]
    pub(crate) fps: Option<f64>,

    /// Leave out frames whose files are complete and made from the same scene and settings
    #[arg(long)]
    pub(crate) skip_existing: bool,

    /// End at the first frame that cannot be rendered or written, instead of going on to the next
    #[arg(long)]
    pub(crate) fail_fast: bool,

    /// Bring every channel of every pixel within E of its exact value, the average over the
    /// pixel's square in linear light; E is absolute, and a white surface facing a light of
    /// intensity 1 has the value 1
    #[arg(long, value_name = "E", default_value = "1e-3", value_parser = tolerance_above_zero)]
    pub(crate) tolerance: f64,

    /// Average N × N samples in every pixel instead, whatever the error
    #[arg(long, value_name = "N", value_parser = samples, conflicts_with = "tolerance")]
    pub(crate) samples: Option<NonZeroU32>,

    /// Render on N threads; the picture is the same for every N [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,

    /// Size of the picture in pixels, in place of the scene's
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<Size>,

    /// Render only a part of the picture, from column X and row Y on; `marbles merge` puts parts
    /// together
    #[arg(long, value_name = "X,Y,W,H", value_parser = region::window_of)]
    pub(crate) region: Option<Window>,

    /// Leave the background out, and store how much of each pixel the spheres cover
    #[arg(long)]
    pub(crate) alpha: bool,

    /// Bits of a number in a PNG, 8 or 16 [default: 8]
    #[arg(long, value_name = "BITS", value_parser = bits)]
    pub(crate) bits: Option<u8>,

    /// Write a PNG in color even if nothing in the scene has color
    #[arg(long)]
    pub(crate) rgb: bool,

    /// Write an EXR in single precision instead of half
    #[arg(long)]
    pub(crate) float: bool,

    /// Store each pixel's error in an EXR as well, in a channel `error` in single precision
    #[arg(long)]
    pub(crate) error_channel: bool,

    /// How to tell how far the work is [default: a bar on a terminal, plain elsewhere]
    #[arg(long, value_name = "FORM")]
    pub(crate) progress: Option<ProgressForm>,

    /// Print nothing but errors and warnings, and progress only where --progress asks for it
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// A form of progress, for people or programs.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum ProgressForm {
    /// Lines on stdout that a runner of Open Job Description reads
    #[value(name = "openjd")]
    OpenJd,
    /// Lines on stderr, each an object in JSON
    Json,
    /// A line on stderr for each frame, or now and then
    Plain,
    /// Nothing
    None,
}

/// Validate a scene file and tell what it contains
#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// Scene file
    pub(crate) scene: PathBuf,
}

const COMPARE_EXAMPLES: &str = "\
Examples:
  marbles compare a.png b.exr                         print how far they differ, and where
  marbles compare a.exr b.exr --tolerance 1e-3        end with 1 if any pixel is over it
  marbles compare a.png b.png --diff diff.png         a picture of where they differ

PNG codes are decoded to linear light and multiplied by alpha, as in EXR. Grey stands for three
equal colors, and alpha is 1 in a picture that has none. The channel `error` of an EXR is no light, and
not compared.

Rows of the result:
  largest     the largest difference of any channel of any pixel
  rms         root of the mean square, over all channels of all pixels
  99.9 %      the least number that the differences of 99.9 % of the pixels do not exceed; the
              difference of a pixel is the largest of its channels
  over        pixels over the tolerance
  rounding    the part of the largest difference that half a step of both formats accounts for
  beyond      pixels that differ by more than such rounding
  clipped     those of them that are too bright for one of the files, as above the white of a PNG
  not finite  pixels with NaN or infinity, whose difference counts as infinite

Exit codes:
  0  no pixel is over the tolerance, or none was given
  1  some pixel is over the tolerance, the sizes differ, or something failed
  2  the command line or a picture is wrong";

/// Tell how far two pictures differ, as the absolute difference in linear light
#[derive(Debug, Args)]
#[command(after_help = COMPARE_EXAMPLES)]
pub(crate) struct CompareArguments {
    /// Picture, PNG or EXR
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,

    /// Picture to compare it with, PNG or EXR
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,

    /// Largest difference that is all right
    #[arg(long, value_name = "E", value_parser = tolerance)]
    pub(crate) tolerance: Option<f64>,

    /// List the N pixels that differ most
    #[arg(long, value_name = "N", default_value = "5", value_parser = worst)]
    pub(crate) worst: usize,

    /// Write a picture of the differences: .png in grey, on a logarithmic scale with the tolerance
    /// in the middle (else 1e-3); .exr as they are
    #[arg(long, value_name = "FILE")]
    pub(crate) diff: Option<PathBuf>,

    /// Print nothing but errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

const MERGE_EXAMPLES: &str = "\
Examples:
  marbles render huge.ron -o left.exr --region 0,0,4096,8192
  marbles render huge.ron -o right.exr --region 4096,0,4096,8192
  marbles merge huge.exr left.exr right.exr

The picture is the one that would have been rendered as a whole, to the byte.

Exit codes:
  0  the picture is written
  1  something failed
  2  the command line is wrong, or the parts do not make a picture: there is a gap, two overlap, or
     they are of different scenes, frames or settings";

/// Put parts together that were rendered with --region
#[derive(Debug, Args)]
#[command(after_help = MERGE_EXAMPLES)]
pub(crate) struct MergeArguments {
    /// Picture to write, of the same format as the parts
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// Parts of the picture, in any order
    #[arg(value_name = "PARTS", required = true)]
    pub(crate) parts: Vec<PathBuf>,

    /// Print nothing but errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Columns and rows of a picture.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let expected = format!("expected WIDTHxHEIGHT, each from 1 to {LONGEST_SIDE}");
        let side = |text: &str| {
            let digits = text.bytes().all(|byte| byte.is_ascii_digit());
            text.parse()
                .ok()
                .filter(|side| digits && (1..=LONGEST_SIDE).contains(side))
        };
        let sides = text.split_once(['x', 'X']);
        match sides.map(|(width, height)| (side(width), side(height))) {
            // The longest sides together make 2³² pixels, which is the most there may be.
            Some((Some(width), Some(height))) => Ok(Self { width, height }),
            _ => Err(expected),
        }
    }
}

/// What a picture can be brought within.
fn tolerance_above_zero(text: &str) -> Result<f64, String> {
    /// Nearer to the exact value rounding has a say.
    const SMALLEST: f64 = 1e-9;
    let expected = || format!("expected a number from {SMALLEST:e}");
    let tolerance = tolerance(text).map_err(|_| expected())?;
    if tolerance >= SMALLEST {
        Ok(tolerance)
    } else {
        Err(expected())
    }
}

fn samples(text: &str) -> Result<NonZeroU32, String> {
    let samples = whole_number(text, 1, MOST_SAMPLES)?;
    Ok(NonZeroU32::new(samples as u32).unwrap_or(NonZeroU32::MIN))
}

fn threads(text: &str) -> Result<usize, String> {
    whole_number(text, 1, MOST_THREADS).map(|threads| threads as usize)
}

fn bits(text: &str) -> Result<u8, String> {
    match text {
        "8" => Ok(8),
        "16" => Ok(16),
        _ => Err("expected 8 or 16".to_owned()),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|tolerance: &f64| tolerance.is_finite() && *tolerance >= 0.0)
        .ok_or_else(|| "expected a number from 0".to_owned())
}

fn above_zero(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number: &f64| number.is_finite() && *number > 0.0)
        .ok_or_else(|| "expected a number above 0".to_owned())
}

fn worst(text: &str) -> Result<usize, String> {
    whole_number(text, 0, MOST_WORST).map(|worst| worst as usize)
}

fn whole_number(text: &str, least: i64, most: i64) -> Result<i64, String> {
    text.parse()
        .ok()
        .filter(|number| (least..=most).contains(number))
        .ok_or_else(|| format!("expected a whole number from {least} to {most}"))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn sizes_are_read() {
        let size = |text: &str| {
            text.parse::<Size>()
                .ok()
                .map(|size| (size.width, size.height))
        };
        assert_eq!(size("640x480"), Some((640, 480)));
        assert_eq!(size("1X65536"), Some((1, 65_536)));
        for wrong in [
            "640", "0x4", "4x0", "65537x1", "-1x4", "+1x4", "4x", "x", "4x4x4", " 4x4",
        ] {
            assert_eq!(size(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn frames_may_begin_with_a_minus() {
        for list in ["-5", "-10--5", "-5-5", "1-4"] {
            let arguments = Arguments::try_parse_from(["marbles", "render", "a", "--frames", list]);
            let Ok(Arguments {
                command: Command::Render(render),
            }) = arguments
            else {
                panic!("{list}: {arguments:?}");
            };
            assert_eq!(render.frames, list.parse().ok());
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for option in [
            "--samples=0",
            "--samples=1001",
            "--threads=0",
            "--threads=-1",
            "--bits=12",
        ] {
            let arguments = Arguments::try_parse_from(["marbles", "render", "a", option]);
            assert_eq!(arguments.unwrap_err().exit_code(), 2, "{option}");
        }
    }
}
