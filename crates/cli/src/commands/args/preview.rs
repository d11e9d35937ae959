//! The arguments of `marbles preview`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;
use super::values::tolerance_above_zero;

const EXAMPLES: &str = "\
Examples:
  marbles preview ball.ron                            show the first frame
  marbles preview turn.ron --frame 30 --watch         show frame 30 whenever turn.ron is saved
  marbles preview photo.jpg                           show a picture, in any format that `marbles compare` reads

The picture fills the terminal, with two pixels, one above the other, for each character. The
terminal must support 24-bit color. Terminals with kitty's graphics protocol (kitty, Ghostty, WezTerm)
show the picture in the size of the scene instead; TERM=xterm disables this. If the output is not a
terminal, the picture is text with 80 columns.

With --watch, marbles shows the picture again when you save the scene file or one of its tables, and
when the size of the terminal changes. If there is an error in the file, marbles shows the error
instead. To end it, press `q`, Esc or Ctrl-C; the terminal then shows its former contents.

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

    /// Compute every channel of every pixel to within E of its exact value
    #[arg(long, value_name = "E", default_value = "1e-2", value_parser = tolerance_above_zero, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,

    /// Show the frame again whenever the scene file or one of its tables is saved
    #[arg(short, long)]
    pub(crate) watch: bool,
}
