//! The light that a surface sends to the eye.

pub(crate) mod reflection;
#[cfg(test)]
pub(crate) mod shading;
pub(crate) mod shading_normal;
