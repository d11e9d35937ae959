//! Ends a process that has run out of memory.
//!
//! Large amounts of memory are checked before they are needed. If a small allocation fails, in a library or in the
//! standard library, the process aborts. Without the code here, it would leave its temporary files behind, and its exit
//! code would mean a signal.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use super::{alternate_screen, keyboard, signals};
use crate::base::status;
use crate::files::temporary;

/// The last line of a process that aborts. Before it, the standard library prints the size of the failed allocation.
const FAREWELL: &[u8] = b"marbles: out of memory; fewer threads need less\n";

/// The time after which a second aborting thread no longer waits for the first one to end the process.
const LONGEST: Duration = Duration::from_secs(1);

/// From now on, an abort ends the process like an ordinary failure.
pub(crate) fn end_as_failure() {
    static IS_ENDING: AtomicBool = AtomicBool::new(false);
    signals::on_abort(|| {
        // Nothing here asks for memory but names of files that are very long.
        if IS_ENDING.swap(true, Ordering::Relaxed) {
            // Another thread ends the process.
            thread::sleep(LONGEST);
        } else {
            temporary::abandon_now();
            alternate_screen::restore();
            keyboard::restore();
            signals::say(FAREWELL);
        }
        i32::from(status::FAILURE)
    });
}
