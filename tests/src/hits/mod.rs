//! Hits and misses held against exact answers.
//!
//! [`judge`] knows the truth about any ray and sphere, [`families`] draws hard ones; [`claims`]
//! holds the promises of `Sphere::hit` against both, and `examples/hits.rs` compares it with
//! [`forms`] of others.

mod claims;
mod families;
mod forms;
mod frames;
mod judge;
mod tally;
mod truth;
