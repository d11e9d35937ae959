//! The spheres, edges and lights that pixels and their parts may see.

pub(crate) mod active;
pub(crate) mod behind;
pub(crate) mod coincidence;
pub(crate) mod contents;
mod cut;
pub(super) mod cut_side;
mod cutoff;
pub(crate) mod discriminant;
pub(crate) mod face;
mod hardness;
mod hidden;
pub(crate) mod magnitude;
mod mask;
mod no_shade;
pub(crate) mod occluder_cache;
pub(crate) mod occluders;
mod outlines;
pub(crate) mod patch;
pub(crate) mod reach;
pub(crate) mod row;
pub(crate) mod seen;
mod shade_mask;
mod sharpness;
#[cfg(test)]
mod tests;
mod ways;
