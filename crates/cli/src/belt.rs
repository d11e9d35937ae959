//! The way from the threads that render to the one that writes: pieces of pictures, in order.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use crate::output::Piece;

/// Pieces are put on it as they are made and taken off in the order of their numbers, which go on
/// from picture to picture.
pub(crate) struct Belt {
    state: Mutex<State>,
    /// The next piece is there, or the belt is closed.
    arrived: Condvar,
    /// A piece was taken, or the belt is closed.
    moved: Condvar,
    /// How many pieces there may be at a time.
    most: u64,
}

#[derive(Default)]
struct State {
    /// How many pieces were taken: the number of the next.
    taken: u64,
    waiting: BTreeMap<u64, Piece>,
    /// Memory of pieces that were taken.
    spent: Vec<Vec<u8>>,
    is_closed: bool,
}

/// Closes the belt when it goes out of scope, so that nobody waits for a thread that has ended.
pub(crate) struct Closing<'belt>(&'belt Belt);

impl Belt {
    /// An empty belt for `most` pieces at a time, at least 1.
    pub(crate) fn new(most: u64) -> Self {
        Self {
            state: Mutex::default(),
            arrived: Condvar::new(),
            moved: Condvar::new(),
            most: most.max(1),
        }
    }

    /// Waits until the piece with this number may be made, and gives memory of others where there is
    /// some; `None` when the belt is closed.
    pub(crate) fn admit(&self, number: u64) -> Option<Vec<u8>> {
        let mut state = self.lock();
        while number >= state.taken + self.most && !state.is_closed {
            state = wait(&self.moved, state);
        }
        if state.is_closed {
            return None;
        }
        Some(state.spent.pop().unwrap_or_default())
    }

    /// Puts the piece with this number on the belt.
    pub(crate) fn put(&self, number: u64, piece: Piece) {
        let mut state = self.lock();
        state.waiting.insert(number, piece);
        if number == state.taken {
            self.arrived.notify_one();
        }
    }

    /// Waits for the next piece and takes it; `None` when it will not come.
    pub(crate) fn take(&self) -> Option<Piece> {
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

    /// Takes the pieces with smaller numbers as they come, for nobody; ends early when they will not
    /// come.
    pub(crate) fn discard_until(&self, number: u64) {
        let mut state = self.lock();
        while state.taken < number {
            let next = state.taken;
            match state.waiting.remove(&next) {
                Some(piece) => {
                    state.taken += 1;
                    if let Piece::Samples(samples) = piece {
                        state.spent.push(samples);
                    }
                    self.moved.notify_all();
                }
                None if state.is_closed => return,
                None => state = wait(&self.arrived, state),
            }
        }
    }

    /// Opens the belt again for the piece with this number and those that follow, where the ones
    /// before were given up.
    pub(crate) fn resume(&self, number: u64) {
        let mut state = self.lock();
        state.waiting.clear();
        state.taken = number;
        state.is_closed = false;
    }

    /// Takes memory that is to be used again.
    pub(crate) fn give_back(&self, spent: Vec<u8>) {
        self.lock().spent.push(spent);
    }

    /// Ends the waiting of all, now and later; what is on the belt can still be taken.
    pub(crate) fn close(&self) {
        self.lock().is_closed = true;
        self.arrived.notify_all();
        self.moved.notify_all();
    }

    /// Closes the belt later.
    pub(crate) fn closing(&self) -> Closing<'_> {
        Closing(self)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // The state is valid after every step, so that a panic elsewhere does not spoil it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Closing<'_> {
    /// Leaves the belt as it is.
    pub(crate) fn keep_open(self) {
        std::mem::forget(self);
    }
}

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.close();
    }
}

fn wait<'state>(change: &Condvar, state: MutexGuard<'state, State>) -> MutexGuard<'state, State> {
    change.wait(state).unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    fn piece(number: u64) -> Piece {
        Piece::Samples(vec![number as u8])
    }

    fn bytes(piece: Option<Piece>) -> Option<Vec<u8>> {
        match piece? {
            Piece::Samples(bytes) => Some(bytes),
            Piece::Block(_) => None,
        }
    }

    #[test]
    fn pieces_come_in_order_and_never_too_many() {
        const MOST: u64 = 3;
        let belt = Belt::new(MOST);
        // Whoever fails closes the belt, so that the test ends.
        thread::scope(|scope| {
            for remainder in 0..MOST {
                let belt = &belt;
                // Each of them is late for another reason, and none may wait for ever.
                scope.spawn(move || {
                    let closing = belt.closing();
                    for number in (remainder..300).step_by(MOST as usize) {
                        assert!(belt.admit(number).is_some());
                        assert!(belt.lock().waiting.len() < MOST as usize);
                        belt.put(number, piece(number));
                    }
                    closing.keep_open();
                });
            }
            let closing = belt.closing();
            for number in 0..300_u64 {
                let taken = bytes(belt.take()).unwrap();
                assert_eq!(taken, [number as u8]);
                belt.give_back(taken);
            }
            closing.keep_open();
        });
        assert!(belt.admit(300).is_some_and(|spent| !spent.is_empty()));
    }

    #[test]
    fn pieces_that_nobody_wants_make_room() {
        let belt = Belt::new(2);
        thread::scope(|scope| {
            let closing = belt.closing();
            let discarding = scope.spawn(|| belt.discard_until(5));
            for number in 0..5 {
                assert!(belt.admit(number).is_some());
                belt.put(number, piece(number));
            }
            discarding.join().unwrap();
            closing.keep_open();
        });
        belt.put(6, piece(6));
        belt.close();
        belt.discard_until(7);
        belt.resume(9);
        assert!(belt.admit(10).is_some());
        belt.put(9, piece(9));
        assert_eq!(bytes(belt.take()), Some(vec![9]));
    }

    #[test]
    fn a_closed_belt_gives_what_it_has_and_admits_nothing() {
        let belt = Belt::new(2);
        for number in [0, 2] {
            belt.put(number, piece(number));
        }
        thread::scope(|scope| {
            let waiting = scope.spawn(|| belt.admit(7).is_none());
            drop(belt.closing());
            assert!(waiting.join().unwrap());
        });
        assert_eq!(bytes(belt.take()), Some(vec![0]));
        assert_eq!(bytes(belt.take()), None);
        assert!(belt.admit(1).is_none());
    }
}
