//! Vectors of eight rays side by side.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x8, mask64x8};
use glam::DVec3;

/// Rays side by side.
pub(super) const LANES: usize = 8;

/// Eight vectors, component by component.
#[derive(Clone, Copy)]
pub(super) struct Vectors<S: Simd> {
    pub(super) x: f64x8<S>,
    pub(super) y: f64x8<S>,
    pub(super) z: f64x8<S>,
}

/// Where the sums below add from left to right, as glam does for a single vector.
impl<S: Simd> Vectors<S> {
    #[inline(always)]
    pub(super) fn splat(simd: S, vector: DVec3) -> Self {
        Self {
            x: f64x8::splat(simd, vector.x),
            y: f64x8::splat(simd, vector.y),
            z: f64x8::splat(simd, vector.z),
        }
    }

    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> DVec3 {
        DVec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    #[inline(always)]
    pub(super) fn set_lane(&mut self, lane: usize, vector: DVec3) {
        self.x[lane] = vector.x;
        self.y[lane] = vector.y;
        self.z[lane] = vector.z;
    }

    #[inline(always)]
    pub(super) fn dot(self, other: Self) -> f64x8<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub(super) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline(always)]
    pub(super) fn scaled(self, factor: f64x8<S>) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }

    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }

    #[inline(always)]
    pub(super) fn minus(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }

    /// `self` where the mask holds, else `other`.
    #[inline(always)]
    pub(super) fn or(self, mask: mask64x8<S>, other: Self) -> Self {
        Self {
            x: mask.select(self.x, other.x),
            y: mask.select(self.y, other.y),
            z: mask.select(self.z, other.z),
        }
    }
}

/// The lanes of a bit mask.
pub(super) fn lanes_of(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}
