//! Pictures in memory, for other programs: a scene is rendered frame by frame to arrays, which may be saved as files
//! afterwards. The pixels are those of `marbles render`, to the bit.

mod error;
mod options;
mod picture;
mod pool;
mod rendering;
mod save;

pub use error::Error;
pub use options::Options;
pub use picture::{Picture, PictureArray, sidecar_of};
pub use rendering::{Next, Rendering};
pub use save::SaveOptions;

pub use crate::formats::npy::given::GivenNumbers;
pub use crate::formats::npy::memory::Numbers;

#[cfg(test)]
mod tests;
