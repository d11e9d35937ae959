//! The light that a surface sends to the eye.

pub(crate) mod shading;
