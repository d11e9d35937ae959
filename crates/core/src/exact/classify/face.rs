//! The part of a sphere that lies inside of its outline.

use crate::edges::cell::Ball;
use crate::numeric::polynomial::Quadratic;

/// The part of an active sphere that a cell sees.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Face {
    /// All of it: no outline.
    All,
    /// The part where this polynomial is not negative, inside of an outline: the contour of a smaller sphere, which is the
    /// ball.
    Inside(Ball, Quadratic),
    /// The outline alone.
    Nothing,
}

impl Face {
    /// Returns whether a place of the cell shows the outline.
    #[inline]
    pub(crate) fn is_outline_at(&self, x: f64, y: f64) -> bool {
        match self {
            Self::All => false,
            Self::Inside(_, conic) => conic.at(x, y) < 0.0,
            Self::Nothing => true,
        }
    }
}
