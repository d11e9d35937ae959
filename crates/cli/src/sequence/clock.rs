//! The times of pictures that are rendered one into the other.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Tells how long each picture of a sequence took, though one begins while others end: the sum is
/// the time that went by.
#[derive(Debug)]
pub(super) struct Clock {
    threads: usize,
    /// The time at which a picture ended last.
    last: Mutex<Option<Instant>>,
}

impl Clock {
    /// A clock for pictures on so many threads.
    pub(super) fn new(threads: usize) -> Self {
        Self {
            threads,
            last: Mutex::default(),
        }
    }

    /// Ends a picture that was begun at some time, of which all threads together spent `aside` on
    /// something else; returns how long it took, after those that ended before.
    pub(super) fn stop(&self, started: Instant, aside: Duration) -> Duration {
        let now = Instant::now();
        let last = self.last.lock();
        let last = last.unwrap_or_else(PoisonError::into_inner).replace(now);
        let since = last.map_or(started, |last| last.max(started));
        let each = aside / u32::try_from(self.threads).unwrap_or(u32::MAX);
        now.saturating_duration_since(since).saturating_sub(each)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_pictures_that_overlap_add_up() {
        let clock = Clock::new(2);
        let hour = Duration::from_secs(3600);
        let Some(started) = Instant::now().checked_sub(2 * hour) else {
            return;
        };
        // Two that began together: the second took what was left.
        assert!(clock.stop(started, Duration::ZERO) >= 2 * hour);
        assert!(clock.stop(started + hour, Duration::ZERO) < hour);
        let clock = Clock::new(2);
        let found = clock.stop(started, hour);
        assert!(found >= hour + hour / 2 && found < 2 * hour);
    }
}
