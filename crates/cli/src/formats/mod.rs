//! Picture formats: PNG, GIF, WebP, EXR, NPY and TIFF, each with writing and reading, and others that are only read.

mod animation;
pub(crate) mod center_channels;
pub(crate) mod encoder;
pub(crate) mod encoding;
pub(crate) mod exr;
pub(crate) mod facts;
pub(crate) mod form;
pub(crate) mod frame_rate;
pub(crate) mod gif;
mod guard;
mod half;
mod jpeg;
pub(crate) mod load;
pub(crate) mod loops;
pub(crate) mod mat;
pub(crate) mod npy;
mod numbers;
mod others;
pub(crate) mod picture;
pub(crate) mod png;
mod profile;
pub(crate) mod rows;
pub(crate) mod sidecar;
mod source;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod tiff;
mod webp;
