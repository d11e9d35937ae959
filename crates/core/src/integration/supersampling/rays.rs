//! The rays of a tile, eight pixels of a row at a time.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x8};
use glam::{DVec2, DVec3};

use super::lanes::Vectors;
use crate::{Ray, Tile, View};

/// Where the samples of a view lie: those of [`View::cell_center`] to the bit.
#[derive(Clone, Debug)]
pub(super) struct Rays<'scene> {
    view: &'scene View,
    /// Samples on a side of a pixel.
    side: u32,
    /// Half the side of a cell.
    half_cell: f64,
    distance: f64,
    /// Directions are divided by two to the power of this, which makes them moderate.
    exponent: i32,
    scale: f64,
}

/// A sample of each of eight pixels in a row: which part of the pixels, and where the row starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) col: u32,
    pub(super) row: u32,
    pub(super) cell_col: u32,
    pub(super) cell_row: u32,
}

impl<'scene> Rays<'scene> {
    pub(super) fn new(view: &'scene View, side: u32) -> Self {
        let cell = view.lens.width / (f64::from(view.width) * f64::from(side));
        let distance = view.lens.distance * view.zoom;
        let size = DVec2::new(f64::from(view.width), f64::from(view.height));
        let edges = 0.5 * view.pixel_size() * size + view.lens.shift.abs();
        let exponent = libm::ilogb(edges.max_element().max(distance)).clamp(-1000, 1000);
        Self {
            view,
            side,
            half_cell: 0.5 * cell,
            distance,
            exponent,
            scale: libm::scalbn(1.0, -exponent),
        }
    }

    /// The exponent of the power of two that directions were divided by.
    pub(super) fn exponent(&self) -> i32 {
        self.exponent
    }

    /// How many samples lie side by side on a length of 1 at the distance of 1.
    pub(super) fn cells_on_unit(&self) -> f64 {
        self.distance / (2.0 * self.half_cell)
    }

    /// The directions of a sample in eight pixels, divided by that power; pixels after the first
    /// `width` repeat the last of them.
    #[inline(always)]
    pub(super) fn directions<S: Simd>(&self, simd: S, place: Place, width: u32) -> Vectors<S> {
        let steps: [f64; 8] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let steps = f64x8::simd_from(simd, steps);
        let last = f64x8::splat(simd, f64::from(width - 1));
        let steps = steps.simd_lt(last).select(steps, last);
        // Twice the distance from the middle in cells: whole numbers, far below 2⁵³.
        let twice = |pixel: u32, cell: u32, pixels: u32| {
            let index = i64::from(pixel) * i64::from(self.side) + i64::from(cell);
            (2 * index + 1 - i64::from(self.side) * i64::from(pixels)) as f64
        };
        let first = twice(place.col, place.cell_col, self.view.width);
        let across = steps * (2.0 * f64::from(self.side)) + first;
        let upward = twice(place.row, place.cell_row, self.view.height);
        let u = across * self.half_cell + self.view.lens.shift.x;
        let v = -self.half_cell * upward + self.view.lens.shift.y;

        let axes = &self.view.camera.world_from_camera;
        let (up, forward) = (axes.y_axis * v, axes.z_axis * self.distance);
        let component = |x: f64, y: f64, z: f64| (u * x + y + z) * self.scale;
        Vectors {
            x: component(axes.x_axis.x, up.x, forward.x),
            y: component(axes.x_axis.y, up.y, forward.y),
            z: component(axes.x_axis.z, up.z, forward.z),
        }
    }

    /// The ray of one of the eight pixels.
    pub(super) fn ray(&self, place: Place, lane: usize) -> Ray {
        let cell =
            |pixel: u32, cell: u32| u64::from(pixel) * u64::from(self.side) + u64::from(cell);
        let center = self.view.cell_center(
            cell(place.col + lane as u32, place.cell_col),
            cell(place.row, place.cell_row),
            self.side,
        );
        self.view.ray(center)
    }

    /// A circular cone around all rays of a tile; none where it would be wider than is worth
    /// having.
    pub(super) fn cone(&self, tile: Tile) -> Option<Cone> {
        /// Above all rounding errors, which are of some units in the last place.
        const WIDER: f64 = 1.0 + 1e-9;
        const WIDEST_SINE: f64 = 0.7;
        let pixel = self.view.pixel_size();
        let middle = |first: u32, count: u32, pixels: u32| {
            f64::from(first) + 0.5 * (f64::from(count) - f64::from(pixels))
        };
        let center = DVec3::new(
            middle(tile.col, tile.width, self.view.width) * pixel + self.view.lens.shift.x,
            -middle(tile.row, tile.height, self.view.height) * pixel + self.view.lens.shift.y,
            self.distance,
        ) * self.scale;
        let half = DVec2::new(f64::from(tile.width), f64::from(tile.height)) * (0.5 * pixel);
        let half = half * self.scale;
        // The corner with the largest angle a: sin a = |center × corner| / (|center| |corner|).
        let center_sq = center.length_squared();
        let sine_sq = |x: f64, y: f64| {
            let corner = center + DVec3::new(x, y, 0.0);
            let cross = center.cross(DVec3::new(x, y, 0.0));
            cross.length_squared() / (center_sq * corner.length_squared())
        };
        let (one, other) = (sine_sq(half.x, half.y), sine_sq(half.x, -half.y));
        let (third, fourth) = (sine_sq(-half.x, half.y), sine_sq(-half.x, -half.y));
        let sine_sq = one.max(other).max(third.max(fourth)) * WIDER;
        let is_sane = sine_sq < WIDEST_SINE * WIDEST_SINE && center_sq > 1e-60;
        is_sane.then(|| Cone {
            axis: self.view.camera.world_from_camera * (center * (1.0 / center_sq.sqrt())),
            sine: sine_sq.sqrt(),
            cosine: (1.0 - sine_sq).sqrt(),
        })
    }
}

/// A circular cone with its tip in the viewpoint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    /// Unit, in the world frame.
    pub(super) axis: DVec3,
    /// Of the angle between the axis and the surface.
    pub(super) sine: f64,
    pub(super) cosine: f64,
}
