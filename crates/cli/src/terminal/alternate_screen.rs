//! The alternate screen of a terminal, which goes without a trace.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use super::console::Console;

/// To the alternate screen, with the cursor hidden, and back.
const ENTER: &str = "\x1b[?1049h\x1b[?25l";
const LEAVE: &str = "\x1b[?25h\x1b[?1049l";

static HAS_ENTERED: AtomicBool = AtomicBool::new(false);

/// The alternate screen as long as this lives, and then the one that was before.
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

/// Leaves the terminal as it was, also where a signal ends the process.
pub(super) fn restore() {
    if HAS_ENTERED.swap(false, Ordering::Relaxed) {
        let mut out = io::stdout();
        // A terminal that is gone needs nothing.
        let _ = out.write_all(LEAVE.as_bytes()).and_then(|()| out.flush());
    }
}
