//! The arguments of `marbles render`.

use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use marbles_core::Window;

use super::scene::SceneOptions;
use super::values::{above_zero, bits, exposure, samples, threads, tolerance_above_zero};
use crate::base::region::window_of;
use crate::base::size::Size;
use crate::formats::center_channels::{AxesForm, CenterChannel, DepthForm};
use crate::sequence::frames::FrameList;
use crate::terminal::progress::ProgressForm;

const EXAMPLES: &str = "\
Examples:
  marbles render ball.ron                             ball.png, or ball.0001.png, ball.0002.png, …
  marbles render ball.ron -o out/ball.####.exr        half-float EXR, one file for each frame
  marbles render a.ron b.ron -o out/{scene}.png       several scenes
  marbles render ball.ron --set camera.azimuth=30     with another value in the scene
  marbles render ball.ron -o a.npy --error-channel    doubles for NumPy, their errors in a_error.npy
  marbles render ball.ron -o b%03d.png --frames 1-9x2,20
  marbles render turn.ron -o turn.webp                a loop that browsers play; turn.gif and turn.apng, too
  marbles render ball.ron -o ball.tif                 16 bit TIFF, in proportion to light; --float for floats
  marbles render ball.ron --tolerance 1e-4            every pixel within 0.0001 of its exact value
  marbles render ball.ron --samples 4                 plain supersampling, 4 × 4 points a pixel
  marbles render ball.ron -o ball.exr --channels depth,normal,id
  marbles render ball.ron -o small.png --frames 7 --size 150x150
  marbles render ball.ron -o a.exr --per-light        a.light-1.exr, …, a.ambient.exr: each light alone
  marbles render ball.ron -o a.exr --per-light=layers  the same in layers light-1, …, ambient of a.exr
  marbles render ball.ron -o ball.exr --sidecar       and ball.json: camera, lights, error

Exit codes:
  0  everything is written, and every pixel met the tolerance
  1  something failed
  2  the command line or the scene file is wrong
  3  everything is written, and some pixel did not meet the tolerance
  130  interrupted";

/// The tolerance where none is given.
pub(crate) const DEFAULT_TOLERANCE: f64 = 1e-3;

/// The place of the pictures under one light each.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum PerLight {
    /// A file for each
    Files,
    /// Layers of one EXR, whose picture is that under all lights
    Layers,
}

