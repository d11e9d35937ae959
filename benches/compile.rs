//! Measures how long a new user waits for the build.
//!
//! Counts the lines of code that the compiler generates for `marbles-core` before it optimizes them. They decide the compile
//! time of the crate, and do not depend on the speed of the machine. Then runs the README's commands `cargo run` and `cargo
//! test` with empty build folders. This needs Linux, which reports the time and the memory of processes. With `-- --write`,
//! the results become parts of docs/growth.md.
//!
//! With `-- --lines`, it only counts the lines. Without `--write`, it fails if there are a fortieth more than on the page.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use marbles_benches::page::Page;
use marbles_benches::{Folder, helps, in_repository, is_to_write};

const PAGE: &str = "docs/growth.md";
const COMMANDS: [&str; 2] = [
    "cargo run --release --locked --quiet -- render scenes/turntable.ron --quiet -o FOLDER/turntable.####.png",
    "cargo test --workspace --locked --quiet",
];
/// The text after the number of lines in the page.
const LINES: &str = " lines of generated code.";

#[expect(clippy::print_stdout, reason = "the table is what a benchmark is for")]
fn main() -> ExitCode {
    if helps() {
        return ExitCode::SUCCESS;
    }
    let mut page = Page::open(PAGE, &["lines", "build"]);
    let (lines, known) = (lines(), known_lines());
    println!("{lines}{LINES} {PAGE} has {known}.");
    if is_to_write() {
        page.write("lines", &format!("{lines}{LINES}"));
    } else if lines > known + known / 40 {
        return ExitCode::FAILURE;
    }
    if std::env::args().any(|argument| argument == "--lines") {
        return ExitCode::SUCCESS;
    }
    let mut table = String::from(
        "| | elapsed time | processor time | peak memory of a compiler process |\n|---|--:|--:|--:|\n",
    );
    for (command, name) in COMMANDS.into_iter().zip(["cargo run", "cargo test"]) {
        let Run {
            wall,
            processors,
            memory,
        } = run(command);
        let memory = memory as f64 / 1e9;
        let _ = writeln!(
            table,
            "| `{name}` | {wall:.0} s | {processors:.0} s | {memory:.1} GB |"
        );
    }
    println!("{table}");
    if is_to_write() {
        page.write("build", &table);
    }
    ExitCode::SUCCESS
}

/// The number of lines of LLVM IR for the core, after always-inlined functions are inlined and before any other optimization.
fn lines() -> u64 {
    let folder = Folder::new();
    let file = folder.0.join("core.ll");
    let emit = format!("--emit=llvm-ir={}", file.display());
    let status = cargo("cargo rustc --release --locked --quiet --package marbles-core --lib --")
        .args([&emit, "-Cno-prepopulate-passes", "-Cpasses=always-inline"])
        .env("CARGO_TARGET_DIR", folder.0.join("target"))
        .status();
    assert!(status.is_ok_and(|status| status.success()));
    let file = File::open(file).expect("the compiler writes a file");
    BufReader::new(file).split(b'\n').count() as u64
}

/// The number on the page; 0 if there is none yet.
fn known_lines() -> u64 {
    let page = fs::read_to_string(in_repository(PAGE)).expect("the page can be read");
    let number = page.lines().find_map(|line| line.strip_suffix(LINES));
    number.and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// A command whose words contain no spaces, in the folder of the repository.
fn cargo(words: &str) -> Command {
    let mut words = words.split_whitespace();
    let mut command = Command::new(words.next().expect("a command has words"));
    command.args(words).current_dir(in_repository(""));
    command
}

struct Run {
    /// In seconds.
    wall: f64,
    processors: f64,
    /// In bytes.
    memory: u64,
}

/// Runs a command with an empty build folder.
fn run(command: &str) -> Run {
    let folder = Folder::new();
    let command = command.replace("FOLDER", &folder.0.display().to_string());
    let (start, before) = (Instant::now(), children_time());
    let child = cargo(&command)
        .env("CARGO_TARGET_DIR", folder.0.join("target"))
        .stdout(Stdio::null())
        .spawn();
    let mut child = child.unwrap_or_else(|error| panic!("{command}: {error}"));
    let mut memory = 0;
    let status = loop {
        memory = memory.max(compilers_memory());
        if let Some(status) = child.try_wait().expect("the process can be asked") {
            break status;
        }
        thread::sleep(Duration::from_millis(100));
    };
    assert!(status.success(), "{command}: {status}");
    Run {
        wall: start.elapsed().as_secs_f64(),
        processors: children_time() - before,
        memory,
    }
}

/// The processor time of all ended child processes and of their children, in seconds.
fn children_time() -> f64 {
    /// Ticks per second in the times of Linux.
    const TICKS: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").expect("Linux reports the times of processes");
    // 13 other fields follow the name in parentheses.
    let numbers = stat.rsplit(')').next().unwrap_or_default();
    let mut times = numbers.split_whitespace().skip(13).map(str::parse::<f64>);
    let mut next = || {
        times
            .next()
            .and_then(Result::ok)
            .expect("a number of ticks")
    };
    (next() + next()) / TICKS
}

/// The largest peak memory of the compiler processes that are running, in bytes.
fn compilers_memory() -> u64 {
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    let held = processes.filter_map(|process| held_by_compiler(&process.path()));
    held.max().unwrap_or(0)
}

fn held_by_compiler(process: &Path) -> Option<u64> {
    let name = fs::read_to_string(process.join("comm")).ok()?;
    let status = fs::read_to_string(process.join("status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes: u64 = line?.split_whitespace().next()?.parse().ok()?;
    (name.trim() == "rustc").then_some(kilobytes * 1024)
}
