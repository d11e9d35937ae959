//! Threads that are kept from one rendering to the next, so that a small picture does not wait until they have started.

use std::ops::Deref;
use std::process;
use std::sync::{Mutex, PoisonError};

use rayon::ThreadPool;

use super::error::Error;
use crate::base::threads;

/// The most pools that are kept while nothing is rendered.
const MOST: usize = 2;

/// The pools that nothing uses, and of each the number of threads that was asked for and the process that started them: a
/// forked process does not have its parent's threads.
static IDLE: Mutex<Vec<Kept>> = Mutex::new(Vec::new());

struct Kept {
    pool: ThreadPool,
    asked: Option<usize>,
    process: u32,
}

/// A pool of threads, which goes back when it is dropped.
pub(super) struct Pool(Option<Kept>);

impl Pool {
    /// A pool of so many threads, or of one thread per core.
    pub(super) fn take(asked: Option<usize>) -> Result<Self, Error> {
        let process = process::id();
        let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
        while let Some(place) = idle.iter().position(|kept| kept.process != process) {
            // Its threads are the parent's: waiting for their end would never end.
            std::mem::forget(idle.swap_remove(place));
        }
        if let Some(place) = idle.iter().position(|kept| kept.asked == asked) {
            return Ok(Self(Some(idle.swap_remove(place))));
        }
        drop(idle);
        let pool = threads::start(asked)?;
        Ok(Self(Some(Kept {
            pool,
            asked,
            process,
        })))
    }
}

impl Deref for Pool {
    type Target = ThreadPool;

    fn deref(&self) -> &ThreadPool {
        let kept = self.0.as_ref();
        &kept.expect("it is there until it is dropped").pool
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kept) = self.0.take() {
            idle.push(kept);
        }
        let oldest = (idle.len() > MOST).then(|| idle.remove(0));
        drop(idle);
        drop(oldest);
    }
}
