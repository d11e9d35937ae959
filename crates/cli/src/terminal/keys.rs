//! Single keys, decoded from the bytes that a terminal sends.
//!
//! Source: "XTerm Control Sequences", invisible-island.net/xterm/ctlseqs, for the sequences.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A key.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Key {
    /// An arrow key.
    Arrow {
        to: Direction,
        /// Whether Shift was held.
        shift: bool,
    },
    Home,
    Escape,
    /// A key with a letter.
    Letter(u8),
}

/// The direction of an arrow key.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Direction {
    Left,
    Right,
    Up,
    Down,
}

const ESCAPE: u8 = 0x1b;

/// The keys in some bytes, which end where no sequence is open. Keys that are not known are left out.
pub(super) fn decode(bytes: &[u8]) -> Vec<Key> {
    let mut keys = Vec::new();
    let mut rest = bytes;
    while let Some((&first, after)) = rest.split_first() {
        let (key, length) = match (first, after.first()) {
            (ESCAPE, Some(b'[')) => sequence(rest),
            // Keypads in application mode, and the first function keys.
            (ESCAPE, Some(b'O')) => (after.get(1).and_then(|&last| named(b"", last)), 3),
            (ESCAPE, None) => (Some(Key::Escape), 1),
            // Alt and another key: not Esc, which would end the program.
            (ESCAPE, Some(_)) => (None, 2),
            (letter, _) => (Some(Key::Letter(letter)), 1),
        };
        keys.extend(key);
        rest = rest.get(length..).unwrap_or_default();
    }
    keys
}

/// Returns whether bytes end in the midst of a sequence, so that more may follow.
pub(super) fn is_open(bytes: &[u8]) -> bool {
    let Some(start) = bytes.iter().rposition(|&byte| byte == ESCAPE) else {
        return false;
    };
    match &bytes[start..] {
        [_] | [_, b'O'] => true,
        [_, b'[', inside @ ..] => !inside.iter().any(is_final),
        _ => false,
    }
}

/// The key of a sequence that begins with Esc and `[`, and the number of its bytes.
fn sequence(bytes: &[u8]) -> (Option<Key>, usize) {
    let inside = &bytes[2..];
    match inside.iter().position(is_final) {
        Some(end) => (named(&inside[..end], inside[end]), end + 3),
        None => (None, bytes.len()),
    }
}

/// Returns whether a byte ends a sequence.
fn is_final(byte: &u8) -> bool {
    (b'@'..=b'~').contains(byte)
}

/// The key of a sequence with these parameters and this last byte.
fn named(parameters: &[u8], last: u8) -> Option<Key> {
    let mut numbers = parameters.split(|&byte| byte == b';');
    let first = numbers.next().unwrap_or_default();
    // One more than the sum of 1 for Shift, 2 for Alt, 4 for Ctrl.
    let shift = numbers.next() == Some(b"2");
    let to = match last {
        b'A' => Direction::Up,
        b'B' => Direction::Down,
        b'C' => Direction::Right,
        b'D' => Direction::Left,
        b'H' => return Some(Key::Home),
        b'~' if matches!(first, b"1" | b"7") => return Some(Key::Home),
        _ => return None,
    };
    Some(Key::Arrow { to, shift })
}

/// The keys that were pressed and not taken yet.
#[derive(Debug)]
pub(crate) struct Keys {
    waiting: Mutex<VecDeque<Key>>,
    pressed: Condvar,
}

impl Keys {
    pub(super) const fn new() -> Self {
        Self {
            waiting: Mutex::new(VecDeque::new()),
            pressed: Condvar::new(),
        }
    }

    pub(super) fn press(&self, keys: Vec<Key>) {
        self.lock().extend(keys);
        self.pressed.notify_all();
    }

    /// Returns whether a key waits to be taken.
    pub(crate) fn is_waiting(&self) -> bool {
        !self.lock().is_empty()
    }

    /// All keys that wait.
    pub(crate) fn take(&self) -> Vec<Key> {
        self.lock().drain(..).collect()
    }

    /// Waits for a key, but not longer than this.
    pub(crate) fn wait(&self, longest: Duration) {
        let waiting = self.lock();
        // Whether there is one, the caller sees.
        let _ = self
            .pressed
            .wait_timeout_while(waiting, longest, |waiting| waiting.is_empty());
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<Key>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests;
