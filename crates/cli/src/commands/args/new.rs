//! The arguments of `marbles new`.

use std::path::PathBuf;

use clap::Args;

/// Write a scene to start from
#[derive(Debug, Args)]
pub(crate) struct NewArguments {
    /// Scene file to write, which must not be there yet
    #[arg(value_name = "NAME.ron")]
    pub(crate) scene: PathBuf,

    /// Have the camera turn around the scene, in 120 frames
    #[arg(long)]
    pub(crate) turntable: bool,
}
