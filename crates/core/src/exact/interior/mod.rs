//! Pixels that one sphere fills: by rules with few samples, where light is smooth.

mod average;
mod domain;
mod estimate;
pub(crate) mod fill;
pub(crate) mod filled;
mod light_cosines;
mod parts;
mod reached;
mod remainder;
pub(crate) mod samples;
mod terminators;
