//! The alternate screen of a terminal, which leaves no trace.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use super::console::Console;

/// The sequences that switch to the alternate screen with a hidden cursor, and back.
const ENTER: &str = "\x1b[?1049h\x1b[?25l";
const LEAVE: &str = "\x1b[?25h\x1b[?1049l";

static HAS_ENTERED: AtomicBool = AtomicBool::new(false);

/// Shows the alternate screen as long as it lives, and then the previous one.
pub(crate) struct AlternateScreen;

impl AlternateScreen {
    pub(crate) fn enter(console: &Console) -> Self {
        HAS_ENTERED.store(true, Ordering::Relaxed);
        console.print(ENTER);
        Self
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
        let mut out = io::stdout();
        // A terminal that is gone needs nothing.
        let _ = out.write_all(LEAVE.as_bytes()).and_then(|()| out.flush());
    }
}
