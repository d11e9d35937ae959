//! Boxes in single precision, eight side by side.

use glam::DVec3;

use crate::Sphere;

/// Children of a node.
pub(crate) const WIDTH: usize = 8;

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
    pub(super) fn add_sphere(&mut self, place: usize, sphere: &Sphere) {
        let (center, radius) = (sphere.center(), DVec3::splat(sphere.radius()));
        let (low, high) = ((center - radius).to_array(), (center + radius).to_array());
        for axis in 0..3 {
            // The sum was rounded, by less than the way to the next number.
            let (low, high) = (low[axis].next_down(), high[axis].next_up());
            self.low[axis][place] = self.low[axis][place].min(rounded_down(low));
            self.high[axis][place] = self.high[axis][place].max(rounded_up(high));
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
    pub(super) fn filled(&self) -> u8 {
        let mut filled = 0;
        for place in 0..WIDTH {
            filled |= u8::from(self.low[0][place] <= self.high[0][place]) << place;
        }
        filled
    }
}

fn rounded_down(number: f64) -> f32 {
    let rounded = number as f32;
    if f64::from(rounded) > number {
        rounded.next_down()
    } else {
        rounded
    }
}

fn rounded_up(number: f64) -> f32 {
    -rounded_down(-number)
}
