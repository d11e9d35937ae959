//! Rules for light that begins with a power.

use crate::numeric::jacobi::JacobiRule;

/// The rules for a power.
#[derive(Clone, Copy, Debug)]
pub(super) struct PowerRules {
    exponent: f64,
    pub(super) fine: JacobiRule<8>,
    pub(super) coarse: JacobiRule<6>,
}

impl PowerRules {
    pub(super) const ZERO: Self = Self {
        exponent: 0.0,
        fine: JacobiRule::ZERO,
        coarse: JacobiRule::ZERO,
    };

    /// The rules for an exponent, from among those known so far.
    pub(super) fn of(exponent: f64, known: &mut Vec<Self>) -> Self {
        if let Some(rules) = known.iter().find(|rules| rules.exponent == exponent) {
            return *rules;
        }
        let rules = Self {
            exponent,
            fine: JacobiRule::new(exponent),
            coarse: JacobiRule::new(exponent),
        };
        known.push(rules);
        rules
    }
}
