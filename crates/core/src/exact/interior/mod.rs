//! Pixels that one sphere fills.

pub(crate) mod facings;
pub(crate) mod fill;
pub(crate) mod parts;
pub(crate) mod samples;
pub(crate) mod smooth;
