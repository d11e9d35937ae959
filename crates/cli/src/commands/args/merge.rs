//! The arguments of `marbles merge`.

use std::path::PathBuf;

use clap::Args;

const EXAMPLES: &str = "\
Examples:
  marbles render huge.ron -o left.exr --region 0,0,4096,8192
  marbles render huge.ron -o right.exr --region 4096,0,4096,8192
  marbles merge huge.exr left.exr right.exr

The picture is the same, to the byte, as one that was rendered as a whole.

Exit codes:
  0  the picture is written
  1  something failed
  2  the command line is wrong, or the parts do not make a picture: there is a gap, two parts overlap,
     or they come from different scenes, frames or settings";

/// Join parts of a picture that were rendered with --region
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct MergeArguments {
    /// Picture to write, in the format of the parts
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// Parts of the picture, in any order
    #[arg(value_name = "PARTS", required = true)]
    pub(crate) parts: Vec<PathBuf>,

    /// Print only errors and warnings
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
