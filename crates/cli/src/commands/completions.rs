//! `marbles completions`: completion scripts for shells.

use clap::CommandFactory;

use super::args::{Arguments, CompletionsArguments};
use crate::base::failure::Failure;
use crate::base::status;
use crate::terminal::console::Console;

pub(crate) fn run(arguments: &CompletionsArguments, console: &Console) -> Result<u8, Failure> {
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, name, &mut script);
    console.print(&String::from_utf8_lossy(&script));
    Ok(status::SUCCESS)
}

#[cfg(test)]
mod tests;
