//! Output to the user's terminal, or to another program: results, messages, progress; and signals.

pub(crate) mod abort;
pub(crate) mod alternate_screen;
pub(crate) mod bar;
pub(crate) mod console;
pub(crate) mod interrupt;
pub(crate) mod keyboard;
pub(crate) mod keys;
pub(crate) mod lines;
pub(crate) mod progress;
pub(crate) mod signals;
