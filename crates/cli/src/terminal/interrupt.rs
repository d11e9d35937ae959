//! Ctrl-C, and the signals that ask a process to end.
//!
//! The first one is a request: rendering stops at the next tile, and finished pictures are still written. If that takes
//! too long, or at the second one, the process ends at once and removes its temporary files.

use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use super::console::Console;
use super::{alternate_screen, keyboard, signals};
use crate::base::status::INTERRUPTED;
use crate::files::temporary;

/// The time for writing finished pictures: one second is promised.
const GRACE: Duration = Duration::from_millis(700);
/// The time for the last message, on a terminal that does not respond.
const FAREWELL: Duration = Duration::from_millis(50);

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Returns whether the user asked to end the work.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}

/// Asks to end the work, like the first Ctrl-C, but without a time limit.
pub(crate) fn request() {
    REQUESTED.store(true, Ordering::Relaxed);
}

/// Handles signals from now on, as long as the process lives.
pub(crate) fn listen(console: &Console) {
    static LISTENING: OnceLock<()> = OnceLock::new();
    let farewell = console.farewell();
    LISTENING.get_or_init(|| {
        signals::on_each(move || {
            if REQUESTED.swap(true, Ordering::Relaxed) {
                end(farewell);
            }
            let deadline = thread::Builder::new().spawn(move || {
                thread::sleep(GRACE);
                end(farewell);
            });
            if deadline.is_err() {
                end(farewell);
            }
        });
    });
}

fn end(farewell: &'static str) -> ! {
    let _no_more_files = temporary::abandon_all();
    // Another thread may hold the lock of stdout or stderr for as long as nobody reads from it.
    let said = thread::Builder::new().spawn(move || {
        alternate_screen::restore();
        keyboard::restore();
        let _ = writeln!(std::io::stderr(), "{farewell}");
    });
    if said.is_ok() {
        thread::sleep(FAREWELL);
    }
    std::process::exit(i32::from(INTERRUPTED));
}
