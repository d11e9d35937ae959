//! Renders frames one after the other. While a frame is rendered, the previous one is encoded and written, and the next
//! one begins as soon as threads have nothing else to do.

mod clock;
pub(crate) mod collector;
pub(crate) mod digest;
pub(crate) mod frames;
pub(crate) mod layers;
pub(crate) mod messages;
pub(crate) mod outcome;
pub(crate) mod parts;
pub(crate) mod pattern;
mod pipeline;
pub(crate) mod render;
mod reorder_buffer;
pub(crate) mod request;
mod results;
mod source;
mod steps;
mod strip_encoder;
mod workers;
mod writer;
