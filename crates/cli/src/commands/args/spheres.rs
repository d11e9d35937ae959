//! The arguments of `marbles spheres`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;
use super::values::{threads, tolerance_above_zero};
use crate::base::size::Size;
use crate::sequence::frames::FrameList;

const EXAMPLES: &str = "\
Examples:
  marbles spheres ball.ron                        ball.spheres.csv, one row per sphere and frame
  marbles spheres turn.ron -o turn.csv --frames 1-120x10
  marbles spheres ball.ron --tolerance 1e-6       smaller errors of the visible areas

Columns of the table, in pixels and pixel areas. The center of the first pixel is (0, 0), x increases
to the right and y downward:
  frame, id           the frame, and the number of the sphere in the scene, from 0
  center_x, center_y  the projection of the center of the sphere, which is not the center of the
                      outline
  depth               distance of the center along the axis of view, in scene units
  ellipse_x … angle_degrees
                      center, semi-axes and angle of the outline; the angle from x toward y
  left … bottom       the bounding box of the outline
  area                the area of the outline within the picture, including hidden parts
  visible_area        the visible part of this area
  visible_area_error  an estimate of the error of visible_area
  visible_fraction    visible_area divided by area
A cell is empty if its number does not exist: a sphere that reaches the plane of the viewpoint has no
ellipse.

Exit codes:
  0  everything is written
  1  something failed
  2  the command line or the scene file is wrong
  130  interrupted";

/// Write a table with the outline and the visible area of each sphere
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct SpheresArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// The CSV file to write [default: SCENE.spheres.csv, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Frames, in the order of the table: 7, 1-100, 1-100x2, or several of these separated by commas
    /// [default: all frames]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) frames: Option<FrameList>,

    /// Size of the picture in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Compute the visible areas in every pixel such that their errors, added over all spheres, are within E, as a
    /// fraction of the pixel
    #[arg(long, value_name = "E", default_value = "1e-4", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Work on N threads; the table is the same for every N [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Print only errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
