//! Measures the figures of the documents anew, one command after another, and tells how long each took.
//!
//! `cargo measure-all` runs everything, which takes hours; `cargo measure-all hits sequences` runs only these.
//! The hunts are the commands that docs/hunt.md shows.

use std::env;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

/// Aliases of cargo, without `measure-`: those that take minutes first.
const ALIASES: [&str; 7] = [
    "hits",
    "sequences",
    "report",
    "memory",
    "growth",
    "loose",
    "build",
];
/// The hunts, which take longest.
const HUNT: &str = "hunt";
const PAGE: &str = "docs/hunt.md";

fn main() -> io::Result<ExitCode> {
    let chosen: Vec<String> = env::args().skip(1).collect();
    let names = || ALIASES.into_iter().chain([HUNT]);
    if let Some(name) = chosen.iter().find(|chosen| names().all(|it| it != *chosen)) {
        let known = names().collect::<Vec<_>>().join(", ");
        writeln!(io::stderr(), "expected some of {known}, found {name}")?;
        return Ok(ExitCode::from(2));
    }
    let mut out = io::stdout().lock();
    let mut failed = Vec::new();
    for name in names().filter(|name| chosen.is_empty() || chosen.iter().any(|it| it == name)) {
        for words in commands(name)? {
            let command = format!("cargo {}", words.join(" "));
            writeln!(out, "{command}")?;
            let start = Instant::now();
            let is_done = cargo(&words)?;
            let result = if is_done { "took" } else { "failed after" };
            let seconds = start.elapsed().as_secs_f64();
            writeln!(out, "{command}: {result} {seconds:.0} s\n")?;
            if !is_done {
                failed.push(command);
            }
        }
    }
    for command in &failed {
        writeln!(io::stderr(), "failed: {command}")?;
    }
    Ok(if failed.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// The words after `cargo` of all commands that a name stands for.
fn commands(name: &str) -> io::Result<Vec<Vec<String>>> {
    if name != HUNT {
        return Ok(vec![vec![format!("measure-{name}")]]);
    }
    let page = fs::read_to_string(repository().join(PAGE))?;
    let shown = page.lines().filter_map(|line| {
        let command = line.strip_prefix("`cargo truth hunt")?;
        command.strip_suffix('`')
    });
    let hunt = |options: &str| {
        let fixed = ["truth", "hunt", "--page", PAGE].map(str::to_owned);
        fixed.into_iter().chain(words(options)).collect()
    };
    Ok(shown.map(hunt).collect())
}

/// The words of a command, of which some are quoted.
fn words(text: &str) -> Vec<String> {
    let parts = text.split('\'').enumerate();
    let words = parts.flat_map(|(index, part)| match index % 2 {
        0 => part.split_whitespace().map(str::to_owned).collect(),
        _ => vec![part.to_owned()],
    });
    words.collect()
}

/// Runs a command of cargo in the repository; true if it succeeds.
fn cargo(words: &[String]) -> io::Result<bool> {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let status = command.args(words).current_dir(repository()).status()?;
    Ok(status.success())
}

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}
