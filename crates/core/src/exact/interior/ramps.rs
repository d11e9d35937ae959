//! Pixels of plain spheres with a terminator in them, where nothing else ends.
//!
//! Let f = n·l in a pixel, in sides from its middle, L its value and slope there, and q what its second derivatives add.
//! The average of max(0, L) has a closed form, and max(0, f) differs from that by |q| + |f − L − q| at most. With the
//! sizes |a_jk| ≤ M s^(j+k) of the coefficients of f where half a side is 1 (see [`remainder`](super::remainder)), s
//! being half of the longer side over h, the last is no more than
//!
//! ```text
//! Σ M s^m (m + 1) over m ≥ 3,    M s³ (4 − 3 s) / (1 − s)².
//! ```

use fearless_simd::Simd;
use glam::DVec3;

use super::mean_normals::{ROUNDING, SLACK};
use super::reached::Analytic;
use super::remainder::MOST;
use crate::exact::edged::boxes::half_plane::ramp;
use crate::numeric::lanes::f64x8;

/// The averages of n·l over eight pixels, where it is positive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ramps {
    pub(super) averages: [f64; 8],
    /// Bounds of what they are off by; infinite where nothing is proved.
    pub(super) bounds: [f64; 8],
}

impl Ramps {
    /// The ramps of pixels under a directional light.
    ///
    /// # Accuracy
    /// A bound, with rounding. `tests::ramps_are_within_their_bounds` holds it against sums over many points.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, analytic: &Analytic<'_, S>, toward: DVec3) -> Self {
        /// More than the closed form moves by where a line is nearly parallel to a side.
        const OF_PARALLEL: f64 = 4e-9;
        let one = f64x8::splat(simd, 1.0);
        let Analytic {
            ref domain, sides, ..
        } = *analytic;
        let cosine = domain.cosine(toward);
        let (slopes, of_slopes) = domain.slopes(toward);
        let (width, ratio) = (sides.width, sides.height_by_width);
        let across = [slopes[0] * width, slopes[1] * ratio * width];
        let averages = ramp(simd, cosine.value, across);
        let s = domain.share;
        let rest = one - s;
        let s_sq = s * s;
        let higher = cosine.change * (s * s_sq) * (one * 4.0 - s * 3.0) / (rest * rest);
        let [by_x, by_both, by_y] = domain.bends(toward);
        let by_rows = by_y.abs() * (ratio * ratio);
        let bend = (by_x.abs() + by_both.abs() * (2.0 * ratio) + by_rows) * (width * width / 8.0);
        let steep = across[0].abs() + across[1].abs();
        let rounding = cosine.rounding
            + steep * (of_slopes + OF_PARALLEL)
            + cosine.change * s_sq * (of_slopes * 8.0)
            + ROUNDING;
        let is_known = domain.is_known & s_sq.simd_le(MOST);
        let bounds = (bend + higher + rounding) * SLACK;
        Self {
            averages: averages.into(),
            bounds: is_known.select(bounds, one * f64::INFINITY).into(),
        }
    }
}

#[cfg(test)]
mod tests;
