//! The end of a process that has no memory left.
//!
//! Large pieces of memory are asked for before they are needed. Where a small one cannot be had, in a library or in the
//! standard library, the process aborts: it would leave its temporary files behind, and an exit code that means a
//! signal.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use super::{alternate_screen, keyboard, signals};
use crate::base::status;
use crate::files::temporary;

/// The last line of a process that aborts. The standard library says before how much it asked for.
const FAREWELL: &[u8] = b"marbles: out of memory; fewer threads need less\n";

/// The time after which a second thread that aborts does not wait for the first one to end the process.
const LONGEST: Duration = Duration::from_secs(1);

/// Lets an abort end the process as a failure does, from now on.
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
