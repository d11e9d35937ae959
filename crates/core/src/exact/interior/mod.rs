//! Pixels that one sphere fills: by rules with few samples, where light is smooth.

mod average;
pub(crate) mod cell;
mod domain;
mod estimate;
pub(crate) mod fill;
pub(crate) mod filled;
mod half_turns;
mod kinks;
mod light_cosines;
pub(crate) mod mean_normals;
mod middle;
pub(crate) mod parts;
mod plain;
mod powers;
mod ramps;
pub(crate) mod reached;
mod remainder;
pub(crate) mod samples;
mod strata;
mod terminators;
