//! Pixels with edges.

pub(crate) mod boundary;
pub(crate) mod boxes;
pub(crate) mod cell;
pub(crate) mod rule;
