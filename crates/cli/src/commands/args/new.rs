//! The arguments of `marbles new`.

use std::path::PathBuf;

use clap::Args;

/// Write a first scene, which you can change
#[derive(Debug, Args)]
pub(crate) struct NewArguments {
    /// Scene file to write; it must not exist yet
    #[arg(value_name = "NAME.ron")]
    pub(crate) scene: PathBuf,

    /// Make it a turntable: the camera goes around the scene in 120 frames
    #[arg(long)]
    pub(crate) turntable: bool,
}
