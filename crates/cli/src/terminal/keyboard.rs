//! Keys of programs that stay on the screen.

use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering};

use super::keys::{Key, Keys, decode, is_open};

/// Whether a key ended the work.
static PRESSED: AtomicBool = AtomicBool::new(false);
/// The keys of [`Keyboard::read`].
static KEYS: Keys = Keys::new();

/// Switches the keyboard to single keys without echo, as long as it lives, and restores it afterwards.
pub(crate) struct Keyboard;

impl Keyboard {
    /// From now on `q` and Esc `end` the work. If stdin is not a terminal, there are no keys.
    pub(crate) fn listen(end: fn()) -> Self {
        system::listen(is_open, move |bytes| {
            if decode(bytes).into_iter().any(is_end) {
                PRESSED.store(true, Ordering::Relaxed);
                end();
            }
        });
        Self
    }

    /// Returns whether keys can be read one by one.
    pub(crate) fn is_there() -> bool {
        cfg!(unix) && io::stdin().is_terminal()
    }

    /// From now on keys can be taken from the returned ones.
    pub(crate) fn read() -> (Self, &'static Keys) {
        system::listen(is_open, |bytes| KEYS.press(decode(bytes)));
        (Self, &KEYS)
    }

    /// Returns whether one of the keys ended the work.
    pub(crate) fn was_pressed() -> bool {
        PRESSED.load(Ordering::Relaxed)
    }

    /// The answer of the terminal to a question, which ends with the byte `last`; nothing if it does not answer at once.
    /// Nobody may listen yet.
    pub(crate) fn ask(question: &str, last: u8) -> Vec<u8> {
        system::ask(question, last)
    }
}

/// Returns whether a key ends programs that stay on the screen.
pub(crate) fn is_end(key: Key) -> bool {
    /// Ctrl-D, with which input ends.
    const END: u8 = 4;
    matches!(key, Key::Escape | Key::Letter(b'q' | b'Q' | END))
}

impl Drop for Keyboard {
    fn drop(&mut self) {
        restore();
    }
}

/// Restores the keyboard, also if a signal ends the process.
pub(super) fn restore() {
    system::restore();
}

/// Restores the keyboard until [`resume`].
pub(super) fn pause() {
    system::pause();
}

/// Switches the keyboard again to single keys, if it was before.
pub(super) fn resume() {
    system::resume();
}

#[cfg(unix)]
mod system {
    use std::io::{self, Write};
    use std::sync::{Mutex, PoisonError};
    use std::thread;
    use std::time::{Duration, Instant};

    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::process::getpgrp;
    use rustix::termios::{LocalModes, OptionalActions, Termios, tcgetattr, tcgetpgrp, tcsetattr};

    /// The settings of the terminal to restore.
    static BEFORE: Mutex<Option<Termios>> = Mutex::new(None);

    /// The time in which the rest of a sequence comes, also over a slow line.
    const REST: Duration = Duration::from_millis(50);
    /// The time in which a terminal answers.
    const ANSWER: Duration = Duration::from_millis(300);

    /// Calls `press` with the bytes of whole keys: more are awaited as long as a key `is_open`.
    pub(super) fn listen(is_open: fn(&[u8]) -> bool, press: impl Fn(&[u8]) + Send + 'static) {
        if !begin() {
            return;
        }
        let listening = thread::Builder::new().spawn(move || {
            let mut bytes = Vec::new();
            while read(&mut bytes) {
                while is_open(&bytes) && has_more(REST) && read(&mut bytes) {}
                press(&bytes);
                bytes.clear();
            }
        });
        if listening.is_err() {
            restore();
        }
    }

    pub(super) fn ask(question: &str, last: u8) -> Vec<u8> {
        let mut answer = Vec::new();
        // In the background, a process that changes the settings of a terminal is stopped.
        let is_in_front = tcgetpgrp(io::stdin()).is_ok_and(|group| group == getpgrp());
        if !is_in_front || !begin() {
            return answer;
        }
        let mut out = io::stdout();
        let asked = out
            .write_all(question.as_bytes())
            .and_then(|()| out.flush());
        let started = Instant::now();
        while asked.is_ok() && !answer.contains(&last) {
            let left = ANSWER.saturating_sub(started.elapsed());
            if left.is_zero() || !has_more(left) || !read(&mut answer) {
                break;
            }
        }
        restore();
        answer
    }

    /// Switches to single keys; returns whether there are any.
    fn begin() -> bool {
        let Ok(before) = tcgetattr(io::stdin()) else {
            return false;
        };
        *BEFORE.lock().unwrap_or_else(PoisonError::into_inner) = Some(before);
        resume()
    }

    pub(super) fn resume() -> bool {
        let before = BEFORE.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(mut modes) = before.clone() else {
            return false;
        };
        modes
            .local_modes
            .remove(LocalModes::ICANON | LocalModes::ECHO);
        tcsetattr(io::stdin(), OptionalActions::Now, &modes).is_ok()
    }

    pub(super) fn pause() {
        let before = BEFORE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(before) = &*before {
            // A terminal that is gone needs nothing.
            let _ = tcsetattr(io::stdin(), OptionalActions::Now, before);
        }
    }

    pub(super) fn restore() {
        pause();
        *BEFORE.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Waits for bytes and appends them; returns whether there were any.
    fn read(bytes: &mut Vec<u8>) -> bool {
        let mut some = [0; 256];
        loop {
            match rustix::io::read(io::stdin(), &mut some) {
                Ok(0) => return false,
                Ok(count) => {
                    bytes.extend_from_slice(&some[..count]);
                    return true;
                }
                Err(rustix::io::Errno::INTR) => {}
                Err(_) => return false,
            }
        }
    }

    /// Returns whether bytes come within this time.
    fn has_more(time: Duration) -> bool {
        let stdin = io::stdin();
        let mut files = [PollFd::new(&stdin, PollFlags::IN)];
        let time = Timespec::try_from(time).ok();
        poll(&mut files, time.as_ref()).is_ok_and(|count| count > 0)
    }
}

/// On other systems, only Ctrl-C ends programs.
#[cfg(not(unix))]
mod system {
    pub(super) fn listen(_is_open: fn(&[u8]) -> bool, _press: impl Fn(&[u8]) + Send + 'static) {}

    pub(super) fn ask(_question: &str, _last: u8) -> Vec<u8> {
        Vec::new()
    }

    pub(super) fn pause() {}

    pub(super) fn resume() {}

    pub(super) fn restore() {}
}
