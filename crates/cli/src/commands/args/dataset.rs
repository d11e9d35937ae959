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
  marbles dataset studio.ron -o studio --layout diligent --skip-existing   go on where it ended
  marbles dataset lamps.ron -o lamps --layout luces

Files of the layout `diligent`, in the camera's axes: x right, y up, z toward the viewer:
  001.png, 002.png, …   a picture under each light alone, without ambient light and background: 16 bit,
                        in proportion to light, scaled so that none is clipped
  filenames.txt         their names
  light_directions.txt  unit vectors toward the lights
  light_intensities.txt  red, green and blue of the lights in the pictures' numbers, in which the
                        largest code is 1: a white surface that faces a light has its intensity
  mask.png              255 where the center of a pixel sees a sphere
  Normal_gt.mat         the normals there, an array `Normal_gt` of doubles, height × width × 3
  normal.txt            the same, three numbers a line, row by row
  Normal_gt.png         the same to look at

Files of the layout `luces`, for point lights that fall off with the square of the distance:
  01.png, 02.png, …     the pictures, as above
  led_params.txt        size, focal length, principal point and mean distance; then of each light its
                        position (x right, y down, z forward), direction, brightness and exponent
  normals.png           the normals, 16 bit: x right, y up, z toward the viewer
  zgt.npz               the depths along the axis of view, arrays `zgt` and `zgt_int` of doubles
  mask.png, K.txt       where a sphere is seen; the matrix of the camera
  light_positions.txt   x right, y up, z toward the viewer; light_directions.txt and
                        light_intensities.txt are those at the mean distance; filenames.txt

Exit codes:
  0  everything is written, and every pixel met the tolerance
  1  something failed
  2  the command line or the scene file is wrong
  3  everything is written, and some pixel did not meet the tolerance
  130  interrupted";

/// A kind of data set.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum LayoutForm {
    /// That of DiLiGenT: distant lights
    Diligent,
    /// That of LUCES: near lights
    Luces,
}

/// Write a data set for photometric stereo: a picture under each light, and the true normals
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct DatasetArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// Folder of the files
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: PathBuf,

    /// Names and kinds of the files
    #[arg(long, value_name = "LAYOUT")]
    pub(crate) layout: LayoutForm,

    /// Frame of the scene [default: the first]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) frame: Option<i32>,

    /// Bring every channel of every pixel within E of its exact value, before it is rounded; E is a share of the
    /// largest code, and so are the errors that results tell
    #[arg(long, value_name = "E", default_value = "1e-4", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Size of the pictures in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Leave out pictures that are complete and made from the same scene and settings
    #[arg(long)]
    pub(crate) skip_existing: bool,

    /// Render on N threads; the files are the same for every N [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// The form in which progress is reported [default: a bar on a terminal, plain elsewhere]
    #[arg(long, value_name = "FORM")]
    pub(crate) progress: Option<ProgressForm>,

    /// Print nothing but errors and warnings, and progress only where --progress asks for it
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
