//! Alters inputs of all kinds at random, and looks for panics, and for inputs that take too much time or memory.
//!
//! `cargo mutate --help` prints the usage.

use std::process::{self, ExitCode};
use std::thread;
use std::time::Duration;

use marbles_tests::mutations::{Limit, TARGETS, folder, most_memory, search_all};

const USAGE: &str = "\
cargo mutate [--seconds 60] [--seed 1] [--target NAME]
    Alters scenes, tables, pictures and options at random, and renders or reads them. Reports panics, and inputs that take too
    much time or memory. Also compares the hits of random rays with exact arithmetic.
    --seconds  the time for each kind of input
    --seed     the first number of the random generator; the same seed makes the same inputs
    --target   take only this kind of input:";

/// The largest amount of memory that all inputs together may take, and that the process may have with a single input, in
/// bytes.
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
    let names = TARGETS.map(|target| target.name).join(", ");
    while let Some(word) = words.next() {
        if matches!(word.as_str(), "--help" | "-h") {
            println!("{USAGE} {names}");
            return ExitCode::SUCCESS;
        }
        if word == "--target" {
            let name = words.next().unwrap_or_default();
            only = TARGETS.iter().find(|target| target.name == name);
            if only.is_none() {
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
                    "too much memory; one of {}/*/current is the input",
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
            "{}: {} inputs, {} accepted, slowest {:.2} s, {} faults",
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
        println!("peak memory: {} MB", memory / 1_000_000);
    }
    let is_clean = all.iter().all(|(_, found)| found.faults.is_empty());
    ExitCode::from(u8::from(!is_clean))
}
