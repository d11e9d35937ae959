//! `marbles man`: the pages of the manual, one about marbles and one for each command.

use clap::builder::Resettable;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

use super::args::{Arguments, ManArguments};
use crate::base::failure::Failure;
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
            console.result(&path.display().to_string());
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
            "expected a command that `marbles --help` names, found `{command}`"
        ))
    })?;
    console.print(&String::from_utf8_lossy(&text(page)?));
    Ok(status::SUCCESS)
}

/// A page, and its end as clap has it: examples, exit codes and so on.
struct Page {
    man: Man,
    end: String,
}

/// All pages, that of marbles first, and those of commands before those of their commands.
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
    let end = command.get_after_help().map(ToString::to_string);
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

/// A section for each list with a title, whose lines stay as they are, and paragraphs between them.
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
mod tests {
    use std::fs;

    use super::*;
    use crate::tests::run_here;

    #[test]
    fn every_command_has_a_page() {
        for command in Arguments::command().get_subcommands() {
            let name = command.get_name();
            let (code, page, err) = run_here(&["man", name]);
            assert_eq!((code, &*err), (0, ""), "{name}");
            let page = page.replace("\\-", "-");
            assert!(page.contains(&format!(".TH marbles-{name} 1")), "{page}");
            for argument in command.get_arguments().filter_map(|a| a.get_long()) {
                let option = format!("--{argument}");
                assert!(page.contains(&option), "{name} {option}");
            }
        }
        let (_, page, _) = run_here(&["man", "farm-slurm"]);
        assert!(page.replace("\\-", "-").contains("--chunk"), "{page}");
        let (_, page, _) = run_here(&["man", "render"]);
        let example = ".SH EXAMPLES\n.nf\n  marbles render ball.ron   ";
        assert!(page.contains(example), "{page}");
        assert!(
            page.contains(".SH \"EXIT CODES\"\n.nf\n  0  everything"),
            "{page}"
        );
        let (code, page, _) = run_here(&["man"]);
        assert_eq!(code, 0);
        assert!(
            page.replace("\\-", "-").contains("marbles-render(1)"),
            "{page}"
        );
    }

    #[test]
    fn pages_name_no_page_that_is_not_there() {
        let mut seen = 0;
        for page in pages() {
            let name = page.man.get_filename();
            let command = name.strip_suffix(".1").unwrap();
            let command = command.strip_prefix("marbles").unwrap();
            let command = command.strip_prefix('-');
            let (_, text, _) = run_here(&[&["man"], command.as_slice()].concat());
            let text = text.replace("\\-", "-");
            let start = format!(".TH {} 1 ", name.trim_end_matches(".1"));
            assert!(text.contains(&start), "{name}");
            for other in text.lines().filter_map(|line| line.strip_suffix("(1)")) {
                let other = other.strip_prefix("marbles-").unwrap();
                assert_eq!(run_here(&["man", other]).0, 0, "{name} names {other}");
                seen += 1;
            }
        }
        assert_eq!(seen + 1, pages().len());
    }

    #[test]
    fn unknown_commands_have_none() {
        let (code, out, err) = run_here(&["man", "paint"]);
        assert_eq!((code, &*out), (2, ""));
        assert!(err.contains("found `paint`"), "{err}");
    }

    #[test]
    fn a_folder_takes_all_pages() {
        let name = format!("marbles-{}-man", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let (code, out, err) = run_here(&["man", "-o", folder.to_str().unwrap()]);
        assert_eq!((code, &*err), (0, ""));
        let pages = fs::read_dir(&folder).unwrap().count();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(pages, super::pages().len());
        assert_eq!(out.lines().count(), pages);
    }
}
