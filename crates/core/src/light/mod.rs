//! The light that a surface sends to the eye.

pub(crate) mod reflection;
pub(crate) mod shading_normal;
