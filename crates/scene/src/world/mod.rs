//! The world of a scene file: materials, lights, spheres, and those of tables.

mod assemble;
mod cloud;
mod lens;
mod materials;
mod placement;

pub(crate) use assemble::world;
pub use cloud::Progress;
pub(crate) use cloud::{Cloud, CloudError};
pub(crate) use lens::{lens, lens_as_written};
