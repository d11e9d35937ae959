//! Truths to hold marbles against, computed independently of it: what tests, examples and benchmarks share.

pub mod covering;
pub mod features;
pub mod hits;
pub mod mutations;
pub mod numbers;
pub mod promise;
pub mod reference;
