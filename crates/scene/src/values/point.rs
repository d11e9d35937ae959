//! Values of several numbers.

use glam::{DVec2, DVec3};

use super::quantity::{CellCount, Coordinate, Frame, MOST_FRAMES};
use crate::text::{Placed, Read, Slice, read_tuple, refuse};

/// A point or a vector of the world, the origin by default.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point(pub(crate) DVec3);

impl Placed<Point> {
    /// A vector that has a direction; `None` where a fault was reported.
    pub(crate) fn direction(&self) -> Option<DVec3> {
        let direction = self.get()?.0;
        if direction == DVec3::ZERO {
            let message = "expected a direction `(x, y, z)`, found the zero vector";
            return refuse(self.place.clone(), message);
        }
        Some(direction)
    }
}

/// The direction of an axis, of length 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis(pub(crate) DVec3);

/// A displacement on the retina.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shift(pub(crate) DVec2);

/// The first and the last frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameRange {
    pub(crate) first: i32,
    pub(crate) last: i32,
}

/// The number of cells along each edge, 1 by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Repeat(pub(crate) [u32; 3]);

impl Default for Repeat {
    fn default() -> Self {
        Self([1; 3])
    }
}

impl<'t> Read<'t> for Repeat {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let counts: [CellCount; 3] = read_tuple(slice, "three whole numbers `(a, b, c)`")?;
        Some(Self(counts.map(u32::from)))
    }
}

impl<'t> Read<'t> for Point {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let [x, y, z]: [Coordinate; 3] = read_tuple(slice, "three numbers `(x, y, z)`")?;
        Some(Self(DVec3::new(x.0, y.0, z.0)))
    }
}

impl<'t> Read<'t> for Axis {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let Point(direction) = Point::read(slice)?;
        // The largest component becomes 1 first, so that no square over- or underflows.
        let largest = direction.abs().max_element();
        let unit = (direction / largest).try_normalize();
        unit.map(Self)
            .or_else(|| slice.refuse("the direction of an axis, such as `(0, 1, 0)`"))
    }
}

impl<'t> Read<'t> for Shift {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let [right, up]: [Coordinate; 2] = read_tuple(slice, "two numbers `(right, up)`")?;
        Some(Self(DVec2::new(right.0, up.0)))
    }
}

impl<'t> Read<'t> for FrameRange {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let [Frame(first), Frame(last)] = read_tuple(slice, "two frames `(first, last)`")?;
        if first > last {
            return slice.refuse("a first frame that is not after the last");
        }
        if first.abs_diff(last) >= MOST_FRAMES.unsigned_abs() {
            return slice.refuse(&format!(
                "at most {MOST_FRAMES} frames from the first to the last"
            ));
        }
        Some(Self { first, last })
    }
}
