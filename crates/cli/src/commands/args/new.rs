//! The arguments of `marbles new`.

use std::path::PathBuf;

use clap::Args;

use super::figure::FigureOptions;

const EXAMPLES: &str = "\
Examples:
  marbles new ball.ron                                write a scene of a few balls
  marbles new turn.ron --turntable                    write a turntable
  marbles new molecule.pdb                            write molecule.ron, a scene that shows this table
  marbles new molecule.pdb -o figure.ron --view top   the same, seen from above

The scene of a table is the one that `marbles render molecule.pdb` renders.

Exit codes:
  0  the scene is written
  1  something failed, or the scene file exists already
  2  the command line or the table is wrong";

/// Write a first scene, or the scene of a table of particles, which you can change
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct NewArguments {
    /// Scene file to write, which must not exist yet; or a table of particles that the scene shows
    #[arg(value_name = "NAME.ron|TABLE")]
    pub(crate) file: PathBuf,

    /// Scene file to write for a table; it must not exist yet [default: TABLE.ron, in the current folder]
    #[arg(short, long, value_name = "NAME.ron")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) figure: FigureOptions,

    /// Make the background white, as that of a table is by default
    #[arg(long, conflicts_with = "transparent")]
    pub(crate) white: bool,

    /// Say in the scene of a table how it is rendered without a background
    #[arg(long)]
    pub(crate) transparent: bool,
}
