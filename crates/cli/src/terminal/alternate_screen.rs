//! The alternate screen of a terminal, which leaves no trace.

use std::io::{self, Write};
use std::panic;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use super::console::Console;
use super::{keyboard, signals};

/// The sequences that switch to the alternate screen with a hidden cursor, and back.
const ENTER: &str = "\x1b[?1049h\x1b[?25l";
const LEAVE: &str = "\x1b[?25h\x1b[?1049l";

static HAS_ENTERED: AtomicBool = AtomicBool::new(false);
/// Whether the process was stopped since the last question.
static WAS_STOPPED: AtomicBool = AtomicBool::new(false);

/// Shows the alternate screen as long as it lives, and then the previous one.
pub(crate) struct AlternateScreen;

impl AlternateScreen {
    pub(crate) fn enter(console: &Console) -> Self {
        static PREPARED: Once = Once::new();
        PREPARED.call_once(|| {
            signals::on_stop(pause, resume);
            // The message of a panic would vanish with the screen.
            let tell = panic::take_hook();
            panic::set_hook(Box::new(move |info| {
                restore();
                keyboard::restore();
                tell(info);
            }));
        });
        HAS_ENTERED.store(true, Ordering::Relaxed);
        console.print(ENTER);
        Self
    }

    /// Returns whether the process was stopped since the last call: the screen is empty then.
    pub(crate) fn was_stopped(&self) -> bool {
        WAS_STOPPED.swap(false, Ordering::Relaxed)
    }
}

impl Drop for AlternateScreen {
    fn drop(&mut self) {
        restore();
    }
}

/// Restores the terminal, also if a signal ends the process.
pub(super) fn restore() {
    if HAS_ENTERED.swap(false, Ordering::Relaxed) {
        say(LEAVE);
    }
}

/// Restores the terminal until the process continues.
fn pause() {
    if HAS_ENTERED.load(Ordering::Relaxed) {
        say(LEAVE);
        keyboard::pause();
    }
}

/// Enters the screen again after [`pause`].
fn resume() {
    if HAS_ENTERED.load(Ordering::Relaxed) {
        keyboard::resume();
        say(ENTER);
        WAS_STOPPED.store(true, Ordering::Relaxed);
    }
}

fn say(text: &str) {
    let mut out = io::stdout();
    // A terminal that is gone needs nothing.
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}
