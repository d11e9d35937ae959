//! The average over a pixel by random samples, for bumps far smaller than the pixel.

use glam::{DVec2, DVec4};

use super::patch::Patch;
use super::{Reference, TOLERANCE, Truth};

/// The assumed largest error of the mean, in standard deviations.
const DEVIATIONS: f64 = 6.0;

impl Reference<'_> {
    /// The value of a pixel from two random samples in each of `side` × `side` strata.
    ///
    /// The error follows from the difference between the two samples of a stratum. It does not include details that no
    /// sample hits.
    pub fn by_strata(&self, col: u32, row: u32, side: u32, seed: u64) -> Truth {
        let patch = Patch::of_pixel(&self.stage, col, row, TOLERANCE);
        let mut state = (u64::from(col) << 32 | u64::from(row)) ^ seed;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut sum, mut squares) = (DVec4::ZERO, DVec4::ZERO);
        let mut first = None;
        let mut has_edge = false;
        for y in 0..side {
            for x in 0..side {
                let mut sample = || {
                    let place = DVec2::new(f64::from(x) + uniform(), f64::from(y) + uniform());
                    let place = place / f64::from(side) - 0.5;
                    let (signature, light) = patch.look(patch.direction(place), true);
                    has_edge |= *first.get_or_insert(signature) != signature;
                    light
                };
                let (one, other) = (sample(), sample());
                sum += one + other;
                squares += (one - other) * (one - other);
            }
        }
        let count = 2.0 * f64::from(side).powi(2);
        Truth {
            value: sum / count,
            error: DEVIATIONS * squares.max_element().sqrt() / count,
            has_edge,
            lines: 0,
        }
    }
}
