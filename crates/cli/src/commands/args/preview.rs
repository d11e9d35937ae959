//! The arguments of `marbles preview`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;
use super::values::tolerance_above_zero;

const EXAMPLES: &str = "\
Examples:
  marbles preview ball.ron                            the first frame
  marbles preview ball.ron --frame 30 --watch         frame 30, again whenever ball.ron is saved
  marbles preview photo.jpg                           a picture, in any format that `marbles compare` reads

The picture fills the terminal, two pixels one above the other for each letter, and needs
a terminal with 24-bit color. Terminals that speak the graphics protocol of kitty (kitty, Ghostty,
WezTerm) show pixels of their own, as many as the scene asks for; with TERM=xterm they don't. Where
the output is no terminal, it is a text of 80 columns.

With --watch the picture appears again when the scene file is saved, or a table that it names, and
when the terminal has a new size. What is wrong with a file that was saved stands in its place.
`q`, Esc and Ctrl-C end it, and the terminal shows what it showed before.

Exit codes:
  0  the picture was shown, or `q` or Esc ended --watch
  1  something failed
  2  the command line or the scene file is wrong
  130  interrupted by Ctrl-C";

/// Show a frame of a scene, or a picture, in the terminal
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct PreviewArguments {
    /// Scene file, or picture
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// Frame to show [default: the first]
    #[arg(long, value_name = "FRAME", allow_hyphen_values = true)]
    pub(crate) frame: Option<i32>,

    /// Bring every channel of every pixel within E of its exact value
    #[arg(long, value_name = "E", default_value = "1e-2", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Show it again whenever the scene file or one of its tables is saved
    #[arg(short, long)]
    pub(crate) watch: bool,
}
