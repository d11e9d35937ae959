//! Alters scenes and tables at random, and looks for what panics or takes long:
//! `cargo mutate [--seconds N] [--seed N]`, N seconds for each kind of input.

use std::process::ExitCode;
use std::time::Instant;

use marbles_tests::mutations::{TARGETS, search};

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
    let mut is_clean = true;
    for target in &TARGETS {
        let start = Instant::now();
        let found = search(target, seed, |_| start.elapsed().as_secs() < seconds);
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
        is_clean &= found.faults.is_empty();
    }
    ExitCode::from(u8::from(!is_clean))
}
