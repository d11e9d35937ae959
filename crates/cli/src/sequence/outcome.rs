//! The outcome of a sequence: written, skipped and failed frames.

use std::collections::HashSet;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use marbles_core::Summary;

use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::terminal::progress::Progress;

/// The outcome of a sequence.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    /// The number of requested pictures: usually one per frame.
    pub(crate) pictures: u64,
    /// The number of pictures whose files were written.
    pub(crate) written: u64,
    /// The number of pictures whose files existed.
    pub(crate) skipped: u64,
    /// Frames that could not be rendered or written.
    pub(crate) failed: Vec<i32>,
    /// The reason for the first failure.
    pub(crate) failure: Option<String>,
    /// The combined results of the written frames.
    pub(crate) total: Option<Summary>,
    /// The number of pixels of the written frames that are too bright for a PNG.
    pub(crate) clipped: u64,
    /// The rendering time of the written frames.
    pub(crate) time: Duration,
    /// Whether the user interrupted the work.
    pub(crate) interrupted: bool,
}

impl Outcome {
    /// Adds a written frame.
    pub(crate) fn add(&mut self, summary: Summary, clipped: u64, time: Duration) {
        self.written += 1;
        self.clipped += clipped;
        self.time += time;
        self.total = Some(self.total.map_or(summary, |total| total.and(&summary)));
    }

    /// Returns whether some pixel of a written frame is over the tolerance.
    pub(crate) fn is_over_tolerance(&self) -> bool {
        self.total.is_some_and(|total| total.over_tolerance > 0)
    }
}

/// The failed frames, collected by several threads.
pub(super) struct Failures {
    /// Whether the first failure ends the work.
    is_fatal: bool,
    stop: AtomicBool,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    frames: Vec<i32>,
    first: Option<String>,
    /// The reasons that were already reported.
    reasons: HashSet<String>,
}

impl Failures {
    /// No failures yet.
    pub(super) fn new(is_fatal: bool) -> Self {
        Self {
            is_fatal,
            stop: AtomicBool::new(false),
            state: Mutex::default(),
        }
    }

    /// Adds a failed frame whose file would be at `path`. Reports the reason unless it was reported for another frame:
    /// on a full disk, a thousand frames fail for the same reason.
    pub(super) fn add(&self, frame: i32, path: &Path, failure: &Failure, progress: &Progress) {
        let message = failure.to_string();
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.frames.push(frame);
        state.first.get_or_insert_with(|| message.clone());
        // The file and the number of the frame are others each time.
        let path = path.shown();
        let reason = message.strip_prefix(&path).unwrap_or(&message);
        let reason = reason.replacen(&format!("frame {frame}: "), "", 1);
        if state.reasons.insert(reason) {
            progress.failure(&Failure::Work(message));
        }
        if self.is_fatal || matches!(failure, Failure::Changed(_)) {
            self.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Returns whether the work should end.
    pub(super) fn stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// The failed frames, and the reason of the first failure.
    pub(super) fn into_frames(self) -> (Vec<i32>, Option<String>) {
        let state = self.state.into_inner();
        let State { frames, first, .. } = state.unwrap_or_else(PoisonError::into_inner);
        (frames, first)
    }
}

#[cfg(test)]
mod tests;
