//! The arguments of `marbles preview`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;
use super::values::tolerance_above_zero;

const EXAMPLES: &str = "\
Examples:
  marbles preview ball.ron                            show the first frame, and move the camera
  marbles preview molecule.pdb                        find an angle for a table of particles
  marbles preview turn.ron --frame 30 --watch         show frame 30 whenever turn.ron is saved
  marbles preview photo.jpg                           show a picture, in any format that `marbles compare` reads

Keys:
  arrows   move the camera around what it looks at, by 5 degrees; with Shift, by 1 degree
  + -      zoom
  r R      roll the camera clockwise, or counterclockwise
  Home     back to the camera of the file
  w        write the camera into the scene file, in which nothing else changes
  p        quit, and print the camera as a line of a scene file
  q Esc    quit

If the keyboard or the output is not a terminal, or with --once, marbles prints one picture and ends.

The picture fills the terminal, with two pixels, one above the other, for each character. The
terminal must support 24-bit color. Terminals with kitty's graphics protocol (kitty, Ghostty, WezTerm)
or with sixel (foot, xterm -ti vt340, VS Code with its images enabled) show the picture in the size of
the scene instead; TERM=xterm disables this. If the output is not a terminal, the picture is text with
80 columns.

With --watch, marbles shows the picture again when you save the scene file or one of its tables, and
when the size of the terminal changes. If there is an error in the file, marbles shows the error
instead. To end it, press `q`, Esc or Ctrl-C; the terminal then shows its former contents.

Exit codes:
  0  the picture was shown, or `q`, Esc or `p` ended the preview
  1  something failed
  2  the command line or the scene file is wrong
  130  interrupted by Ctrl-C";

/// Show a frame of a scene, or a picture, in the terminal, and move the camera by keys
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct PreviewArguments {
    /// Scene file, table of particles, or picture
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

    /// Print one picture, and leave the camera alone
    #[arg(long, conflicts_with = "watch")]
    pub(crate) once: bool,
}
