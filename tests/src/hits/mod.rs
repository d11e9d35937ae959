//! Hits and misses held against exact answers.

mod truth;
