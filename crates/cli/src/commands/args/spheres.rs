//! The arguments of `marbles spheres`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;
use super::values::{threads, tolerance_above_zero};
use crate::base::size::Size;
use crate::sequence::frames::FrameList;

const EXAMPLES: &str = "\
Examples:
  marbles spheres ball.ron                        ball.spheres.csv, one row for each sphere and frame
  marbles spheres turn.ron -o turn.csv --frames 1-120x10
  marbles spheres ball.ron --tolerance 1e-6       smaller errors of the visible areas

Columns of the table, in pixels and pixel areas; the middle of the first pixel is (0, 0), x grows to
the right and y downward:
  frame, id           the frame, and the number of the sphere in the scene, from 0
  center_x, center_y  where the center of the sphere is seen, which is not that of its outline
  depth               distance of the center along the axis of view, in scene units
  ellipse_x … angle_degrees
                      center, half axes and angle of the outline; the angle from x toward y
  left … bottom       the box around the outline
  area                of the outline within the picture, whatever hides it
  visible_area        of what is seen of it
  visible_area_error  an estimate of the error of that
  visible_fraction    of the outline within the picture
A number that does not exist is left out: a sphere that reaches the plane of the viewpoint has no
ellipse.

Exit codes:
  0  everything is written
  1  something failed
  2  the command line or the scene file is wrong
  130  interrupted";

/// Write where each sphere is in the picture, and how much of it is seen
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct SpheresArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// The table, with commas [default: SCENE.spheres.csv, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Frames in the order of the table: 7, 1-100, 1-100x2 and several of these with commas
    /// [default: all of the scene's]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) frames: Option<FrameList>,

    /// Size of the picture in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Bring the visible areas of the spheres in every pixel together within E of their exact values,
    /// as a share of the pixel
    #[arg(long, value_name = "E", default_value = "1e-4", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Work on N threads; the table is the same for every N [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Print nothing but errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
