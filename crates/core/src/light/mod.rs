//! The light that a surface sends to the eye.

pub(crate) mod lobe;
pub(crate) mod near_light;
pub(crate) mod reflection;
pub(crate) mod shading_normal;
