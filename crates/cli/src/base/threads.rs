//! The threads that render.

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::failure::{Failure, lower};

/// Starts `count` threads, or one per core.
pub(crate) fn start(count: Option<usize>) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new()
        .num_threads(count.unwrap_or_default())
        .build()
        .map_err(|error| {
            let reason = lower(&error.to_string());
            Failure::Work(format!("cannot start the threads that render: {reason}"))
        })
}
