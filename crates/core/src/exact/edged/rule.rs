//! Rules of integration on 0 to 1.

use crate::numeric::kronrod::{self, ABSCISSAS, WEIGHTS};

/// Nodes of the rule.
pub(crate) const NODES: usize = kronrod::POINTS;

/// Nodes on 0 to 1 with the weights of Kronrod's rule and of Gauss's with three points, which is
/// held against it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rule {
    /// In the order of the nodes, the last one twice: eight can be computed at a time.
    pub(crate) nodes: [f64; 8],
    /// Kronrod's; the eighth is zero.
    pub(crate) fine: [f64; 8],
    /// Gauss's.
    pub(crate) coarse: [f64; 8],
}

/// The rule.
pub(crate) static RULE: Rule = {
    const GAUSS: [f64; 7] = [0.0, 5.0 / 9.0, 0.0, 8.0 / 9.0, 0.0, 5.0 / 9.0, 0.0];
    let mut rule = Rule {
        nodes: [0.0; 8],
        fine: [0.0; 8],
        coarse: [0.0; 8],
    };
    let mut index = 0;
    while index < NODES {
        rule.nodes[index] = 0.5 + 0.5 * ABSCISSAS[index];
        rule.fine[index] = 0.5 * WEIGHTS[index];
        rule.coarse[index] = 0.5 * GAUSS[index];
        index += 1;
    }
    rule.nodes[7] = rule.nodes[6];
    rule
};
/// How much larger than its power the difference of the rules is taken to be.
pub(crate) const CAUTION: f64 = 2.0;

/// An estimate of the error of Kronrod's rule, by its difference to Gauss's and the integrand's
/// mean distance from its mean.
///
/// For analytic functions the former's relative error is about the square of the latter's, for
/// others less: the power 3/2 is taken.
///
/// # Source
/// Piessens et al., QUADPACK, 1983, with other factors.
pub(crate) fn error_estimate(difference: f64, spread: f64) -> f64 {
    if difference <= 0.0 {
        return 0.0;
    }
    let ratio = (CAUTION * difference / spread).min(1.0);
    let estimate = (spread * ratio * ratio.sqrt()).min(difference);
    // What is not a number is not lost.
    if difference.is_nan() || spread.is_nan() {
        f64::NAN
    } else {
        estimate
    }
}

#[cfg(test)]
mod tests;
