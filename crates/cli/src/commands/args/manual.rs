//! The arguments of `marbles completions` and `marbles man`.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  marbles completions bash > ~/.local/share/bash-completion/completions/marbles
  marbles completions zsh > ~/.zfunc/_marbles         if ~/.zfunc is in fpath
  marbles completions fish > ~/.config/fish/completions/marbles.fish";

/// Print a completion script for a shell
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS_EXAMPLES)]
pub(crate) struct CompletionsArguments {
    /// Shell for which to print it
    pub(crate) shell: Shell,
}

const MAN_EXAMPLES: &str = "\
Examples:
  marbles man render | man -l -                       read the page about `marbles render`
  marbles man -o ~/.local/share/man/man1              install all pages";

/// Print a page of the manual, or write all of them into a folder
#[derive(Debug, Args)]
#[command(after_help = MAN_EXAMPLES)]
pub(crate) struct ManArguments {
    /// Command whose page is printed, for example render, or farm-slurm for `marbles farm slurm` [default: the
    /// page about marbles, which lists all commands]
    pub(crate) command: Option<String>,

    /// Write the pages about marbles and all its commands to this folder
    #[arg(short, long, value_name = "FOLDER", conflicts_with = "command")]
    pub(crate) output: Option<PathBuf>,
}
