//! Keys that end a program which has nothing else to ask.

use std::sync::atomic::{AtomicBool, Ordering};

/// True as soon as one of the keys was pressed.
static PRESSED: AtomicBool = AtomicBool::new(false);

/// A keyboard whose keys count one by one and are not shown, as long as this lives; then it is as it was
/// before.
pub(crate) struct Keyboard;

impl Keyboard {
    /// From now on `q` and Esc `end` the work. Where stdin is no terminal, there are no keys.
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

/// Leaves the keyboard as it was, also where a signal ends the process.
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

/// Elsewhere Ctrl-C alone ends programs.
#[cfg(not(unix))]
mod system {
    pub(super) fn listen(_press: impl Fn(&[u8]) + Send + 'static) {}

    pub(super) fn restore() {}
}
