//! The arguments of `marbles merge`.

use std::path::PathBuf;

use clap::Args;

const EXAMPLES: &str = "\
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
#[command(after_help = EXAMPLES)]
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
