//! Eight boxes of a cell, side by side.

use crate::numeric::lanes::f64x8;
use fearless_simd::Simd;

/// Eight numbers in memory.
pub(super) type Eight = [f64; 8];

/// Eight boxes of one size, in the coordinates of their cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct EightBoxes<S: Simd> {
    /// Their middles.
    pub(super) x: f64x8<S>,
    pub(super) y: f64x8<S>,
    pub(super) size: [f64; 2],
}
