//! What keeps the light from a point, among the spheres in the cells of a light.

use fearless_simd::{Simd, dispatch};
use glam::DVec3;

use super::{LightGrid, Places};
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f32x8};
use crate::search::disc_grid::{PointBelow, up};

/// The part of a cell's side up to which points may be off, with all roundings: others are looked up elsewhere. Not tuned.
const MARGIN: f64 = 1.0 / 64.0;

/// A point in a cell, in single precision.
#[derive(Clone, Copy)]
struct PointInCell {
    x: f32,
    y: f32,
    /// It is off by no more than this across the light.
    around: f32,
    /// Spheres whose tops lie lower are below it for certain.
    lowest: f32,
    /// Spheres whose centers lie higher, and that are larger than the distance by more than that, hide the light for certain.
    highest: f32,
    narrower: f32,
}

impl LightGrid {
    /// Says whether a sphere keeps the light from a point: for certain, or because it holds for one that may; none where
    /// the point is not known well enough.
    ///
    /// It does for certain where its center lies ahead and the ray passes nearer to that than the radius,
    /// with whatever all of it is off by.
    pub(in crate::search) fn any(
        &self,
        point: &PointBelow,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> Option<bool> {
        let around = point.around + self.rounding;
        let at = DVec3::new(point.place.x, point.place.y, point.height) - self.low;
        let is_known = around < MARGIN * self.side && at.is_finite();
        if !is_known {
            return None;
        }
        let most = 0.5 * self.side;
        let [columns, rows] = self.cells(at, most + around);
        let narrower = if point.is_above_own {
            2.0 * around
        } else {
            f64::INFINITY
        };
        let last = self.layer(at.z - most - around);
        for row in rows.0..=rows.1 {
            for column in columns.0..=columns.1 {
                let (places, corner) = self.cell((column, row), last);
                if places.blocks().is_empty() {
                    continue;
                }
                let in_cell = at - corner;
                let point = PointInCell {
                    x: in_cell.x as f32,
                    y: in_cell.y as f32,
                    around: up(around),
                    lowest: -up(around - at.z),
                    highest: up(at.z + narrower),
                    narrower: up(narrower),
                };
                let level = self.level;
                if dispatch!(level, simd => self.any_of(simd, places, &point, holds)) {
                    return Some(true);
                }
            }
        }
        Some(self.large.iter().any(|&index| holds(index as usize)))
    }

    /// The same among some spheres of a cell.
    #[inline(always)]
    fn any_of<S: Simd>(
        &self,
        simd: S,
        places: Places,
        point: &PointInCell,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        /// More than the rounding of a sum of squares and of a square.
        const WIDER: f32 = 1.0 + 16.0 * f32::EPSILON;
        let zero = f32x8::splat(simd, 0.0);
        for number in places.blocks() {
            let [x, y, height, radius] = &self.blocks[number];
            let x = f32x8::from_array(simd, *x) - point.x;
            let y = f32x8::from_array(simd, *y) - point.y;
            let height = f32x8::from_array(simd, *height);
            let radius = f32x8::from_array(simd, *radius);
            let reach = (radius + point.around) * WIDER;
            let distance_sq = x * x + y * y;
            let is_clear =
                distance_sq.simd_gt(reach * reach) | (height + radius).simd_lt(point.lowest);
            let maybe = !is_clear.to_bitmask() & places.of_block(number);
            if maybe == 0 {
                continue;
            }
            let inner = radius - point.narrower;
            let is_hidden = (distance_sq * WIDER).simd_lt(inner * inner)
                & inner.simd_gt(zero)
                & height.simd_gt(point.highest);
            if is_hidden.to_bitmask() & maybe != 0 {
                return true;
            }
            for lane in set_bits(maybe) {
                if holds(self.indices[number * LANES + lane] as usize) {
                    return true;
                }
            }
        }
        false
    }
}
