//! Independent references for marbles, shared by tests, examples and benchmarks.

pub mod covering;
pub mod features;
pub mod hits;
pub mod mutations;
pub mod numbers;
pub mod promise;
pub mod reference;
