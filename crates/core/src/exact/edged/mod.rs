//! Pixels with edges.

pub(crate) mod boundary;
mod boxes;
pub(crate) mod cell;
pub(crate) mod rule;
