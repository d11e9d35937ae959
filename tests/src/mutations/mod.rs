//! Alters files at random, and checks how marbles handles them.
//!
//! Every file must be read or refused. Panics are faults, and so are inputs that take too much time or memory.

mod mutate;
mod program;
mod rays;
mod scenes;
mod seeds;
mod sums;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use std::{env, fs, process, slice, thread};

use self::mutate::mutated;
use self::seeds::Seed;
use crate::numbers::Numbers;

/// A kind of input.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name.
    pub name: &'static str,
    /// The files that are altered. They may be made in a folder of the search.
    seeds: fn(&Path) -> Vec<Seed>,
    /// Reads an input like the program of a user; returns whether it was accepted.
    read: fn(&Input<'_>) -> bool,
}

/// All kinds of input.
pub const TARGETS: [Target; 6] = [
    Target {
        name: "scenes",
        seeds: |_| seeds::scenes(),
        read: scenes::read_scene,
    },
    Target {
        name: "tables",
        seeds: |_| seeds::tables(),
        read: scenes::read_table,
    },
    Target {
        name: "pictures",
        seeds: |_| seeds::pictures(),
        read: program::compare,
    },
    Target {
        name: "existing files",
        seeds: program::rendered,
        read: program::resume,
    },
    Target {
        name: "command lines",
        seeds: program::command_lines,
        read: program::plan,
    },
    Target {
        name: "rays",
        seeds: rays::seeds,
        read: rays::judge_some,
    },
];

/// An altered file.
struct Input<'a> {
    /// The name of the original file.
    name: &'a str,
    bytes: &'a [u8],
    folder: &'a PathBuf,
    numbers: u64,
}

impl Input<'_> {
    /// Writes the file under its name.
    fn write(&self) -> PathBuf {
        let path = self.folder.join(self.name);
        fs::write(&path, self.bytes).expect("a file can be written");
        path
    }
}

/// The results for some inputs.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The number of inputs.
    pub inputs: u64,
    /// The number of accepted inputs.
    pub taken: u64,
    /// The time of the slowest input, in seconds.
    pub slowest: f64,
    /// Files that caused a panic, or took too much time or memory.
    pub faults: Vec<PathBuf>,
}

/// The largest time for an input, in seconds, elapsed or of processor time.
const LONGEST: f64 = 5.0;

/// The length of a search.
#[derive(Clone, Copy, Debug)]
pub enum Limit {
    /// This many inputs of each kind.
    Inputs(u64),
    /// This many seconds for each kind.
    Seconds(u64),
}

impl Limit {
    fn is_reached(self, inputs: u64, start: Instant) -> bool {
        match self {
            Self::Inputs(most) => inputs >= most,
            Self::Seconds(most) => start.elapsed().as_secs() >= most,
        }
    }
}

/// Searches with all kinds of input, or with one of them, in parallel on all processors. An input is faulty if the process
/// takes more than `memory` bytes with it.
///
/// # Panics
/// If files cannot be written.
pub fn search_all(
    seed: u64,
    limit: Limit,
    only: Option<&'static Target>,
    memory: Option<u64>,
) -> Vec<(&'static Target, Found)> {
    let targets = only.map_or(&TARGETS[..], slice::from_ref);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(target) = targets.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let of_target = search(target, seed, limit, memory);
                    found
                        .lock()
                        .expect("nobody panics")
                        .push((target, of_target));
                }
            });
        }
    });
    found.into_inner().expect("nobody panics")
}

/// The name of the current input, in the folder of its kind.
const CURRENT: &str = "current";

/// The folder of this process, which contains a folder for each kind of input.
pub fn folder() -> PathBuf {
    env::temp_dir().join(format!("marbles-mutations-{}", process::id()))
}

/// Alters the seeds of a target.
///
/// Searches with altered inputs of a target. Faulty inputs are kept in the folder for temporary files.
fn search(target: &Target, seed: u64, limit: Limit, memory: Option<u64>) -> Found {
    let folder = folder().join(target.name.replace(' ', "-"));
    fs::create_dir_all(&folder).expect("a folder can be made");
    let seeds = (target.seeds)(&folder);
    let mut numbers = Numbers(seed);
    let mut found = Found::default();
    let begun = Instant::now();
    while !limit.is_reached(found.inputs, begun) {
        let seed = &seeds[numbers.below(seeds.len())];
        let other = &seeds[numbers.below(seeds.len())];
        let bytes = mutated(&mut numbers, &seed.bytes, &other.bytes);
        let input = Input {
            name: &seed.name,
            bytes: &bytes,
            folder: &folder,
            numbers: numbers.bits(),
        };
        // For those who look for what ended the process.
        fs::write(folder.join(CURRENT), &bytes).expect("a file can be written");
        let memory_before = most_memory();
        let timed = || {
            let (start, worked) = (Instant::now(), processor_seconds());
            let read = catch_unwind(AssertUnwindSafe(|| (target.read)(&input)));
            let passed = start.elapsed().as_secs_f64();
            // What others have of the processors does not count.
            let worked = processor_seconds()
                .zip(worked)
                .map(|(now, then)| now - then);
            (read, worked.map_or(passed, |worked| passed.min(worked)))
        };
        let (mut read, mut seconds) = timed();
        if read.is_ok() && seconds > LONGEST {
            // The other kinds may have had the processor.
            (read, seconds) = timed();
        }
        found.inputs += 1;
        found.taken += u64::from(matches!(read, Ok(true)));
        found.slowest = found.slowest.max(seconds);
        // Later inputs have as much without more of it.
        let is_large = memory.is_some_and(|most| {
            most_memory().is_some_and(|memory| memory > most) && most_memory() > memory_before
        });
        if read.is_err() || seconds > LONGEST || is_large {
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

/// The processor time of the process in seconds, if the system reports it.
fn processor_seconds() -> Option<f64> {
    /// Linux uses hundredths of a second for all programs.
    const TICK: f64 = 0.01;
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program stands before, in brackets, and eleven other fields.
    let (_, numbers) = stat.rsplit_once(')')?;
    let mut times = numbers.split_whitespace().skip(11);
    let mut next = || times.next()?.parse::<u32>().ok().map(f64::from);
    Some(TICK * (next()? + next()?))
}

/// The peak memory of the process in bytes, if the system reports it.
pub fn most_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn work_counts_as_long_as_it_takes() {
        let start = Instant::now();
        let before = processor_seconds().unwrap();
        while start.elapsed().as_secs_f64() < 0.5 {}
        let worked = processor_seconds().unwrap() - before;
        // Other tests of the process may work, too.
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let most = 1.1 * start.elapsed().as_secs_f64() * threads as f64;
        assert!((0.05..most).contains(&worked), "{worked}");
    }
}
