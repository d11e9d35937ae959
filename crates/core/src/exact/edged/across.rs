//! The integral across lines, from what is along them.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::rule::{NODES, Rule, error_estimate};

/// What is known of lines of a piece beside each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Across {
    pub(crate) likeness: Likeness,
    /// What may be missed beside and between them.
    pub(crate) least_error: f64,
}

impl Across {
    pub(crate) const SMOOTH: Self = Self {
        likeness: Likeness::Smooth,
        least_error: 0.0,
    };
}

/// How lines of a piece go over into each other, the worst first.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub(crate) enum Likeness {
    /// On some of them light jumps in other bumps than on others.
    Jumpy,
    /// Some of them have other terminators of bumps than others.
    Uneven,
    /// The noise has no third derivative where its cells meet.
    Rough,
    Smooth,
}

/// The integral over lines with these integrals, and an estimate of its error.
#[inline(always)]
pub(crate) fn across<S: Simd>(rule: &Rule, of: &f64x8<S>, likeness: Likeness) -> (f64, f64) {
    let (mut fine, mut coarse) = (0.0, 0.0);
    for index in 0..NODES {
        fine += rule.fine[index] * of[index];
        coarse += rule.coarse[index] * of[index];
    }
    let mut spread = 0.0;
    for index in 0..NODES {
        spread += rule.fine[index] * (of[index] - fine).abs();
    }
    let difference = (fine - coarse).abs();
    // A jump between two lines may cost half of their weight.
    let error = match likeness {
        Likeness::Smooth => error_estimate(difference, spread),
        Likeness::Rough => difference,
        Likeness::Uneven => difference.max(0.02 * spread),
        Likeness::Jumpy => difference.max(0.2 * spread),
    };
    (fine, error)
}
