//! Alters files of all kinds at random, and looks for what panics, takes long or much memory:
//! `cargo mutate [--seconds N] [--seed N]`, N seconds for each kind of input.

use std::process::ExitCode;

use marbles_tests::mutations::{Limit, most_memory, search_all};

/// The memory that all of them together may take, in bytes.
const MOST_MEMORY: u64 = 1_000_000_000;

#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a tool of the command line"
)]
fn main() -> ExitCode {
    let mut options = [("--seconds", 60), ("--seed", 1)];
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let option = options.iter_mut().find(|option| option.0 == word);
        let number = words.next().and_then(|number| number.parse().ok());
        let (Some(option), Some(number)) = (option, number) else {
            eprintln!("expected --seconds N or --seed N, found {word}");
            return ExitCode::from(2);
        };
        option.1 = number;
    }
    let [(_, seconds), (_, seed)] = options;
    let all = search_all(seed, Limit::Seconds(seconds));
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
    let memory = most_memory();
    if let Some(memory) = memory {
        println!("memory: {} MB at most", memory / 1_000_000);
    }
    let is_clean = all.iter().all(|(_, found)| found.faults.is_empty());
    let is_small = memory.is_none_or(|memory| memory <= MOST_MEMORY);
    ExitCode::from(u8::from(!(is_clean && is_small)))
}
