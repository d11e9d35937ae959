//! Pixels with edges.

pub(crate) mod boundary;
pub(crate) mod boxes;
pub(crate) mod cell;
mod mean_normals;
pub(crate) mod normals;
pub(crate) mod rule;
