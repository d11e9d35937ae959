//! Bounds on the retina of eight boxes, or eight spheres, side by side.

use fearless_simd::{Level, Simd, dispatch};
use glam::{DMat3, DVec3};

use super::frustum::CLEAR;
use super::grid::{CellRange, Ends, Grid, Spans};
use super::hierarchy::boxes::{Boxes, doubles};
use super::hierarchy::groups::Group;
use super::hierarchy::order::WIDTH;
use crate::model::view::View;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::numeric::vectors::Vectors;

/// The projection of a view, from places in the world to cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    position: DVec3,
    /// Times lengths of the world.
    scale: f64,
    camera_from_world: DMat3,
    /// The instructions that the processor has.
    level: Level,
}

/// The bounds of eight boxes or spheres.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScreenBounds {
    /// Those that may be seen, as bits; of others nothing is known.
    pub(super) may: u8,
    /// They come no nearer than this.
    pub(super) begin: [f64; WIDTH],
    /// Their centers, in the camera's frame.
    center: [[f64; WIDTH]; 3],
    columns: Spans,
    rows: Spans,
}

impl ScreenBounds {
    /// The cells that one of those may be seen in.
    #[inline]
    pub(super) fn range(&self, place: usize) -> CellRange {
        CellRange {
            columns: (self.columns.0[place], self.columns.1[place]),
            rows: (self.rows.0[place], self.rows.1[place]),
        }
    }

    /// The center of one of those.
    #[inline]
    pub(super) fn center(&self, place: usize) -> DVec3 {
        DVec3::from_array(self.center.map(|axis| axis[place]))
    }
}

impl Projection {
    /// The projection of a view; lengths are multiplied by `scale`.
    pub(super) fn new(view: &View, scale: f64) -> Self {
        Self {
            position: view.camera.position,
            scale,
            camera_from_world: view.camera.world_from_camera.transpose(),
            level: Level::new(),
        }
    }

    /// From the eye to a point, in the world's directions.
    pub(super) fn offset(&self, point: DVec3) -> DVec3 {
        (point - self.position) * self.scale
    }

    /// The same in those of the camera.
    pub(super) fn turned(&self, offset: DVec3) -> DVec3 {
        self.camera_from_world * offset
    }

    /// The bounds of boxes.
    pub(super) fn boxes(&self, boxes: &Boxes, grid: &Grid) -> ScreenBounds {
        dispatch!(self.level, simd => self.boxes_in(simd, boxes, grid))
    }

    /// The bounds of spheres.
    pub(super) fn spheres(&self, group: &Group, grid: &Grid) -> ScreenBounds {
        dispatch!(self.level, simd => self.spheres_in(simd, group, grid))
    }

    #[inline(always)]
    fn boxes_in<S: Simd>(&self, simd: S, boxes: &Boxes, grid: &Grid) -> ScreenBounds {
        /// More than rounding moves the box by, and the distances to the spheres in it. (Sums of
        /// neighbors in single precision are exact: the middle is rounded where the box is wide.)
        const MARGIN: f64 = 1e-9;
        let zero = f64x8::splat(simd, 0.0);
        let (mut middle, mut half) = ([zero; 3], [zero; 3]);
        let mut filled = mask64x8::splat(simd, true);
        for axis in 0..3 {
            let low = doubles(simd, &boxes.low[axis]);
            let high = doubles(simd, &boxes.high[axis]);
            filled &= low.simd_le(high);
            middle[axis] = ((low + high) * 0.5 - self.position[axis]) * self.scale;
            half[axis] = (high - low) * (0.5 * self.scale);
        }
        let center = self.turn(&Vectors::from_array(middle), false);
        let half = self.turn(&Vectors::from_array(half), true);
        let size = center.x.abs() + center.y.abs() + center.z.abs() + half.x + half.y + half.z;
        let (center, mut half) = ([center.x, center.y, center.z], [half.x, half.y, half.z]);
        let mut beyond_sq = zero;
        for axis in 0..3 {
            half[axis] += size * MARGIN;
            let beyond = (center[axis].abs() - half[axis]).max(zero);
            beyond_sq += beyond * beyond;
        }
        let begin = beyond_sq.sqrt() - size * MARGIN;
        let (near, far) = (center[2] - half[2], center[2] + half[2]);
        let is_finite = size.simd_lt(f64::INFINITY);
        let is_behind = far.simd_lt(zero) & is_finite;
        let is_known = near.simd_gt(size * MARGIN) & is_finite;
        let mut ends = [(zero, zero); 2];
        for axis in 0..2 {
            let (low, high) = (center[axis] - half[axis], center[axis] + half[axis]);
            ends[axis] = (
                low / low.simd_lt(zero).select(near, far),
                high / high.simd_gt(zero).select(near, far),
            );
        }
        // Whatever single precision cannot hold may be anywhere.
        let begin = is_finite.select(begin, zero);
        let may = filled & !is_behind;
        let center = Vectors::from_array(center);
        self.bounds(simd, grid, (center, begin), may, (is_known, ends))
    }

