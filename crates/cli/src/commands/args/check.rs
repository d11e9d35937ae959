//! The arguments of `marbles check`.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneOptions;

const EXAMPLES: &str = "\
Examples:
  marbles check ball.ron                              what the scene contains
  marbles check ball.ron --json | jq .camera.K        the matrix of its camera

Exit codes:
  0  the scene is valid
  1  something failed
  2  the command line or the scene file is wrong";

/// Validate a scene file and tell what it contains
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CheckArguments {
    /// Scene file
    pub(crate) scene: PathBuf,

    #[command(flatten)]
    pub(crate) options: SceneOptions,

    /// Print camera and lights of a frame as JSON: what `marbles render --sidecar` writes, without what only
    /// rendering knows
    #[arg(long)]
    pub(crate) json: bool,

    /// Frame that --json tells of [default: the scene's first]
    #[arg(
        long,
        value_name = "FRAME",
        allow_hyphen_values = true,
        requires = "json"
    )]
    pub(crate) frame: Option<i32>,
}
