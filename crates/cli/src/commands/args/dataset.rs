//! The arguments of `marbles dataset`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::scene::SceneOptions;
use super::values::{threads, tolerance_above_zero};
use crate::base::size::Size;
use crate::terminal::progress::ProgressForm;

const EXAMPLES: &str = "\
Examples:
  marbles dataset studio.ron -o studio --layout diligent
  marbles dataset studio.ron -o studio --layout diligent --skip-existing   resume an interrupted run
  marbles dataset lamps.ron -o lamps --layout luces
  marbles dataset dome.ron -o dome --layout lp

Files of the layout `diligent`, in the axes of the camera (x right, y up, z toward the viewer):
  001.png, 002.png, …   a picture of each light alone, without ambient light, sky and background: 16
                        bits, proportional to light, scaled such that no pixel is clipped
  filenames.txt         the names of the pictures
  light_directions.txt  unit vectors toward the lights
  light_intensities.txt  red, green and blue of the lights, in the unit of the pictures, whose largest
                        code is 1: a white surface that faces a light has its intensity
  mask.png              255 if the ray through the center of the pixel hits a sphere
  Normal_gt.mat         the normals of these pixels, as an array `Normal_gt` of doubles,
                        height × width × 3
  normal.txt            the same normals as text, row by row, three numbers per line
  Normal_gt.png         the same normals as a picture with 16 bits
  normal.png, names.txt  the same normals with 8 bits, and the names of the pictures once more

Files of the layout `luces`, for point lights whose light falls off with the square of the distance:
  01.png, 02.png, …     the pictures, as above
  led_params.txt        size, focal length, principal point and mean distance; then the position
                        (x right, y down, z forward), direction, brightness and exponent of each light
  normals.png           the normals, with 16 bits: x right, y up, z toward the viewer
  zgt.npz               the depths along the axis of view, as arrays `zgt` and `zgt_int` of doubles
  mask.png              the mask, as above
  K.txt                 the matrix of the camera
  light_positions.txt   the positions of the lights: x right, y up, z toward the viewer
  light_directions.txt  directions toward the lights at the mean distance
  light_intensities.txt  intensities of the lights at the mean distance
  filenames.txt         the names of the pictures

Files of the layout `lp`, for directional lights of the same intensity:
  001.png, 002.png, …   the pictures, as above
  lights.lp             the number of pictures; then the name of each, and the unit vector toward its
                        light: x right, y up, z toward the viewer
  filenames.txt, mask.png, Normal_gt.png  as above

Exit codes:
  0  everything is written, and every pixel is within the tolerance
  1  something failed
  2  the command line or the scene file is wrong
  3  everything is written, and some pixel is over the tolerance
  130  interrupted";

/// The layout of a data set.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum LayoutForm {
    /// Like DiLiGenT, for distant lights
    Diligent,
    /// Like LUCES, for near lights
    Luces,
    /// A list of lights for RTI, for distant lights of the same intensity
    Lp,
}

/// Write a data set for photometric stereo: a picture of each light, and the true normals
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct DatasetArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// Folder for the files
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: PathBuf,

    /// Names and kinds of the files
    #[arg(long, value_name = "LAYOUT")]
    pub(crate) layout: LayoutForm,

    /// Frame of the scene [default: the first]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) frame: Option<i32>,

    /// Compute every channel of every pixel to within E of its exact value, before rounding; E and the errors in the
    /// results are relative to the largest code
    #[arg(long, value_name = "E", default_value = "1e-4", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Size of the pictures in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Skip pictures that are complete and were made from the same scene and settings
    #[arg(long)]
    pub(crate) skip_existing: bool,

    /// Render on N threads; the files are the same for every N [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Form of the progress reports [default: a bar on a terminal, else plain]
    #[arg(long, value_name = "FORM")]
    pub(crate) progress: Option<ProgressForm>,

    /// Print only errors and warnings, and progress only if you also give --progress
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
