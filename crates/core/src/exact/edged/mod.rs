//! Pixels with edges.

pub(crate) mod boundary;
pub(crate) mod cell;
pub(crate) mod rule;
