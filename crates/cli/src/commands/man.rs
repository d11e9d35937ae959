//! `marbles man`: the pages of the manual, one about marbles and one for each command.

use clap::builder::Resettable;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

use super::args::{Arguments, ManArguments};
use crate::base::failure::Failure;
use crate::base::layout::lay_out;
use crate::base::shown::Shown;
use crate::base::status;
use crate::files::destination::prepare;
use crate::files::save::write_bytes;
use crate::terminal::console::Console;

pub(crate) fn run(arguments: &ManArguments, console: &Console) -> Result<u8, Failure> {
    let pages = pages();
    if let Some(folder) = &arguments.output {
        for page in pages {
            let path = folder.join(page.man.get_filename());
            prepare(&path)?;
            write_bytes(&text(&page)?, &path)?;
            console.result(&path.shown());
        }
        return Ok(status::SUCCESS);
    }
    let name = match &arguments.command {
        Some(command) => format!("marbles-{command}.1"),
        None => "marbles.1".to_owned(),
    };
    let page = pages.iter().find(|page| page.man.get_filename() == name);
    let page = page.ok_or_else(|| {
        let command = arguments.command.as_deref().unwrap_or_default();
        Failure::Usage(format!(
            "expected a command listed by `marbles --help`, found `{command}`"
        ))
    })?;
    console.print(&String::from_utf8_lossy(&text(page)?));
    Ok(status::SUCCESS)
}

/// The width of lines that are not wrapped. They fit next to the margin of a page with 80 columns.
const COLUMNS: usize = 72;

/// A page, with the end of clap's help text: examples, exit codes and so on.
struct Page {
    man: Man,
    end: String,
}

/// All pages: first that of marbles, then those of the commands, each before those of its subcommands.
fn pages() -> Vec<Page> {
    let mut command = Arguments::command().disable_help_subcommand(true);
    command.build();
    let mut commands = vec![command];
    let mut index = 0;
    while let Some(command) = commands.get(index) {
        let its: Vec<Command> = command.get_subcommands().cloned().collect();
        commands.extend(its);
        index += 1;
    }
    commands.into_iter().map(page).collect()
}

fn page(command: Command) -> Page {
    let end = command.get_after_help();
    let end = end.map(|help| lay_out(&help.to_string(), COLUMNS));
    let command = command.after_help(Resettable::Reset);
    Page {
        man: Man::new(command).source(concat!("marbles ", env!("CARGO_PKG_VERSION"))),
        end: end.unwrap_or_default(),
    }
}

fn text(page: &Page) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    let man = page.man.render(&mut text);
    let written = man.and_then(|()| end(&page.end).to_writer(&mut text));
    written.map_err(|error| Failure::Work(format!("cannot write the page: {error}")))?;
    Ok(text)
}

/// A section for each list with a title, whose lines are not wrapped, and paragraphs between them.
fn end(help: &str) -> Roff {
    let mut roff = Roff::new();
    for paragraph in help.split("\n\n") {
        match paragraph.split_once(":\n") {
            Some((title, lines)) if lines.starts_with(' ') => {
                roff.control("SH", [&*title.to_uppercase()]);
                roff.control("nf", []);
                for line in lines.lines() {
                    roff.text([roman(line)]);
                }
                roff.control("fi", []);
            }
            _ => {
                roff.control("PP", []);
                roff.text([roman(paragraph)]);
            }
        }
    }
    roff
}

#[cfg(test)]
mod tests;
