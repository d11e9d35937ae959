//! Keys that end a program without other input.

use std::sync::atomic::{AtomicBool, Ordering};

/// Whether one of the keys was pressed.
static PRESSED: AtomicBool = AtomicBool::new(false);

/// Switches the keyboard to single keys without echo, as long as it lives, and restores it afterwards.
pub(crate) struct Keyboard;

impl Keyboard {
    /// From now on `q` and Esc `end` the work. If stdin is not a terminal, there are no keys.
    pub(crate) fn listen(end: fn()) -> Self {
        system::listen(move |keys| {
            // Other keys send several bytes, of which the first may be that of Esc.
            if matches!(keys, b"q" | b"Q" | b"\x1b") {
                PRESSED.store(true, Ordering::Relaxed);
                end();
            }
        });
        Self
    }

    /// Returns whether one of the keys ended the work.
    pub(crate) fn was_pressed() -> bool {
        PRESSED.load(Ordering::Relaxed)
    }
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

#[cfg(unix)]
mod system {
    use std::io::{self, Read};
    use std::sync::{Mutex, PoisonError};
    use std::thread;

    use rustix::termios::{LocalModes, OptionalActions, Termios, tcgetattr, tcsetattr};

    /// The settings of the terminal to restore.
    static BEFORE: Mutex<Option<Termios>> = Mutex::new(None);

    pub(super) fn listen(press: impl Fn(&[u8]) + Send + 'static) {
        let stdin = io::stdin();
        let Ok(before) = tcgetattr(&stdin) else {
            return;
        };
        let mut modes = before.clone();
        modes
            .local_modes
            .remove(LocalModes::ICANON | LocalModes::ECHO);
        *BEFORE.lock().unwrap_or_else(PoisonError::into_inner) = Some(before);
        if tcsetattr(&stdin, OptionalActions::Now, &modes).is_err() {
            return;
        }
        let listening = thread::Builder::new().spawn(move || {
            let mut keys = [0; 64];
            while let Ok(count @ 1..) = io::stdin().read(&mut keys) {
                press(&keys[..count]);
            }
        });
        if listening.is_err() {
            restore();
        }
    }

    pub(super) fn restore() {
        let mut before = BEFORE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(before) = before.take() {
            // A terminal that is gone needs nothing.
            let _ = tcsetattr(io::stdin(), OptionalActions::Now, &before);
        }
    }
}

/// On other systems, only Ctrl-C ends programs.
#[cfg(not(unix))]
mod system {
    pub(super) fn listen(_press: impl Fn(&[u8]) + Send + 'static) {}

    pub(super) fn restore() {}
}
