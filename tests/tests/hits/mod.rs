//! Hits and misses, compared with exact answers.
//!
//! [`claims`] compares the promises of `Sphere::hit` with the judge of the library, [`truth`] with exact answers from
//! elsewhere. `examples/hits.rs` compares other methods.

mod claims;
mod truth;
