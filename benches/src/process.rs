//! Runs commands of marbles in separate processes, and reads their output.
//!
//! The process is the benchmark itself, started again, because `cargo bench` does not build `marbles`.

use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

/// The first argument of a process that runs a command.
const COMMAND: &str = "marbles";

/// Runs the benchmarks of a file like [`crate::main`], or the command for which [`marbles`] started this process.
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
/// If it cannot be run, or fails.
pub fn marbles(folder: &Path, words: &[&str]) -> String {
    let program = env::current_exe().expect("the benchmark has a path");
    let mut command = Command::new(program);
    command.arg(COMMAND).args(words).current_dir(folder);
    let output = command.stderr(Stdio::inherit()).output();
    let output = output.unwrap_or_else(|error| panic!("{words:?}: {error}"));
    assert!(output.status.success(), "{words:?}: {}", output.status);
    String::from_utf8(output.stdout).expect("marbles prints text")
}

/// The memory of a process, in bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held {
    /// The current memory.
    pub now: u64,
    /// The peak so far.
    pub most: u64,
}

/// Runs a command that renders some frames. Returns the seconds of each frame, where the first includes the start of
/// the process, and the memory during the second frame.
///
/// # Panics
/// If it cannot be run, or fails, or the system does not report the memory of processes.
pub fn watched(folder: &Path, words: &[&str], frames: usize) -> (Vec<f64>, Held) {
    let program = env::current_exe().expect("the benchmark has a path");
    let mut command = Command::new(program);
    command.arg(COMMAND).args(words).current_dir(folder);
    let child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::inherit())
        .spawn();
    let mut child = child.unwrap_or_else(|error| panic!("{words:?}: {error}"));
    let lines = BufReader::new(child.stdout.take().expect("stdout is piped")).lines();
    let (mut times, mut held) = (Vec::new(), Held::default());
    let mut start = Instant::now();
    for line in lines {
        line.expect("marbles prints text");
        if times.len() < frames {
            times.push(start.elapsed().as_secs_f64());
            start = Instant::now();
        }
        if times.len() == 1 {
            held = held_by(child.id());
        }
    }
    let status = child.wait().expect("the process ends");
    assert!(status.success() && times.len() == frames, "{words:?}");
    (times, held)
}

/// The memory of a process.
fn held_by(process: u32) -> Held {
    let status = fs::read_to_string(format!("/proc/{process}/status"));
    let status = status.expect("Linux tells what a process holds");
    let of = |name: &str| -> u64 {
        let line = status.lines().find_map(|line| line.strip_prefix(name));
        let number = line.and_then(|line| line.split_whitespace().next());
        let kilobytes: Option<u64> = number.and_then(|number| number.parse().ok());
        kilobytes.expect("a number of kilobytes") * 1024
    };
    Held {
        now: of("VmRSS:"),
        most: of("VmHWM:"),
    }
}
