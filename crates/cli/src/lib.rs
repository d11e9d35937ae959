//! The command line of marbles.
//!
//! Every command is a file: [`render`] and [`check`]. Pictures become files in [`output`], frames
//! follow each other in [`sequence`].

mod args;
mod check;
mod console;
mod failure;
mod frames;
mod interrupt;
mod numbers;
mod output;
mod pattern;
mod progress;
mod rational;
mod render;
mod sequence;
mod status;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

use crate::args::{Arguments, Command};
use crate::console::Console;

/// Runs the command line `args`, the program's name first, as the binary `marbles` does.
pub fn run(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::from(run_on(args, &Console::of_process()))
}

/// As [`run`], with the exit code of [`status`] as a number.
fn run_on(args: impl IntoIterator<Item = OsString>, console: &Console) -> u8 {
    let arguments = match Arguments::try_parse_from(args) {
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
        Command::Render(arguments) => render::run(&arguments, console),
        Command::Check(arguments) => check::run(&arguments, console),
    };
    result.unwrap_or_else(|failure| {
        console.failure(&failure);
        failure.exit_code()
    })
}
