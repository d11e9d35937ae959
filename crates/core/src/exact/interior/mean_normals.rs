//! The mean normals of pixels that one sphere fills: light on plain surfaces is their product with its direction.

use fearless_simd::Simd;
use glam::DVec3;

use super::filled::FilledRow;
use super::reached::Analytic;
use super::remainder::{GRID, MIDDLE, MOST, STAR};
use super::samples::{GAUSS_SAMPLES, POINTS, STAR_SAMPLES, Sample};
use crate::edges::cell::Ball;
use crate::exact::context::Context;
use crate::exact::points::Points;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::numeric::vectors::Vectors;

/// The mean normals of eight pixels of a row, in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeanNormals {
    /// The sphere that fills them, those that count, bit by bit, and the error that was asked for.
    sphere: usize,
    which: u64,
    tolerance: f64,
    components: [[f64; 8]; 3],
    /// The pixels, bit by bit, for which one sample was enough, or five; nine were taken for the others.
    by_middle: u64,
    by_star: u64,
    /// The samples that each of the pixels took.
    samples: usize,
}

/// More than products and sums make wrong, relatively.
pub(super) const ROUNDING: f64 = 1024.0 * UNIT_ROUNDOFF;

/// More than the rounding of domains makes wrong.
pub(super) const SLACK: f64 = 1.001;

impl MeanNormals {
    /// By one sample, five or nine, whichever is good enough for the worst direction of light.
    #[inline(always)]
    fn new<S: Simd>(
        simd: S,
        context: &Context<'_>,
        (row, analytic): (&FilledRow<'_>, &Analytic<'_, S>),
        tolerance: f64,
    ) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let ball = &row.coverage.ball;
        let (middle, sides) = context.rays(simd, row.start);
        let domain = &analytic.domain;
        let [change, bend] = domain.of_any_light(&analytic.eye);
        let p = domain.share * domain.share;
        // n·l is nearly a polynomial of degree 3, which one sample misses.
        let is_met = (change * MIDDLE.of(p)).simd_le(tolerance);
        let is_star = (change.min(bend) * STAR.of(p)).simd_le(tolerance);

        let of_middle = (ball, &middle, sides.both());
        let mut mean = normal(simd, of_middle, &POINTS[0]);
        let mut samples = 1;
        let (mut star, mut grid) = (mean.times(zero), mean.times(zero));
        if row.which & !is_met.to_bitmask() != 0 {
            let is_done = is_met | is_star;
            samples = if row.which & !is_done.to_bitmask() == 0 {
                STAR_SAMPLES
            } else {
                GAUSS_SAMPLES
            };
            star = mean.times(zero + POINTS[0].star);
            grid = mean.times(zero + POINTS[0].gauss);
            for sample in &POINTS[1..samples] {
                let there = normal(simd, of_middle, sample);
                star = star.plus(&there.times(zero + sample.star));
                grid = grid.plus(&there.times(zero + sample.gauss));
            }
        }
        mean.x = is_met.select(mean.x, is_star.select(star.x, grid.x));
        mean.y = is_met.select(mean.y, is_star.select(star.y, grid.y));
        mean.z = is_met.select(mean.z, is_star.select(star.z, grid.z));
        Self {
            sphere: row.coverage.sphere,
            which: row.which,
            tolerance,
            components: [mean.x.into(), mean.y.into(), mean.z.into()],
            by_middle: is_met.to_bitmask(),
            by_star: is_star.to_bitmask(),
            samples,
        }
    }

    /// Those of a row of pixels, out of what is known of this row; the number of samples that were taken for it.
    #[inline(always)]
    pub(super) fn of<'known, S: Simd>(
        simd: S,
        context: &Context<'_>,
        (row, analytic): (&FilledRow<'_>, &Analytic<'_, S>),
        tolerance: f64,
        known: &'known mut Vec<Self>,
    ) -> (&'known Self, u64) {
        let is_same = |one: &Self| {
            one.sphere == row.coverage.sphere
                && one.which == row.which
                && one.tolerance == tolerance
        };
        if let Some(index) = known.iter().position(is_same) {
            return (&known[index], 0);
        }
        let found = simd.vectorize(
            #[inline(always)]
            || Self::new(simd, context, (row, analytic), tolerance),
        );
        let samples = found.samples as u64 * u64::from(row.which.count_ones());
        known.push(found);
        (&known[known.len() - 1], samples)
    }

    /// Bounds of what their products with a direction are off by; infinite where nothing is proved.
    ///
    /// # Accuracy
    /// A bound, with rounding: see [`remainder`](super::remainder).
    #[inline(always)]
    pub(super) fn bounds<S: Simd>(
        &self,
        simd: S,
        analytic: &Analytic<'_, S>,
        toward: DVec3,
    ) -> [f64; 8] {
        let zero = f64x8::splat(simd, 0.0);
        let domain = &analytic.domain;
        let cosine = domain.cosine(toward);
        let p = domain.share * domain.share;
        let bend = domain.bend(toward, &analytic.eye);
        let missed = cosine.change.min(bend);
        let is_middle = mask64x8::from_bitmask(simd, self.by_middle);
        let is_star = mask64x8::from_bitmask(simd, self.by_star);
        let of_rule = is_middle.select(
            cosine.change * MIDDLE.of(p),
            is_star.select(missed * STAR.of(p), missed * GRID.of(p)),
        );
        let bound = (of_rule + cosine.rounding * 2.0 + ROUNDING) * SLACK;
        let is_known = domain.is_known & p.simd_le(MOST);
        is_known.select(bound, zero + f64::INFINITY).into()
    }

    /// The products of those of eight pixels with a direction.
    #[inline(always)]
    pub(super) fn dot(&self, lane: usize, toward: DVec3) -> f64 {
        let [x, y, z] = &self.components;
        x[lane] * toward.x + y[lane] * toward.y + z[lane] * toward.z
    }
}

/// The normals at a sample of eight pixels with these rays through their middles and these sides.
#[inline(always)]
fn normal<S: Simd>(
    simd: S,
    (ball, middle, [width, height]): (&Ball, &Vectors<S>, [f64; 2]),
    sample: &Sample,
) -> Vectors<S> {
    let ray = Vectors {
        x: middle.x + sample.u * width,
        y: middle.y + sample.v * height,
        z: middle.z,
    };
    Points::new(simd, ball, ray).normal
}
