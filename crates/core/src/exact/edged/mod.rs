//! Pixels with edges.

pub(crate) mod boundary;
pub(crate) mod boxes;
pub(crate) mod cell;
mod mean_normals;
pub(crate) mod normals;
mod parts;
pub(crate) mod rule;