    /// With the bounds of [`CameraSphere`](super::frustum::CameraSphere), which are above what rounding
    /// moves the distance by, too.
    #[inline(always)]
    fn spheres_in<S: Simd>(&self, simd: S, group: &Group, grid: &Grid) -> ScreenBounds {
        let [x, y, z] = &group.center;
        let offset = Vectors {
            x: (f64x8::from_array(simd, *x) - self.position.x) * self.scale,
            y: (f64x8::from_array(simd, *y) - self.position.y) * self.scale,
            z: (f64x8::from_array(simd, *z) - self.position.z) * self.scale,
        };
        let radius = f64x8::from_array(simd, group.radius) * self.scale;
        let size = offset.x.abs() + offset.y.abs() + offset.z.abs() + radius;
        let radius = radius + (size * (128.0 * UNIT_ROUNDOFF) + f64::MIN_POSITIVE);
        let center = self.turn(&offset, false);
        let Vectors { x, y, z } = center;
        let product = (z - radius) * (z + radius);
        let inverse = 1.0 / product;
        let mut ends = [(x, x); 2];
        for (axis, along) in [x, y].into_iter().enumerate() {
            let half = radius * (along * along + product).sqrt();
            let middle = along * z;
            ends[axis] = ((middle - half) * inverse, (middle + half) * inverse);
        }
        let is_behind = z.simd_lt(-radius);
        let is_known = z.simd_gt(radius * CLEAR);
        let begin = offset.length_squared().sqrt() - radius;
        self.bounds(simd, grid, (center, begin), !is_behind, (is_known, ends))
    }

    /// Vectors of the world in the camera's directions, or boxes of these half sizes.
    #[inline(always)]
    fn turn<S: Simd>(&self, vectors: &Vectors<S>, are_sizes: bool) -> Vectors<S> {
        let mut axes = self.camera_from_world;
        if are_sizes {
            axes = axes.abs();
        }
        Vectors {
            x: vectors.dot_one(axes.row(0)),
            y: vectors.dot_one(axes.row(1)),
            z: vectors.dot_one(axes.row(2)),
        }
    }

    /// The bounds of what is seen between these ends, low and high, on the retina at distance 1, or,
    /// where they are not known, anywhere.
    #[inline(always)]
    fn bounds<S: Simd>(
        &self,
        simd: S,
        grid: &Grid,
        (center, begin): (Vectors<S>, f64x8<S>),
        may: mask64x8<S>,
        (is_known, ends): (mask64x8<S>, Ends<S>),
    ) -> ScreenBounds {
        let (columns, rows, are_any) = grid.spans(simd, ends, is_known);
        ScreenBounds {
            may: (may & are_any).to_bitmask() as u8,
            begin: begin.into(),
            center: [center.x.into(), center.y.into(), center.z.into()],
            columns,
            rows,
        }
    }
}
