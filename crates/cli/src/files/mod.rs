//! Files that are written whole or not at all: under a temporary name beside their place, and moved
//! there when they are complete.

pub(crate) mod destination;
pub(crate) mod save;
pub(crate) mod temporary;
