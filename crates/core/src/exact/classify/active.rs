//! A sphere that may be seen in a cell.

use crate::edges::cell::Ball;
use crate::numeric::polynomial::{Linear, Quadratic};

/// A sphere that may be seen in a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Active {
    pub(crate) sphere: usize,
    pub(crate) ball: Ball,
    /// The discriminant Q of the ray.
    pub(crate) discriminant: Quadratic,
    /// d · c.
    pub(crate) along: Linear,
    /// Whether the terminators belong to a surface without bumps.
    pub(crate) is_smooth: bool,
}
