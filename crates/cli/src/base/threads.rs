//! The rendering threads, and auxiliary threads.

use std::thread::{Builder, Scope, ScopedJoinHandle, available_parallelism};

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::failure::{Failure, without_number};
use super::memory;

/// The number of threads that are always allowed, and the largest surplus over the number of processors: more threads
/// would only wait for each other.
const ENOUGH: usize = 64;
const MOST_ON_A_PROCESSOR: usize = 4;

/// The address space that a thread needs at its start, in addition to its stack.
const ADDRESSES: u64 = 1 << 22;

/// Starts `count` threads, but no more than are useful; without a count one per core.
pub(crate) fn start(count: Option<usize>) -> Result<ThreadPool, Failure> {
    let processors = available_parallelism().map_or(1, usize::from);
    let count = useful(count, processors);
    let refused =
        |reason: &str| Failure::Work(format!("cannot start {count} rendering threads: {reason}"));
    // The standard library ends the process where a thread has memory for its stack, but not for more.
    if !memory::is_available(count as u64 * ADDRESSES) {
        return Err(refused("there is not enough memory for them"));
    }
    ThreadPoolBuilder::new()
        .num_threads(count)
        .build()
        .map_err(|error| refused(&without_number(&error.to_string())))
}

/// The number of threads to start, for the number that was `asked` for.
fn useful(asked: Option<usize>, processors: usize) -> usize {
    let most = ENOUGH.max(processors.saturating_mul(MOST_ON_A_PROCESSOR));
    asked.map_or(processors, |asked| asked.min(most))
}

/// Starts an auxiliary thread. If the system has no threads left, the error names its purpose, `what`.
pub(crate) fn start_one<'scope, T: Send + 'scope>(
    scope: &'scope Scope<'scope, '_>,
    what: &str,
    work: impl FnOnce() -> T + Send + 'scope,
) -> Result<ScopedJoinHandle<'scope, T>, Failure> {
    let started = Builder::new().spawn_scoped(scope, work);
    started.map_err(|error| {
        let reason = without_number(&error.to_string());
        Failure::Work(format!("cannot start the thread that {what}: {reason}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_threads_start_than_have_a_use() {
        for (asked, processors, expected) in [
            (None, 2, 2),
            (None, 128, 128),
            (Some(1), 2, 1),
            (Some(64), 2, 64),
            (Some(65), 2, 64),
            (Some(1024), 2, 64),
            (Some(1024), 16, 64),
            (Some(1024), 32, 128),
            (Some(100), 32, 100),
        ] {
            let what = format!("{asked:?} on {processors}");
            assert_eq!(useful(asked, processors), expected, "{what}");
        }
    }

    #[test]
    fn as_many_threads_start_as_are_told() {
        let processors = available_parallelism().map_or(1, usize::from);
        for asked in [None, Some(3), Some(1024)] {
            let pool = start(asked).map_err(|failure| failure.to_string()).unwrap();
            assert_eq!(pool.current_num_threads(), useful(asked, processors));
        }
    }
}
