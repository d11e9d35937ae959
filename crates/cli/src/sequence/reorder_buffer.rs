//! The reorder buffer between the rendering threads and the writer: pieces of pictures arrive in any order, and leave
//! in order.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use crate::formats::encoder::Piece;

/// A buffer of pieces. They are added as they are made, and removed in the order of their numbers, which continue from
/// picture to picture.
pub(super) struct ReorderBuffer {
    state: Mutex<State>,
    /// Signals that the next piece has arrived, or that the buffer is closed.
    arrived: Condvar,
    /// Signals that a piece was removed, or that the buffer is closed.
    moved: Condvar,
    /// The largest number of pieces at a time.
    capacity: u64,
}

#[derive(Default)]
struct State {
    /// The number of the next piece: the number of removed pieces.
    taken: u64,
    waiting: BTreeMap<u64, Piece>,
    is_closed: bool,
}

/// Closes the buffer when it goes out of scope, so that no thread waits for one that has ended.
pub(super) struct Closing<'buffer>(&'buffer ReorderBuffer);

/// The slot of a piece. If it is dropped empty although the piece is needed, the buffer is closed.
pub(super) struct Slot<'buffer> {
    buffer: &'buffer ReorderBuffer,
    number: u64,
}

impl ReorderBuffer {
    /// An empty buffer for `capacity` pieces, at least 1.
    pub(super) fn new(capacity: u64) -> Self {
        Self {
            state: Mutex::default(),
            arrived: Condvar::new(),
            moved: Condvar::new(),
            capacity: capacity.max(1),
        }
    }

    /// Returns whether so many pieces may wait here at a time.
    pub(super) fn holds(&self, pieces: u64) -> bool {
        pieces <= self.capacity
    }

    /// Waits until the piece with this number may be made, and returns its slot. Returns `None` if the buffer is
    /// closed, or the piece is not needed.
    pub(super) fn admit(&self, number: u64) -> Option<Slot<'_>> {
        let mut state = self.lock();
        while number >= state.taken + self.capacity && !state.is_closed {
            state = wait(&self.moved, state);
        }
        let buffer = self;
        (!state.is_closed && number >= state.taken).then(|| Slot { buffer, number })
    }

    /// Waits for the next piece and removes it; returns `None` if it will not come.
    pub(super) fn take(&self) -> Option<Piece> {
        let mut state = self.lock();
        loop {
            let number = state.taken;
            if let Some(piece) = state.waiting.remove(&number) {
                state.taken += 1;
                self.moved.notify_all();
                return Some(piece);
            }
            if state.is_closed {
                return None;
            }
            state = wait(&self.arrived, state);
        }
    }

    /// Skips the pieces with smaller numbers, including those that have not arrived.
    pub(super) fn skip_to(&self, number: u64) {
        let mut state = self.lock();
        state.waiting = state.waiting.split_off(&number);
        state.taken = state.taken.max(number);
        self.moved.notify_all();
    }

    /// Ends all waiting, now and later. Pieces in the buffer can still be removed.
    fn close(&self) {
        self.lock().is_closed = true;
        self.arrived.notify_all();
        self.moved.notify_all();
    }

    /// Returns whether no more pieces will come.
    pub(super) fn is_closed(&self) -> bool {
        self.lock().is_closed
    }

    /// Closes the buffer later.
    pub(super) fn closing(&self) -> Closing<'_> {
        Closing(self)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // The state is valid after every step, so that a panic elsewhere does not spoil it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.close();
    }
}

impl Slot<'_> {
    /// Adds the piece, if it is needed.
    pub(super) fn put(self, piece: Piece) {
        let mut state = self.buffer.lock();
        if self.number >= state.taken {
            state.waiting.insert(self.number, piece);
            if self.number == state.taken {
                self.buffer.arrived.notify_one();
            }
        }
        drop(state);
        std::mem::forget(self);
    }
}

impl Drop for Slot<'_> {
    fn drop(&mut self) {
        let is_wanted = self.number >= self.buffer.lock().taken;
        if is_wanted {
            self.buffer.close();
        }
    }
}

fn wait<'state>(change: &Condvar, state: MutexGuard<'state, State>) -> MutexGuard<'state, State> {
    change.wait(state).unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