/// Render the frames of a scene, one file each
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct RenderArguments {
    /// Scene file; you can give several, which are rendered one after another
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// File names, with ####, %04d or {frame:04} in place of the frame number, and {scene} in place of
    /// the scene's name; the ending .png, .exr, .npy or .tif chooses the format, and .webp, .gif or .apng puts all frames
    /// into one file, which plays in a loop [default: SCENE.png, or SCENE.####.png for several frames, in the
    /// current folder]
    #[arg(short, long, value_name = "PATTERN")]
    pub(crate) output: Option<PathBuf>,

    /// Frames in the order of rendering: 7, 1-100, 1-100x2 or 1-100:2 (every other), 9-1:-1
    /// (backward), and several of these with commas [default: all of the scene's]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) frames: Option<FrameList>,

    /// Frames per second, in place of the scene's
    #[arg(long, value_name = "FPS", value_parser = above_zero, allow_negative_numbers = true)]
    pub(crate) fps: Option<f64>,

    /// Skip frames whose files are complete and made from the same scene and settings
    #[arg(long)]
    pub(crate) skip_existing: bool,

    /// End at the first frame, or scene, that cannot be rendered or written, instead of going on to the next
    #[arg(long)]
    pub(crate) fail_fast: bool,

    /// Bring every channel of every pixel within E of its exact value, the average over the
    /// pixel's square in linear light; E is absolute, and a white surface facing a light of
    /// intensity 1 has the value 1
    #[arg(long, value_name = "E", default_value = "1e-3", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Average N × N samples in every pixel instead, whatever the error
    #[arg(long, value_name = "N", value_parser = samples, allow_negative_numbers = true, conflicts_with = "tolerance")]
    pub(crate) samples: Option<NonZeroU32>,

    /// Render on N threads; the picture is the same for every N [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Size of the picture in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Render only a part of the picture, from column X and row Y on; `marbles merge` puts parts
    /// together
    #[arg(long, value_name = "X,Y,W,H", value_parser = window_of, allow_hyphen_values = true)]
    pub(crate) region: Option<Window>,

    /// Leave out the background, and store the share of each pixel that spheres cover
    #[arg(long)]
    pub(crate) alpha: bool,

    /// Render each light alone, with its shadows, into NAME.light-KEY.png and so on, KEY its name, or its number from
    /// 1 (from 01 where there are ten or more), and ambient light and background into NAME.ambient.png: the sum is the
    /// picture. With --per-light=layers into layers light-1 (light-1.R, light-1.G, light-1.B) and so on, or the lights'
    /// names, and `ambient` of one EXR, beside the picture under all lights
    #[arg(
        long,
        value_name = "PLACE",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "files",
        hide_possible_values = true
    )]
    pub(crate) per_light: Option<PerLight>,

    /// Bits of a number in a PNG, 8 or 16 [default: 8, and 16 with --linear]
    #[arg(long, value_name = "BITS", value_parser = bits, allow_negative_numbers = true)]
    pub(crate) bits: Option<u8>,

    /// Write a PNG whose numbers are in proportion to light, instead of those of sRGB, in 16 bit
    #[arg(long)]
    pub(crate) linear: bool,

    /// Multiply light by 2^EV before it is rounded to the numbers of a PNG, GIF, WebP or TIFF; tolerance and errors
    /// are those of the light before
    #[arg(long, value_name = "EV", value_parser = exposure, allow_hyphen_values = true)]
    pub(crate) exposure: Option<f64>,

    /// Write a PNG or TIFF in color even if nothing in the scene has color
    #[arg(long)]
    pub(crate) rgb: bool,

    /// Write an EXR in single precision instead of half, as --channels does as well, or a TIFF instead of 16 bit
    #[arg(long)]
    pub(crate) float: bool,

    /// Store each pixel's error as well: in an EXR in a channel `error` in single precision, with
    /// NAME.npy in a file NAME_error.npy in double precision
    #[arg(long)]
    pub(crate) error_channel: bool,

    /// Store what the rays through the centers of pixels see in an EXR, or in files NAME_channels.npy
    /// and NAME_id.npy, as well, several with commas: depth, normal, position, id, albedo, mask; and averages over
    /// what pixels see: mean_normal, coverage_id
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        hide_possible_values = true
    )]
    pub(crate) channels: Vec<CenterChannel>,

    /// Depth that --channels stores [default: axis]
    #[arg(long, value_name = "KIND", requires = "channels")]
    pub(crate) depth: Option<DepthForm>,

    /// Axes of the normals and positions that --channels stores [default: world]
    #[arg(long, value_name = "AXES", requires = "channels")]
    pub(crate) axes: Option<AxesForm>,
    /// Write NAME.json next to each picture, for example NAME.png: the camera as OpenCV's K, R and t, the
    /// lights, and the error
    #[arg(long)]
    pub(crate) sidecar: bool,

    /// Draw a legend for the colors of clouds: a colormap with its numbers, or categories
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) legend: Option<PathBuf>,

    /// Draw a scale bar: a round length and its pixels, anywhere with a parallel lens, else at the distance of
    /// the camera's target
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) scale_bar: Option<PathBuf>,

    /// The form in which progress is reported [default: a bar on a terminal, plain elsewhere]
    #[arg(long, value_name = "FORM")]
    pub(crate) progress: Option<ProgressForm>,

    /// Print nothing but errors and warnings, and progress only where --progress asks for it
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
