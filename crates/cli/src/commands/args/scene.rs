//! The arguments of all commands that read a scene.

use clap::Args;
use marbles_scene::Setting;

/// Options that change a scene, and the checks on it.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct SceneOptions {
    /// Replace or add a value of the scene: --set 'lights[0].toward=(1, 1, -1)',
    /// --set materials.red.exponent=2; repeat the option for several values
    #[arg(long, value_name = "PATH=VALUE")]
    pub(crate) set: Vec<Setting>,

    /// Refuse scenes with warnings
    #[arg(long)]
    pub(crate) strict: bool,
}
