//! Broken input: files that are altered at random, and what becomes of them.
//!
//! Whatever a file holds, it is read or refused: a panic is a fault, and so is what takes long.

mod mutate;
mod seeds;
mod targets;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::Instant;
use std::{env, fs, process};

use self::mutate::mutated;
use self::seeds::Seed;
pub use self::targets::TARGETS;
use crate::numbers::Numbers;

/// A kind of input.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name.
    pub name: &'static str,
    seeds: fn() -> Vec<Seed>,
    /// Reads an input as a user's program would, in a folder of its own; returns whether it was taken.
    read: fn(&Input<'_>) -> bool,
}

/// An altered file.
struct Input<'a> {
    /// The name of the file that it was.
    name: &'a str,
    bytes: &'a [u8],
    folder: &'a PathBuf,
    numbers: u64,
}

/// What some inputs came to.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The number of inputs.
    pub inputs: u64,
    /// Those that were not refused.
    pub taken: u64,
    /// The seconds that the slowest took.
    pub slowest: f64,
    /// Files on which reading panicked, or took longer than it may.
    pub faults: Vec<PathBuf>,
}

/// The seconds that an input may take.
const LONGEST: f64 = 5.0;

/// Alters the seeds of a target until `goes_on` says no, which is asked before each input.
///
/// What is faulty is kept beside other temporary files.
///
/// # Panics
/// When files cannot be written.
pub fn search(target: &Target, seed: u64, mut goes_on: impl FnMut(u64) -> bool) -> Found {
    let folder = env::temp_dir().join(format!("marbles-mutations-{}", process::id()));
    let folder = folder.join(target.name);
    fs::create_dir_all(&folder).expect("a folder can be made");
    let seeds = (target.seeds)();
    let mut numbers = Numbers(seed);
    let mut found = Found::default();
    while goes_on(found.inputs) {
        let seed = &seeds[numbers.below(seeds.len())];
        let other = &seeds[numbers.below(seeds.len())];
        let bytes = mutated(&mut numbers, &seed.bytes, &other.bytes);
        let input = Input {
            name: &seed.name,
            bytes: &bytes,
            folder: &folder,
            numbers: numbers.bits(),
        };
        let start = Instant::now();
        let read = catch_unwind(AssertUnwindSafe(|| (target.read)(&input)));
        let seconds = start.elapsed().as_secs_f64();
        found.inputs += 1;
        found.taken += u64::from(matches!(read, Ok(true)));
        found.slowest = found.slowest.max(seconds);
        if read.is_err() || seconds > LONGEST {
            let kept = folder.join(format!("fault-{}-{}", found.inputs, seed.name));
            fs::write(&kept, &bytes).expect("a file can be written");
            found.faults.push(kept);
        }
    }
    if found.faults.is_empty() {
        // It is in nobody's way where that fails.
        let _ = fs::remove_dir_all(&folder);
    }
    found
}
