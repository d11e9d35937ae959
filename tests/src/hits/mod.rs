//! Hits and misses held against exact answers.

mod claims;
mod families;
mod judge;
mod tally;
mod truth;
