//! The command line of marbles.
//!
//! Every command is a file of `commands`. `sequence` renders frames one after the other, `formats` writes and reads
//! pictures through `files`, and `terminal` handles output to the user. [`library`] renders to memory, for other programs.

mod base;
mod commands;
mod files;
mod formats;
pub mod library;
mod sequence;
mod terminal;

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use crate::base::status;
use crate::commands::args::{Arguments, Command};
use crate::terminal::console::Console;
use crate::terminal::{abort, signals};

/// Runs the command line `args`, which begins with the name of the program, like the binary `marbles`.
pub fn run(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::from(exit_code(args))
}

/// Like [`run`], but returns the exit code as a number, for a process that goes on a little. Signals that end processes end
/// this one as they end the binary.
pub fn exit_code(args: impl IntoIterator<Item = OsString>) -> u8 {
    abort::end_as_failure();
    run_on(args, &Console::of_process())
}

/// Like [`run`], but with results and messages written to `out` and `err`, which are not terminals. Returns the exit
/// code.
pub fn run_with(
    args: impl IntoIterator<Item = OsString>,
    out: impl Write + Send + 'static,
    err: impl Write + Send + 'static,
) -> u8 {
    run_on(args, &Console::to(out, err))
}

/// Like [`run`], with a console to print to. Returns the exit code.
fn run_on(args: impl IntoIterator<Item = OsString>, console: &Console) -> u8 {
    let code = command(args, console);
    match console.lost_results() {
        Some(failure) => {
            console.failure(&failure);
            if code == status::SUCCESS {
                failure.exit_code()
            } else {
                code
            }
        }
        None => code,
    }
}

/// Runs the command.
fn command(args: impl IntoIterator<Item = OsString>, console: &Console) -> u8 {
    signals::outlive_file_limits();
    let arguments = match Arguments::of(args, console.columns()) {
        Ok(arguments) => arguments,
        Err(message) => {
            console.clap(&message.render(), message.use_stderr());
            return if message.use_stderr() {
                status::REFUSED
            } else {
                status::SUCCESS
            };
        }
    };
    let result = match arguments.command {
        Command::Render(arguments) => commands::render::run(&arguments, console),
        Command::Preview(arguments) => commands::preview::run(&arguments, console),
        Command::Check(arguments) => commands::check::run(&arguments, console),
        Command::Compare(arguments) => commands::compare::run(&arguments, console),
        Command::Merge(arguments) => commands::merge::run(&arguments, console),
        Command::Report(arguments) => commands::report::run(&arguments, console),
        Command::Spheres(arguments) => commands::spheres::run(&arguments, console),
        Command::Dataset(arguments) => commands::dataset::run(&arguments, console),
        Command::Farm(arguments) => commands::farm::run(&arguments, console),
        Command::New(arguments) => commands::new::run(&arguments, console),
        Command::Completions(arguments) => commands::completions::run(&arguments, console),
        Command::Man(arguments) => commands::man::run(&arguments, console),
    };
    result.unwrap_or_else(|failure| {
        console.failure(&failure);
        failure.exit_code()
    })
}

#[cfg(test)]
mod tests;
