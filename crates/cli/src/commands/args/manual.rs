//! The arguments of `marbles completions` and `marbles man`.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  marbles completions bash > ~/.local/share/bash-completion/completions/marbles
  marbles completions zsh > ~/.zfunc/_marbles         a folder of fpath
  marbles completions fish > ~/.config/fish/completions/marbles.fish";

/// Print the file by which a shell completes the command line of marbles
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS_EXAMPLES)]
pub(crate) struct CompletionsArguments {
    /// Shell that reads it
    pub(crate) shell: Shell,
}

const MAN_EXAMPLES: &str = "\
Examples:
  marbles man render | man -l -                       read the page of marbles render
  marbles man -o ~/.local/share/man/man1              install all pages";

/// Print a page of the manual, or write all of them into a folder
#[derive(Debug, Args)]
#[command(after_help = MAN_EXAMPLES)]
pub(crate) struct ManArguments {
    /// Command that the page is about, farm-slurm for `marbles farm slurm` [default: the page of
    /// marbles, which names them all]
    pub(crate) command: Option<String>,

    /// Write the pages of marbles and of all its commands into this folder
    #[arg(short, long, value_name = "FOLDER", conflicts_with = "command")]
    pub(crate) output: Option<PathBuf>,
}
