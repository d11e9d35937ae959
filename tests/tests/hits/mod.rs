//! Hits and misses held against exact answers.
//!
//! [`claims`] holds the promises of `Sphere::hit` against the judge of the library, [`truth`] against
//! exact answers from elsewhere; `examples/hits.rs` compares other forms.

mod claims;
mod truth;
