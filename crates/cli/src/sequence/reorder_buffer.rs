//! The way from the threads that render to the one that writes: pieces of pictures, in order.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use crate::formats::Piece;

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

/// Where a piece will be put; closes the belt when that does not happen though somebody wants it.
pub(crate) struct Place<'belt> {
    belt: &'belt Belt,
    number: u64,
}

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

    /// Waits until the piece with this number may be made; its place, and memory of others where there
    /// is some. `None` when the belt is closed, or nobody wants the piece.
    pub(crate) fn admit(&self, number: u64) -> Option<(Place<'_>, Vec<u8>)> {
        let mut state = self.lock();
        while number >= state.taken + self.most && !state.is_closed {
            state = wait(&self.moved, state);
        }
        if state.is_closed || number < state.taken {
            return None;
        }
        let place = Place { belt: self, number };
        Some((place, state.spent.pop().unwrap_or_default()))
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

    /// Leaves out the pieces with smaller numbers, those that are still to come among them.
    pub(crate) fn skip_to(&self, number: u64) {
        let mut state = self.lock();
        let wanted = state.waiting.split_off(&number);
        for piece in std::mem::replace(&mut state.waiting, wanted).into_values() {
            if let Piece::Samples(samples) = piece {
                state.spent.push(samples);
            }
        }
        state.taken = state.taken.max(number);
        self.moved.notify_all();
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

    /// Whether nothing more will come.
    pub(crate) fn is_closed(&self) -> bool {
        self.lock().is_closed
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

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.close();
    }
}

impl Place<'_> {
    /// Puts the piece there.
    pub(crate) fn put(self, piece: Piece) {
        let mut state = self.belt.lock();
        if self.number >= state.taken {
            state.waiting.insert(self.number, piece);
            if self.number == state.taken {
                self.belt.arrived.notify_one();
            }
        } else if let Piece::Samples(samples) = piece {
            state.spent.push(samples);
        }
        drop(state);
        std::mem::forget(self);
    }
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        let is_wanted = self.number >= self.belt.lock().taken;
        if is_wanted {
            self.belt.close();
        }
    }
}

fn wait<'state>(change: &Condvar, state: MutexGuard<'state, State>) -> MutexGuard<'state, State> {
    change.wait(state).unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::thread;
    use std::time::Duration;

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

    fn put(belt: &Belt, number: u64) {
        belt.admit(number).unwrap().0.put(piece(number));
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
                    for number in (remainder..300).step_by(MOST as usize) {
                        let (place, _) = belt.admit(number).unwrap();
                        assert!(belt.lock().waiting.len() < MOST as usize);
                        place.put(piece(number));
                    }
                });
            }
            let closing = belt.closing();
            for number in 0..300_u64 {
                let taken = bytes(belt.take()).unwrap();
                assert_eq!(taken, [number as u8]);
                belt.give_back(taken);
            }
            std::mem::forget(closing);
        });
        assert!(belt.admit(300).is_some_and(|(_, spent)| !spent.is_empty()));
    }

    #[test]
    fn pieces_that_nobody_wants_make_room() {
        /// Far longer than it should take.
        const PATIENCE: Duration = Duration::from_secs(60);
        let belt = Belt::new(3);
        put(&belt, 0);
        let (late, _) = belt.admit(1).unwrap();
        let (never, _) = belt.admit(2).unwrap();
        thread::scope(|scope| {
            let (sender, admitted) = channel();
            let belt = &belt;
            scope.spawn(move || {
                sender.send(Vec::new()).unwrap();
                if let Some((place, spent)) = belt.admit(7) {
                    place.put(piece(7));
                    sender.send(spent).unwrap();
                }
            });
            // It has begun, and waits soon.
            admitted.recv().unwrap();
            thread::sleep(Duration::from_millis(50));
            belt.skip_to(5);
            let admitted = admitted.recv_timeout(PATIENCE);
            if admitted.is_err() {
                // So that the test ends.
                belt.close();
            }
            assert_eq!(admitted.unwrap(), [0]);
        });
        // What is unwanted does no harm, whether it comes or not.
        late.put(piece(1));
        assert_eq!(belt.lock().spent, [[1]]);
        drop(never);
        assert!(belt.admit(4).is_none());
        put(&belt, 5);
        put(&belt, 6);
        belt.skip_to(2);
        assert_eq!(belt.lock().taken, 5);
        for number in 5..=7 {
            assert_eq!(bytes(belt.take()), Some(vec![number]));
        }
        assert!(!belt.is_closed());
    }

    #[test]
    fn a_closed_belt_gives_what_it_has_and_admits_nothing() {
        let belt = Belt::new(2);
        put(&belt, 0);
        let (second, _) = belt.admit(1).unwrap();
        thread::scope(|scope| {
            let waiting = scope.spawn(|| belt.admit(7).is_none());
            let closing = belt.closing();
            drop(second);
            assert!(belt.is_closed());
            std::mem::forget(closing);
            assert!(waiting.join().unwrap());
        });
        assert_eq!(bytes(belt.take()), Some(vec![0]));
        assert_eq!(bytes(belt.take()), None);
        assert!(belt.admit(1).is_none());
    }
}
