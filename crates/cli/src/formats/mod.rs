//! Picture formats: PNG, single and animated, EXR and NPY, each with writing and reading.

pub(crate) mod center_channels;
pub(crate) mod encoder;
pub(crate) mod encoding;
pub(crate) mod exr;
pub(crate) mod facts;
pub(crate) mod form;
pub(crate) mod frame_rate;
mod half;
pub(crate) mod load;
pub(crate) mod mat;
pub(crate) mod npy;
pub(crate) mod picture;
pub(crate) mod png;
pub(crate) mod rows;
pub(crate) mod sidecar;
mod source;
#[cfg(test)]
pub(crate) mod tests;
