//! Groups of eight spheres, side by side.

use super::boxes::{LEAST, ROUNDING, rounded_up};
use super::order::{Entry, WIDTH};
use crate::model::sphere::Sphere;

/// Eight spheres, or nearly: then they contain the true ones, and are contained in them when they are smaller by
/// [`Group::excess`]. Where there is none is one of radius 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Group {
    /// By axis, then by sphere.
    pub(crate) center: [[f64; WIDTH]; 3],
    pub(crate) radius: [f64; WIDTH],
    /// Whether these are not the spheres themselves.
    is_near: bool,
}

impl Group {
    /// The spheres with these indices, no more than eight.
    #[inline(always)]
    pub(super) fn new(indices: &[u32], spheres: &[Sphere]) -> Self {
        let mut group = Self {
            center: [[0.0; WIDTH]; 3],
            radius: [0.0; WIDTH],
            is_near: false,
        };
        for (place, &index) in indices.iter().enumerate() {
            if let Some(sphere) = spheres.get(index as usize) {
                for axis in 0..3 {
                    group.center[axis][place] = sphere.center()[axis];
                }
                group.radius[place] = sphere.radius();
            }
        }
        group
    }

    /// More than what the radius has to be smaller by for a sphere inside of the true one: twice what
    /// the center may be moved by, and what it costs to round the radius up twice.
    #[inline(always)]
    pub(crate) fn excess(&self, place: usize) -> f64 {
        if !self.is_near {
            return 0.0;
        }
        let mut moved = 0.0;
        for axis in 0..3 {
            moved += self.center[axis][place].abs() * ROUNDING + LEAST;
        }
        2.0 * moved + 4.0 * ROUNDING * self.radius[place]
    }
}

/// Eight spheres in single precision, as much larger as their centers are moved: they contain the
/// true ones, if single precision holds their places. Where there is none is one of radius 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct NearGroup {
    center: [[f32; WIDTH]; 3],
    radius: [f32; WIDTH],
}

impl NearGroup {
    /// The group of these entries, at most eight.
    pub(super) fn new(entries: &[Entry]) -> Self {
        let mut group = Self {
            center: [[0.0; WIDTH]; 3],
            radius: [0.0; WIDTH],
        };
        for (place, entry) in entries.iter().enumerate() {
            let mut radius = f64::from(entry.radius);
            for axis in 0..3 {
                let center = entry.center[axis];
                group.center[axis][place] = center;
                radius += f64::from(center).abs() * ROUNDING + LEAST;
            }
            group.radius[place] = rounded_up(radius);
        }
        group
    }

    #[inline(always)]
    pub(super) fn group(&self) -> Group {
        let mut group = Group {
            center: [[0.0; WIDTH]; 3],
            radius: [0.0; WIDTH],
            is_near: true,
        };
        for place in 0..WIDTH {
            for axis in 0..3 {
                group.center[axis][place] = f64::from(self.center[axis][place]);
            }
            group.radius[place] = f64::from(self.radius[place]);
        }
        group
    }
}
