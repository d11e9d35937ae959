//! Eight vectors at a time.
//!
//! As in [`crate::numeric::lanes`] there are no closures in what computes with them.

use super::lanes::{f64x8, mask64x8};
use fearless_simd::Simd;
use glam::{DMat3, DVec3};

/// Eight vectors, component by component. Sums of three add from left to right, as glam does for one
/// vector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vectors<S: Simd> {
    pub(crate) x: f64x8<S>,
    pub(crate) y: f64x8<S>,
    pub(crate) z: f64x8<S>,
}

impl<S: Simd> Vectors<S> {
    /// One vector, eight times.
    #[inline(always)]
    pub(crate) fn splat(simd: S, vector: DVec3) -> Self {
        Self {
            x: f64x8::splat(simd, vector.x),
            y: f64x8::splat(simd, vector.y),
            z: f64x8::splat(simd, vector.z),
        }
    }

    /// The vectors with these components.
    #[inline(always)]
    pub(crate) fn from_array([x, y, z]: [f64x8<S>; 3]) -> Self {
        Self { x, y, z }
    }

    /// The vector in one lane.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> DVec3 {
        DVec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    #[inline(always)]
    pub(crate) fn set_lane(&mut self, lane: usize, vector: DVec3) {
        self.x[lane] = vector.x;
        self.y[lane] = vector.y;
        self.z[lane] = vector.z;
    }

    /// `self` where the mask holds, else `other`.
    #[inline(always)]
    pub(crate) fn or(&self, mask: mask64x8<S>, other: &Self) -> Self {
        Self {
            x: mask.select(self.x, other.x),
            y: mask.select(self.y, other.y),
            z: mask.select(self.z, other.z),
        }
    }

    /// The component along the axis with this number.
    #[inline(always)]
    pub(crate) fn along(&self, axis: usize) -> f64x8<S> {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }

    #[inline(always)]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }

    #[inline(always)]
    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }

    #[inline(always)]
    pub(crate) fn times(&self, factor: f64x8<S>) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }

    /// The vectors in another frame.
    #[inline(always)]
    pub(crate) fn rotated(&self, matrix: &DMat3) -> Self {
        let rows = matrix.transpose();
        Self {
            x: self.dot_one(rows.x_axis),
            y: self.dot_one(rows.y_axis),
            z: self.dot_one(rows.z_axis),
        }
    }

    /// The sizes of the components.
    #[inline(always)]
    pub(crate) fn sizes(&self) -> Self {
        Self {
            x: self.x.abs(),
            y: self.y.abs(),
            z: self.z.abs(),
        }
    }

    /// The scalar products.
    #[inline(always)]
    pub(crate) fn dot(&self, other: &Self) -> f64x8<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The scalar products with one vector.
    #[inline(always)]
    pub(crate) fn dot_one(&self, other: DVec3) -> f64x8<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub(crate) fn length_squared(&self) -> f64x8<S> {
        self.dot(self)
    }

    /// The vector products.
    #[inline(always)]
    pub(crate) fn cross(&self, other: &Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}
