//! The average of a pixel over the time that the shutter is open, too.

mod band;
mod contrast;
pub(crate) mod exact;
pub(crate) mod instants;
mod panel;
mod panel_levels;
mod pixel_sum;
pub(crate) mod sampled;
mod travel;

#[cfg(test)]
mod tests;
