//! Files that are written completely or not at all: under a temporary name in the same folder, and renamed when they
//! are complete. What goes to the standard output is complete before its first byte is written.

pub(crate) mod destination;
pub(crate) mod save;
pub(crate) mod standard_output;
pub(crate) mod temporary;
