//! Lines with exact spans: the integral over a pixel as an integral over integrals along lines.

mod across;
mod arc;
mod line;
mod pixel;
mod polynomial;
mod scene;
mod trust;

pub(crate) use pixel::Lines;
