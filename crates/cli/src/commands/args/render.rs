//! The arguments of `marbles render`.

use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use marbles_core::Window;

use super::figure::FigureOptions;
use super::scene::SceneOptions;
use super::values::{above_zero, bits, exposure, samples, threads, tolerance_above_zero};
use crate::base::region::window_of;
use crate::base::size::Size;
use crate::formats::center_channels::{AxesForm, CenterChannel, DepthForm};
use crate::sequence::frames::FrameList;
use crate::terminal::progress::ProgressForm;

const EXAMPLES: &str = "\
Examples:
  marbles new ball.ron                                write a scene for these examples
  marbles new turn.ron --turntable                    write a turntable for these examples
  marbles render ball.ron                             ball.png, or ball.0001.png, ball.0002.png, …
  marbles render molecule.pdb                         molecule.png: a figure of a table of particles
  marbles render molecule.pdb --view top --transparent
  marbles render molecule.pdb --turntable -o turn.webp
  marbles render ball.ron -o out/ball.####.exr        half-float EXR, one file per frame
  marbles render a.ron b.ron -o out/{scene}.png       several scenes
  marbles render turn.ron --set camera.azimuth=30     another value in the scene
  marbles render ball.ron -o a.npy --error-channel    doubles for NumPy, their errors in a_error.npy
  marbles render ball.ron -o a.npz --channels depth   the same and more in one file, as named arrays
  marbles render turn.ron -o t%03d.png --frames 1-9x2,20
  marbles render turn.ron -o turn.webp                a loop that browsers play; also turn.gif and turn.apng
  marbles render ball.ron -o ball.tif                 16-bit TIFF, in proportion to light; floats with --float
  marbles render - -o exr:- < ball.ron > ball.exr     from program to program: scene and picture in pipes
  marbles render ball.ron --tolerance 1e-4            every pixel within 0.0001 of its exact value
  marbles render ball.ron --samples 4                 plain supersampling, 4 × 4 samples per pixel
  marbles render ball.ron -o ball.exr --channels depth,normal,id
  marbles render turn.ron -o small.png --frames 7 --size 150x150
  marbles render ball.ron -o a.exr --per-light        a.light-1.exr, …, a.ambient.exr, one per light
  marbles render ball.ron -o a.exr --per-light=layers  the same as layers light-1, …, ambient of a.exr
  marbles render ball.ron -o ball.exr --sidecar       also ball.json with camera, lights and error

Exit codes:
  0  everything is written, and every pixel is within the tolerance
  1  something failed
  2  the command line or the scene file is wrong
  3  everything is written, and some pixel is over the tolerance
  130  interrupted";

/// The default tolerance.
pub(crate) const DEFAULT_TOLERANCE: f64 = 1e-3;

/// The place of the pictures of single lights.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum PerLight {
    /// One file per light
    Files,
    /// Layers of one EXR, next to the picture under all lights
    Layers,
}

