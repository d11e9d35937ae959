//! Functions, looked at in eight places, that may vanish between two of them, though they have one sign there.

use crate::numeric::lanes::f64x8;
use fearless_simd::Simd;

/// Whether a function that is convex toward zero, with such values of one sign at four places in a row, may
/// vanish between the two in the middle: it lies on their side of both straight lines that go on from outside.
///
/// What could fool it is a function that bends twice within a step. It holds for one that turns sharply, such as
/// a shadow that grazes a terminator, where a parabola does not.
pub(super) fn may_dip([before, one, other, after]: [f64; 4]) -> bool {
    let (fall, rise) = (before - one, after - other);
    fall * one > 0.0 && rise * one > 0.0 && (one * rise + other * fall).abs() < fall * rise
}

/// The values at the ends of an interval between eight places, and one place before and after it; beyond the first
/// and the last place, those of a parabola.
pub(super) fn around(values: &[f64; 8], interval: usize) -> [f64; 4] {
    let beyond = |first: f64, second: f64, third: f64| 3.0 * (first - second) + third;
    let before = match interval {
        0 => beyond(values[0], values[1], values[2]),
        _ => values[interval - 1],
    };
    let after = match interval {
        6 => beyond(values[7], values[6], values[5]),
        _ => values[interval + 2],
    };
    [before, values[interval], values[interval + 1], after]
}

/// The factor by which values may go farther than a parabola, in what it falls by and in what it bends by: found by
/// limbs of balls that dip below a horizon.
const FARTHER: f64 = 1.5;
const BENT: f64 = 0.1;

/// Whether the parabola through three values of one sign comes near zero between the first two.
#[inline(always)]
fn comes_near(first: f64, second: f64, third: f64) -> bool {
    let (bend, rise) = (first - 2.0 * second + third, third - first);
    // All of it without branches: none of them could be foretold.
    (bend * second > 0.0)
        & (rise * bend > 0.0)
        & (rise.abs() < 2.0 * bend.abs())
        & (first * second > 0.0)
        & (second * third > 0.0)
        & ((second * bend).abs() < (rise * rise * FARTHER + bend * bend * BENT) * 0.125)
}

/// The intervals between eight places in which a function with these values may vanish though it has one sign at
/// their ends: those inside by [`may_dip`], the first and the last one where a parabola comes near zero.
#[inline(always)]
pub(super) fn dips<S: Simd>(values: f64x8<S>) -> u64 {
    const INNER: u64 = 0x3e;
    // Slides go around: lanes that see both ends are left out.
    let before = values.slide::<7>(values);
    let other = values.slide::<1>(values);
    let after = values.slide::<2>(values);
    let (fall, rise) = (before - values, after - other);
    let is_low = (values * rise + other * fall).abs().simd_lt(fall * rise);
    let goes_down = (fall * values).simd_gt(0.0) & (rise * values).simd_gt(0.0);
    let inside = goes_down & is_low & (values * other).simd_gt(0.0);
    let first = u64::from(comes_near(values[0], values[1], values[2]));
    let last = u64::from(comes_near(values[7], values[6], values[5]));
    inside.to_bitmask() & INNER | first | last << 6
}

#[cfg(test)]
mod tests;
