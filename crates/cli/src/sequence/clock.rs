//! The times of pictures whose rendering overlaps.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Measures the time of each picture of a sequence, although one begins while others end. The sum of the times is the
/// elapsed time.
#[derive(Debug)]
pub(super) struct Clock {
    threads: usize,
    /// The time at which the previous picture ended.
    last: Mutex<Option<Instant>>,
}

impl Clock {
    /// A clock for pictures rendered on this number of threads.
    pub(super) fn new(threads: usize) -> Self {
        Self {
            threads,
            last: Mutex::default(),
        }
    }

    /// Ends a picture that began at this time; all threads together spent `aside` on other work. Returns the time that
    /// it took, beginning at the end of the previous picture.
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
