//! Pixels with edges.

pub(crate) mod across;
pub(crate) mod boundary;
pub(crate) mod breaks;
pub(crate) mod cell;
pub(crate) mod cut;
pub(crate) mod interval;
pub(crate) mod piece;
pub(crate) mod pixel;
pub(crate) mod rule;
pub(crate) mod turns;
