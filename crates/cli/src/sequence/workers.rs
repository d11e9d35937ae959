//! Threads that go from picture to picture: who finds nothing to begin in one prepares the next, or
//! goes on with it, while others end the one before.

use std::ops::ControlFlow;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rayon::Yield;

/// Work that threads share.
pub(super) trait Shared: Send + Sync {
    /// How many parts of it nobody has begun.
    fn left(&self) -> u32;

    /// Does parts of it until there is none that nobody has begun; breaks when all work ends.
    fn help(&self) -> ControlFlow<()>;
}

/// Does all the work that `prepare` gives, in its order, on the threads of the current rayon pool.
///
/// While the last parts of something are done, the next is prepared, and not more: `prepare` is called
/// by one thread at a time, and those that have nothing to do take parts in what it does by way of
/// rayon.
pub(super) fn run<T: Shared>(prepare: impl FnMut() -> Option<T> + Send) {
    let flow = Flow {
        state: Mutex::new(State {
            current: None,
            next: None,
            source: Source::Ready,
            is_over: false,
        }),
        changed: Condvar::new(),
    };
    let prepare = Mutex::new(prepare);
    rayon::broadcast(|context| flow.work(context.num_threads() as u32, &prepare));
}

struct Flow<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

struct State<T> {
    /// What is being done.
    current: Option<Arc<T>>,
    /// What comes after it.
    next: Option<Arc<T>>,
    source: Source,
    is_over: bool,
}

/// What comes after that.
#[derive(Clone, Copy, Eq, PartialEq)]
enum Source {
    Ready,
    /// Somebody prepares it.
    Busy,
    /// Nothing.
    Dry,
}

/// What a thread does.
enum Turn<T> {
    Prepare,
    Help(Arc<T>),
    End,
}

impl<T: Shared> Flow<T> {
    fn work(&self, threads: u32, prepare: &Mutex<impl FnMut() -> Option<T>>) {
        // Nobody waits for a thread that has panicked.
        let ending = Ending(self);
        loop {
            match self.turn(threads) {
                Turn::Prepare => {
                    let mut prepare = prepare.lock().unwrap_or_else(PoisonError::into_inner);
                    let next = prepare();
                    let mut state = self.lock();
                    state.source = if next.is_some() {
                        Source::Ready
                    } else {
                        Source::Dry
                    };
                    state.next = next.map(Arc::new);
                    self.changed.notify_all();
                }
                Turn::Help(work) => {
                    if work.help().is_break() {
                        return;
                    }
                }
                Turn::End => break,
            }
        }
        std::mem::forget(ending);
    }

    /// Waits until there is something to do.
    fn turn(&self, threads: u32) -> Turn<T> {
        /// How long a thread waits before it looks again for work that another one shares.
        const PAUSE: Duration = Duration::from_micros(200);
        let mut state = self.lock();
        loop {
            if state.is_over {
                return Turn::End;
            }
            if state.current.as_ref().is_none_or(|work| work.left() == 0) {
                state.current = state.next.take();
            }
            let left = state.current.as_ref().map_or(0, |work| work.left());
            // The others have enough to do meanwhile.
            let is_time = left <= 2 * (threads - 1);
            if is_time && state.next.is_none() && state.source == Source::Ready {
                state.source = Source::Busy;
                return Turn::Prepare;
            }
            if let Some(work) = &state.current
                && left > 0
            {
                return Turn::Help(Arc::clone(work));
            }
            if state.source == Source::Dry && state.next.is_none() {
                return Turn::End;
            }
            drop(state);
            let has_helped = rayon::yield_now() == Some(Yield::Executed);
            state = self.lock();
            if !has_helped && state.source == Source::Busy {
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
struct Ending<'a, T: Shared>(&'a Flow<T>);

impl<T: Shared> Drop for Ending<'_, T> {
    fn drop(&mut self) {
        self.0.lock().is_over = true;
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests;
