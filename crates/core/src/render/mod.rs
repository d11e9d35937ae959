//! The loop over the tiles of a picture.

mod approach;
mod areas;
mod averages;
mod centers;
mod integrator;
pub(crate) mod renderer;
pub(crate) mod settings;
pub(crate) mod sink;
pub(crate) mod strips;
