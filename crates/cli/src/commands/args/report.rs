//! The arguments of `marbles report`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;
use super::values::{runs, seconds, threads};
use crate::base::size::Size;

const EXAMPLES: &str = "\
Examples:
  marbles report ball.ron                             print the table
  marbles report ball.ron --plot ball.svg             and draw time against RMSE
  marbles report ball.ron --csv ball.csv --quiet      nothing but the file
  marbles report ball.ron --seconds 600 --threads 1   more samples, on one thread

Every setting is held against a reference, the picture at a tolerance of 1e-7, or at 1e-8 or 1e-9
where that takes no longer than --seconds and leaves no more pixels unknown. What the reference
claims is told first; pixels in which it claims more than 1e-7 are left out.

Columns of the table:
  setting          --tolerance or --samples of `marbles render`
  time             of rendering alone, the median of the runs, which take turns
  speed-up         the time that supersampling takes to the same RMSE, over this time; between the
                   measured sample counts it is interpolated, log-log, and beyond them extrapolated
                   along their slope (*)
  RMSE             root of the mean square error, over all channels of all pixels
  largest          the largest error of any channel of any pixel
  over             pixels whose error is certainly over the tolerance
  true/claimed     the true error of a pixel over the one that it claims, the median of the pixels
                   that claim ten times as much as the reference does, so that it means something
  largest/claimed  the largest true error over the largest claimed one
  samples, lines   points and lines a pixel

Exit codes:
  0  everything is measured and written, and every pixel met its tolerance
  1  something failed
  2  the command line or the scene file is wrong
  3  everything is measured and written, and some pixel did not meet its tolerance
  130  interrupted";

/// Measure speed against error: tolerances and supersampling, held against a reference
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ReportArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// Frame to render [default: the scene's first]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) frame: Option<i32>,

    /// Size of the picture in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Render on N threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Time for all runs together, and for a better reference; 1, 2, 4, 8, … samples a side are
    /// measured as far as their runs fit into it, or into half of it where the tolerances are slow.
    /// All tolerances, and 4 × 4 samples, are measured once in any case
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) seconds: f64,

    /// Runs of every setting, of which the median time counts
    #[arg(long, value_name = "N", default_value = "5", value_parser = runs, allow_negative_numbers = true)]
    pub(crate) runs: usize,

    /// Write the numbers, and some more, as a table with commas
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,

    /// Draw time against RMSE, as an .svg
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,

    /// Print nothing but errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
