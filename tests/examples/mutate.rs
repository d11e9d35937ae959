//! Alters files of all kinds at random, and looks for what panics, takes long or much memory:
//! `cargo mutate [--seconds N] [--seed N] [--target NAME]`, N seconds for each kind of input, or for one of them.

use std::process::{self, ExitCode};
use std::thread;
use std::time::Duration;

use marbles_tests::mutations::{Limit, TARGETS, folder, most_memory, search_all};

/// The memory that all of them together may take, in bytes, and that the process may have with an input.
const MOST_MEMORY: u64 = 1_000_000_000;
const MOST_WITH_AN_INPUT: u64 = 256_000_000;

#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a tool of the command line"
)]
fn main() -> ExitCode {
    let mut options = [("--seconds", 60), ("--seed", 1)];
    let mut words = std::env::args().skip(1);
    let mut only = None;
    while let Some(word) = words.next() {
        if word == "--target" {
            let name = words.next().unwrap_or_default();
            only = TARGETS.iter().find(|target| target.name == name);
            if only.is_none() {
                let names = TARGETS.map(|target| target.name).join(", ");
                eprintln!("expected one of {names}, found {name}");
                return ExitCode::from(2);
            }
            continue;
        }
        let option = options.iter_mut().find(|option| option.0 == word);
        let number = words.next().and_then(|number| number.parse().ok());
        let (Some(option), Some(number)) = (option, number) else {
            eprintln!("expected --seconds N, --seed N or --target NAME, found {word}");
            return ExitCode::from(2);
        };
        option.1 = number;
    }
    let [(_, seconds), (_, seed)] = options;
    thread::spawn(|| {
        loop {
            thread::sleep(Duration::from_millis(100));
            if most_memory().is_some_and(|memory| memory > MOST_MEMORY) {
                let folder = folder();
                eprintln!(
                    "too much memory, with one of {}/*/current",
                    folder.display()
                );
                process::exit(1);
            }
        }
    });
    let all = search_all(
        seed,
        Limit::Seconds(seconds),
        only,
        Some(MOST_WITH_AN_INPUT),
    );
    for (target, found) in &all {
        println!(
            "{}: {} inputs, {} taken, the slowest {:.2} s, {} faults",
            target.name,
            found.inputs,
            found.taken,
            found.slowest,
            found.faults.len()
        );
        for fault in &found.faults {
            println!("  {}", fault.display());
        }
    }
    if let Some(memory) = most_memory() {
        println!("memory: {} MB at most", memory / 1_000_000);
    }
    let is_clean = all.iter().all(|(_, found)| found.faults.is_empty());
    ExitCode::from(u8::from(!is_clean))
}