/// Render the frames of a scene to picture files
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct RenderArguments {
    /// Scene file, table of particles, such as a PDB, XYZ, CSV or LAMMPS file, or `-` for a scene from the standard input;
    /// if you give several, they are rendered one after another
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    #[command(flatten)]
    pub(crate) figure: FigureOptions,

    /// Names of the files; ####, %04d or {frame:04} stands for the frame number, {scene} for the name of the scene.
    /// The extension .png, .exr, .npy, .npz or .tif chooses the format; .webp, .gif or .apng puts all frames into one
    /// file, which plays in a loop. `-` writes a PNG to the standard output, `exr:-` another format [default:
    /// SCENE.png, or SCENE.####.png for several frames, in the current folder]
    #[arg(short, long, value_name = "PATTERN")]
    pub(crate) output: Option<PathBuf>,

    /// Frames, in the order of rendering: 7, 1-100, 1-100x2 or 1-100:2 (every second frame), 9-1:-1
    /// (backward), or several of these separated by commas [default: all frames]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) frames: Option<FrameList>,

    /// Frames per second, instead of the scene's
    #[arg(long, value_name = "FPS", value_parser = above_zero, allow_negative_numbers = true)]
    pub(crate) fps: Option<f64>,

    /// Skip frames whose files are complete and were made from the same scene and settings
    #[arg(long)]
    pub(crate) skip_existing: bool,

    /// Stop at the first frame or scene that cannot be rendered or written, instead of continuing with the next
    #[arg(long)]
    pub(crate) fail_fast: bool,

    /// Compute every channel of every pixel to within E of its exact value, which is the average of linear light
    /// over the square of the pixel; E is absolute, and a white surface that faces a light of intensity 1 has the
    /// value 1
    #[arg(long, value_name = "E", default_value = "1e-3", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Average N × N samples per pixel instead, whatever the error
    #[arg(long, value_name = "N", value_parser = samples, allow_negative_numbers = true, conflicts_with = "tolerance")]
    pub(crate) samples: Option<NonZeroU32>,

    /// Render on N threads; the picture is the same for every N [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Size of the picture in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Render only the part of the picture that begins at column X and row Y; `marbles merge` joins the parts
    #[arg(long, value_name = "X,Y,W,H", value_parser = window_of, allow_hyphen_values = true)]
    pub(crate) region: Option<Window>,

    /// Leave out the background, and store as alpha the share of each pixel that spheres cover
    #[arg(long, visible_alias = "transparent")]
    pub(crate) alpha: bool,

    /// Make the background white, as that of a table is by default
    #[arg(long, conflicts_with = "alpha")]
    pub(crate) white: bool,

    /// Render each light alone, with its shadows, to NAME.light-KEY.png and so on; KEY is the name of the light, or its
    /// number from 1 (from 01 if there are ten or more). The sky goes to NAME.sky.png, ambient light and background to
    /// NAME.ambient.png. The sum of these pictures is the full picture. --per-light=layers stores them in one EXR, next
    /// to the full picture, as layers light-1 (light-1.R, light-1.G, light-1.B) and so on, or with the names of the
    /// lights, `sky` and `ambient`
    #[arg(
        long,
        value_name = "PLACE",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "files",
        hide_possible_values = true
    )]
    pub(crate) per_light: Option<PerLight>,

    /// Bits per channel of a PNG, 8 or 16 [default: 8, or 16 with --linear]
    #[arg(long, value_name = "BITS", value_parser = bits, allow_negative_numbers = true)]
    pub(crate) bits: Option<u8>,

    /// Write a PNG with linear codes, proportional to light, instead of sRGB codes, with 16 bits
    #[arg(long)]
    pub(crate) linear: bool,

    /// Multiply light by 2^EV before it is converted to the codes of a PNG, GIF, WebP or TIFF; tolerance and errors
    /// refer to the light before the multiplication
    #[arg(long, value_name = "EV", value_parser = exposure, allow_hyphen_values = true)]
    pub(crate) exposure: Option<f64>,

    /// Write a PNG or TIFF in color even if the scene is gray
    #[arg(long)]
    pub(crate) rgb: bool,

    /// Write an EXR in single precision instead of half precision (--channels implies this), or a TIFF in single
    /// precision instead of 16-bit codes
    #[arg(long)]
    pub(crate) float: bool,

    /// Write the light of an EXR in half precision, also with --channels, which have single precision
    #[arg(long, conflicts_with = "float")]
    pub(crate) half: bool,

    /// Also store the error of each pixel: in a channel `error` of an EXR, in single precision; for
    /// NAME.npy in a file NAME_error.npy, and in an array `error` of an NPZ, in double precision
    #[arg(long)]
    pub(crate) error_channel: bool,

    /// Also store properties of the first hit of the ray through the center of each pixel: depth, normal,
    /// position, id, albedo, mask; or averages over the visible spheres of each pixel: mean_normal, coverage_id.
    /// Separate several by commas. They become channels of an EXR, or arrays of an NPZ with these names; for
    /// NAME.npy files NAME_channels.npy and NAME_id.npy
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        hide_possible_values = true
    )]
    pub(crate) channels: Vec<CenterChannel>,

    /// Kind of depth for --channels [default: axis]
    #[arg(long, value_name = "KIND", requires = "channels")]
    pub(crate) depth: Option<DepthForm>,

    /// Axes of normals and positions for --channels [default: world]
    #[arg(long, value_name = "AXES", requires = "channels")]
    pub(crate) axes: Option<AxesForm>,

    /// Write NAME.json next to each picture, for example NAME.png, with the camera as OpenCV's K, R and t, the
    /// lights, and the error
    #[arg(long)]
    pub(crate) sidecar: bool,

    /// Draw a legend for the colors of clouds: a colormap with numbers, or categories. `inside` puts it next to the
    /// picture, into NAME.svg for NAME.png
    #[arg(long, value_name = "FILE.svg|inside")]
    pub(crate) legend: Option<PathBuf>,

    /// Draw a scale bar with a round length. With a parallel lens it is valid everywhere, else at the distance of
    /// the camera's target. `inside` puts it next to the picture, as for --legend
    #[arg(long, value_name = "FILE.svg|inside")]
    pub(crate) scale_bar: Option<PathBuf>,

    /// Form of the progress reports [default: a bar on a terminal, else plain]
    #[arg(long, value_name = "FORM")]
    pub(crate) progress: Option<ProgressForm>,

    /// Print only errors and warnings, and progress only if you also give --progress
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
