//! Boxes in single precision, eight side by side.

use fearless_simd::Simd;

use super::order::{Entry, WIDTH};
use crate::numeric::lanes::f64x8;

/// Twice the bound of what rounding moved the center of an entry by, relatively; it is below the
/// least number that is not 0, too.
pub(super) const ROUNDING: f64 = f32::EPSILON as f64;
pub(super) const LEAST: f64 = f32::MIN_POSITIVE as f64;

/// Eight boxes along the axes of the world, or fewer: those that are missing hold nothing.
///
/// Rounded outward: whatever is in a box for its exact numbers is in it as it is stored. A box
/// that single precision cannot hold reaches to infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(crate) struct Boxes {
    /// By axis, then by box.
    pub(crate) low: [[f32; WIDTH]; 3],
    pub(crate) high: [[f32; WIDTH]; 3],
}

impl Boxes {
    /// Eight boxes that hold nothing.
    pub(super) const EMPTY: Self = Self {
        low: [[f32::INFINITY; WIDTH]; 3],
        high: [[f32::NEG_INFINITY; WIDTH]; 3],
    };

    /// Makes a box hold a sphere as well.
    pub(super) fn add(&mut self, place: usize, entry: &Entry) {
        let radius = f64::from(entry.radius);
        for axis in 0..3 {
            let center = f64::from(entry.center[axis]);
            let reach = radius + (center.abs() * ROUNDING + LEAST);
            self.low[axis][place] = self.low[axis][place].min(rounded_down(center - reach));
            self.high[axis][place] = self.high[axis][place].max(rounded_up(center + reach));
        }
    }

    /// Makes a box hold all boxes of others.
    pub(super) fn add_all(&mut self, place: usize, others: &Self) {
        for axis in 0..3 {
            let low = others.low[axis]
                .iter()
                .copied()
                .fold(f32::INFINITY, f32::min);
            let high = others.high[axis]
                .iter()
                .copied()
                .fold(f32::NEG_INFINITY, f32::max);
            self.low[axis][place] = self.low[axis][place].min(low);
            self.high[axis][place] = self.high[axis][place].max(high);
        }
    }

    /// The boxes that hold anything, as bits.
    pub(crate) fn filled(&self) -> u8 {
        let mut filled = 0;
        for place in 0..WIDTH {
            filled |= u8::from(self.low[0][place] <= self.high[0][place]) << place;
        }
        filled
    }
}

/// Eight numbers as doubles.
#[inline(always)]
pub(crate) fn doubles<S: Simd>(simd: S, numbers: &[f32; WIDTH]) -> f64x8<S> {
    f64x8::from_array(simd, numbers.map(f64::from))
}

/// A number that is not greater, for one that was rounded to a double.
fn rounded_down(number: f64) -> f32 {
    let rounded = number as f32;
    if f64::from(rounded) < number {
        rounded
    } else {
        rounded.next_down()
    }
}

pub(super) fn rounded_up(number: f64) -> f32 {
    -rounded_down(-number)
}
