//! Events along curves, and the places of these.

use fearless_simd::Simd;

use super::circle::Trace;
use super::curve::trace;
use super::dips::{around, dips, may_dip};
use super::functions::{Function, value};
use super::piece::Piece;
use super::setting::{Curve, Setting};
use crate::numeric::lanes::f64x8;

/// Points on a piece at which functions are looked at first, and the intervals between them, bit by
/// bit.
pub(super) const STEPS: [f64; 8] = [
    0.0,
    1.0 / 7.0,
    2.0 / 7.0,
    3.0 / 7.0,
    4.0 / 7.0,
    5.0 / 7.0,
    6.0 / 7.0,
    1.0,
];
pub(super) const INTERVALS: u64 = 0x7f;

/// A stretch of a curve that is looked at in eight places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch<'a> {
    pub(super) curve: &'a Curve,
    pub(super) piece: &'a Piece,
    pub(super) start: f64,
    pub(super) end: f64,
}

impl Stretch<'_> {
    fn at(&self, share: f64) -> f64 {
        self.start + share * (self.end - self.start)
    }

    /// Appends where a function with these values at the eight places vanishes, in some intervals
    /// between them.
    #[inline(never)]
    pub(super) fn roots<S: Simd>(
        &self,
        simd: S,
        setting: &Setting<'_, '_>,
        function: Function,
        values: f64x8<S>,
        intervals: u64,
        breaks: &mut Vec<f64>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                // Where values differ by so little from each other, none changes its sign, and none dips:
                // a dip is at most 1.6 times as deep as they differ.
                const ALIKE: f64 = 0.23;
                let first = values[0];
                let is_alike = (values - first).abs().simd_lt(ALIKE * first.abs());
                if is_alike.all_true() {
                    return;
                }
                let below = values.simd_lt(0.0).to_bitmask();
                let mut changes = (below ^ (below >> 1)) & intervals;
                while changes != 0 {
                    let lane = changes.trailing_zeros() as usize;
                    changes &= changes - 1;
                    let bracket = [self.at(STEPS[lane]), self.at(STEPS[lane + 1])];
                    let ends = [values[lane], values[lane + 1]];
                    breaks.push(self.root(simd, setting, function, bracket, ends));
                }
                self.find_dips(simd, setting, function, values, intervals, breaks);
            },
        )
    }

    /// Appends where a function with these values at the eight places, of one sign at both ends of some intervals
    /// between them, may vanish within these.
    #[inline(always)]
    pub(super) fn find_dips<S: Simd>(
        &self,
        simd: S,
        setting: &Setting<'_, '_>,
        function: Function,
        values: f64x8<S>,
        intervals: u64,
        breaks: &mut Vec<f64>,
    ) {
        let mut dips = dips(values) & intervals;
        while dips != 0 {
            let lane = dips.trailing_zeros() as usize;
            dips &= dips - 1;
            let bracket = [self.at(STEPS[lane]), self.at(STEPS[lane + 1])];
            let four = around(&values.into(), lane);
            self.dip(simd, setting, function, (bracket, four), CLOSER, breaks);
        }
    }

    /// Appends where a function vanishes in a bracket at whose ends its values have one sign, looking closer some
    /// times. Its four values are one bracket before it, at its ends, and one bracket after it.
    #[inline(never)]
    fn dip<S: Simd>(
        &self,
        simd: S,
        setting: &Setting<'_, '_>,
        function: Function,
        (bracket, [before, one, other, after]): ([f64; 2], [f64; 4]),
        closer: u32,
        breaks: &mut Vec<f64>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let step = (bracket[1] - bracket[0]) / 9.0;
                let mut places = [bracket[0]; 10];
                for (index, place) in places.iter_mut().enumerate() {
                    *place += index as f64 * step;
                }
                let mut inner = [0.0; 8];
                inner.copy_from_slice(&places[1..9]);
                let points = self.trace(simd, setting, f64x8::from_array(simd, inner));
                let found: [f64; 8] = value(simd, setting, function, &points).into();
                // Outside, it falls to the bracket at least as steeply as on the way there.
                let mut values = [0.0; 12];
                values[0] = one + (before - one) / 9.0;
                values[1] = one;
                values[2..10].copy_from_slice(&found);
                values[10] = other;
                values[11] = other + (after - other) / 9.0;
                let known = breaks.len();
                for index in 0..9 {
                    let (one, other) = (values[index + 1], values[index + 2]);
                    if (one < 0.0) != (other < 0.0) {
                        let bracket = [places[index], places[index + 1]];
                        breaks.push(self.root(simd, setting, function, bracket, [one, other]));
                    }
                }
                if breaks.len() > known || closer == 0 {
                    return;
                }
                for index in 0..9 {
                    let four = [
                        values[index],
                        values[index + 1],
                        values[index + 2],
                        values[index + 3],
                    ];
                    if may_dip(four) {
                        let bracket = [places[index], places[index + 1]];
                        self.dip(simd, setting, function, (bracket, four), closer - 1, breaks);
                    }
                }
            },
        )
    }

    #[inline(always)]
    pub(super) fn trace<S: Simd>(
        &self,
        simd: S,
        setting: &Setting<'_, '_>,
        s: f64x8<S>,
    ) -> Trace<S> {
        trace(simd, setting.cell, &self.curve.shape, self.piece, s)
    }

    /// The eight places.
    #[inline(always)]
    pub(super) fn places<S: Simd>(&self, simd: S, setting: &Setting<'_, '_>) -> Trace<S> {
        let steps: f64x8<S> = f64x8::from_array(simd, STEPS);
        self.trace(simd, setting, steps * (self.end - self.start) + self.start)
    }

    /// The parameter between two, with values of different signs, at which a function vanishes.
    #[inline(never)]
    fn root<S: Simd>(
        &self,
        simd: S,
        setting: &Setting<'_, '_>,
        function: Function,
        mut bracket: [f64; 2],
        mut values: [f64; 2],
    ) -> f64 {
        /// Places around where a straight line would vanish, in widths of the bracket.
        const AROUND: [f64; 8] = [-0.2, -0.02, -0.002, -0.0002, 0.0002, 0.002, 0.02, 0.2];
        /// A bracket in which a straight line will do, in sides of the cell: the parameter's range may be hundreds of
        /// cells long.
        const NARROW: f64 = 3e-4;
        const MOST_ROUNDS: usize = 4;
        simd.vectorize(
            #[inline(always)]
            || {
                let around: f64x8<S> = f64x8::from_array(simd, AROUND);
                for _ in 0..MOST_ROUNDS {
                    let width = bracket[1] - bracket[0];
                    let guess = bracket[0] + width * share_of_root(&values);
                    let at = around * width + guess;
                    let at = at
                        .max(f64x8::splat(simd, bracket[0]))
                        .min(f64x8::splat(simd, bracket[1]));
                    let places = self.trace(simd, setting, at);
                    let found = value(simd, setting, function, &places);
                    let below = found.simd_lt(0.0).to_bitmask();
                    // The first that differs from the start.
                    let differs = if values[0] < 0.0 {
                        !below & 0xff
                    } else {
                        below
                    };
                    let first = differs.trailing_zeros() as usize;
                    if first > 0 {
                        let before = first.min(8) - 1;
                        bracket[0] = at[before];
                        values[0] = found[before];
                    }
                    if first < 8 {
                        bracket[1] = at[first];
                        values[1] = found[first];
                    }
                    let near = first.min(7);
                    let speed = places.dx[near].abs().max(places.dy[near].abs());
                    if (bracket[1] - bracket[0]) * speed.max(1.0) < NARROW {
                        break;
                    }
                }
                bracket[0] + (bracket[1] - bracket[0]) * share_of_root(&values)
            },
        )
    }
}

/// The place, between 0 and 1, where a straight line with these values at the ends vanishes.
fn share_of_root(values: &[f64; 2]) -> f64 {
    let share = values[0] / (values[0] - values[1]);
    if share.is_finite() { share } else { 0.5 }
}

/// The number of closer looks at a dip.
const CLOSER: u32 = 2;
