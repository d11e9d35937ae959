//! The arguments of `marbles check`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;

const EXAMPLES: &str = "\
Examples:
  marbles check ball.ron                              print the contents of the scene
  marbles check ball.ron --json | jq .camera.K        print the matrix of its camera

Exit codes:
  0  the scene is valid
  1  something failed
  2  the command line or the scene file is wrong";

/// Validate a scene file and print its contents
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CheckArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// Print the camera and the lights of a frame as JSON, like `marbles render --sidecar` but without the results of
    /// rendering
    #[arg(long)]
    pub(crate) json: bool,

    /// Frame for --json [default: the first]
    #[arg(
        long,
        value_name = "FRAME",
        allow_hyphen_values = true,
        requires = "json"
    )]
    pub(crate) frame: Option<i32>,
}
