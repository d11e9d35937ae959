//! Commands of marbles in processes of their own, whose output can be read.
//!
//! The process is the benchmark itself, started again: `cargo bench` does not build `marbles`.

use std::env;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

/// The first argument of a process that runs a command.
const COMMAND: &str = "marbles";

/// Runs the benchmarks of a file as [`crate::main`] does, or the command for which [`marbles`]
/// started this process.
pub fn main(benchmarks: impl FnOnce() + Send) -> ExitCode {
    let mut words = env::args_os().skip(1).peekable();
    if words.peek().is_some_and(|word| word == COMMAND) {
        return marbles_cli::run(words);
    }
    crate::main(benchmarks);
    ExitCode::SUCCESS
}

/// Runs a command in a folder, and returns what it printed on stdout.
///
/// # Panics
/// When it cannot be run, or fails.
pub fn marbles(folder: &Path, words: &[&str]) -> String {
    let program = env::current_exe().expect("the benchmark has a path");
    let mut command = Command::new(program);
    command.arg(COMMAND).args(words).current_dir(folder);
    let output = command.stderr(Stdio::inherit()).output();
    let output = output.unwrap_or_else(|error| panic!("{words:?}: {error}"));
    assert!(output.status.success(), "{words:?}: {}", output.status);
    String::from_utf8(output.stdout).expect("marbles prints text")
}
