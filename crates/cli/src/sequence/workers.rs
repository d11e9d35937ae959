//! The workers: threads that move from picture to picture. A thread with nothing left to begin prepares the next
//! picture, or starts on it, while others finish the previous one.

use std::ops::ControlFlow;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rayon::Yield;

/// Work that threads share.
pub(super) trait SharedWork: Send + Sync {
    /// The number of parts that no thread has begun.
    fn left(&self) -> u32;

    /// Does parts of it until all of them are begun; breaks if all work should end.
    fn help(&self) -> ControlFlow<()>;
}

/// Does all the work that `prepare` returns, in its order, on the threads of the current rayon pool.
///
/// While the last parts of some work are done, the next work is prepared, but no more. Only one thread at a time calls
/// `prepare`; threads with nothing to do can help it through rayon.
pub(super) fn run<T: SharedWork>(prepare: impl FnMut() -> Option<T> + Send) {
    let workers = Workers {
        state: Mutex::new(State {
            current: None,
            next: None,
            preparation: Preparation::Waiting,
            is_over: false,
        }),
        changed: Condvar::new(),
    };
    let prepare = Mutex::new(prepare);
    rayon::broadcast(|context| workers.work(context.num_threads() as u32, &prepare));
}

struct Workers<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

struct State<T> {
    /// The current work.
    current: Option<Arc<T>>,
    /// The work after it.
    next: Option<Arc<T>>,
    preparation: Preparation,
    is_over: bool,
}

/// The state of the preparation of the next work.
#[derive(Clone, Copy, Eq, PartialEq)]
enum Preparation {
    /// No thread has begun it.
    Waiting,
    /// A thread is preparing it.
    Running,
    /// There is no more work.
    Over,
}

/// The next step of a thread.
enum Step<T> {
    Prepare,
    Help(Arc<T>),
    End,
}

impl<T: SharedWork> Workers<T> {
    fn work(&self, threads: u32, prepare: &Mutex<impl FnMut() -> Option<T>>) {
        // No thread waits for one that has panicked.
        let ending = Ending(self);
        loop {
            match self.next_step(threads) {
                Step::Prepare => {
                    let mut prepare = prepare.lock().unwrap_or_else(PoisonError::into_inner);
                    let next = prepare();
                    let mut state = self.lock();
                    state.preparation = if next.is_some() {
                        Preparation::Waiting
                    } else {
                        Preparation::Over
                    };
                    state.next = next.map(Arc::new);
                    self.changed.notify_all();
                }
                Step::Help(work) => {
                    if work.help().is_break() {
                        return;
                    }
                }
                Step::End => break,
            }
        }
        std::mem::forget(ending);
    }

    /// Waits until there is something to do.
    fn next_step(&self, threads: u32) -> Step<T> {
        /// The time that a thread waits before it looks for work again.
        const PAUSE: Duration = Duration::from_micros(200);
        let mut state = self.lock();
        loop {
            if state.is_over {
                return Step::End;
            }
            if state.current.as_ref().is_none_or(|work| work.left() == 0) {
                state.current = state.next.take();
            }
            let left = state.current.as_ref().map_or(0, |work| work.left());
            // The others have enough to do meanwhile.
            let is_time = left <= 2 * (threads - 1);
            if is_time && state.next.is_none() && state.preparation == Preparation::Waiting {
                state.preparation = Preparation::Running;
                return Step::Prepare;
            }
            if let Some(work) = &state.current
                && left > 0
            {
                return Step::Help(Arc::clone(work));
            }
            if state.preparation == Preparation::Over && state.next.is_none() {
                return Step::End;
            }
            drop(state);
            let has_helped = rayon::yield_now() == Some(Yield::Executed);
            state = self.lock();
            if !has_helped && state.preparation == Preparation::Running {
                let waited = self.changed.wait_timeout(state, PAUSE);
                state = waited.unwrap_or_else(PoisonError::into_inner).0;
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Ends all work when it goes out of scope.
struct Ending<'a, T: SharedWork>(&'a Workers<T>);

impl<T: SharedWork> Drop for Ending<'_, T> {
    fn drop(&mut self) {
        self.0.lock().is_over = true;
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests;
