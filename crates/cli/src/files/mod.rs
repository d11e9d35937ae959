//! Files that are written completely or not at all: under a temporary name in the same folder, and renamed when they
//! are complete.

pub(crate) mod destination;
pub(crate) mod save;
pub(crate) mod temporary;
