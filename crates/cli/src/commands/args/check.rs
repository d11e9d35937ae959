//! The arguments of `marbles check`.

use std::path::PathBuf;

use clap::Args;

/// Validate a scene file and tell what it contains
#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// Scene file
    pub(crate) scene: PathBuf,
}
