//! Repeats the measurements of the pages, one command after another, and prints the time that each takes.
//!
//! The hunts are the commands in docs/hunt.md. `cargo measure-all --help` prints the usage.

use std::env;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

const USAGE: &str = "\
cargo measure-all [NAME]...
    Measures the figures of the pages again, and writes them into the pages. This takes hours.
    NAME    run only this measurement:";

/// Aliases of cargo, without `measure-`. The first ones take minutes.
const ALIASES: [&str; 7] = [
    "hits",
    "sequences",
    "report",
    "memory",
    "growth",
    "loose",
    "build",
];
/// The hunts, which take the longest time.
const HUNT: &str = "hunt";
const PAGE: &str = "docs/hunt.md";

fn main() -> io::Result<ExitCode> {
    let chosen: Vec<String> = env::args().skip(1).collect();
    let names = || ALIASES.into_iter().chain([HUNT]);
    let known = names().collect::<Vec<_>>().join(", ");
    if chosen.iter().any(|it| matches!(&**it, "--help" | "-h")) {
        writeln!(io::stdout(), "{USAGE} {known}")?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(name) = chosen.iter().find(|chosen| names().all(|it| it != *chosen)) {
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

/// The arguments of `cargo` for each command of a measurement.
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

/// The words of a command. Words in quotation marks may contain spaces.
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
