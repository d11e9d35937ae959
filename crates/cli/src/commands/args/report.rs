//! The arguments of `marbles report`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;
use super::values::{runs, seconds, threads};
use crate::base::size::Size;

const EXAMPLES: &str = "\
Examples:
  marbles report ball.ron                             print the table
  marbles report ball.ron --plot ball.svg             also draw time against RMSE
  marbles report ball.ron --csv ball.csv --quiet      only write the file
  marbles report ball.ron --seconds 600 --threads 1   more samples, on one thread

Every setting is compared with a reference. This is the picture at the tolerance 1e-7, or at 1e-8 or
1e-9 if that takes no longer than --seconds and does not claim more than 1e-7 in more pixels. The
claimed error of the reference is printed first. Pixels in which it claims more than 1e-7 are
excluded.

Columns of the table:
  setting          --tolerance or --samples of `marbles render`
  time             the median rendering time of the runs, which take turns
  speed-up         the time of supersampling at the same RMSE, divided by this time; interpolated
                   between the measured sample counts in a log-log plot, and extrapolated beyond
                   them (*)
  RMSE             root of the mean square error, over all channels of all pixels
  largest          the largest error of any channel of any pixel
  over             pixels whose error is certainly over the tolerance
  true/claimed     the true error of a pixel divided by its claimed error: the median over all
                   pixels that claim at least ten times the error of the reference
  largest/claimed  the largest true error divided by the largest claimed error
  bound            the share of pixels whose claimed error is a bound, that is, proved
  samples, lines   means per pixel: points at which light was computed, lines divided at edges

Exit codes:
  0  everything is measured and written, and every pixel is within its tolerance
  1  something failed
  2  the command line or the scene file is wrong
  3  everything is measured and written, and some pixel is over its tolerance
  130  interrupted";

/// Measure the speed and the error of tolerances and of supersampling
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

    /// Size of the picture in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(crate) size: Option<Size>,

    /// Render on N threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Seconds for all runs together, and for a better reference; 1, 2, 4, 8, … samples per side of a pixel are
    /// measured as long as their runs fit into this time, or into half of it if the tolerances are slow.
    /// All tolerances, and up to 4 × 4 samples, are measured at least once
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) seconds: f64,

    /// Runs of every setting; the median time counts
    #[arg(long, value_name = "N", default_value = "5", value_parser = runs, allow_negative_numbers = true)]
    pub(crate) runs: usize,

    /// Write the table and additional columns as CSV
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,

    /// Draw time against RMSE, as SVG
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,

    /// Print only errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
