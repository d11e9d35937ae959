//! Rules of integration on 0 to 1.

use crate::numeric::kronrod::{self, ABSCISSAS, WEIGHTS};

/// Nodes of the rule.
pub(crate) const NODES: usize = kronrod::POINTS;

/// The node in the middle.
pub(crate) const MIDDLE: usize = NODES / 2;

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
    /// No rule of integration: zero for polynomials of degree 4, as large as the difference of both rules, and
    /// blind for what is even around the middle, as that is for what is odd.
    pub(crate) odd: [f64; 8],
}

/// The numbers that are orthogonal to x and x³ at the nodes.
const ODD: [f64; 8] = [
    0.099_208_631_529_814_46,
    -0.219_457_571_231_079_12,
    0.172_027_989_954_788_55,
    0.0,
    -0.172_027_989_954_788_55,
    0.219_457_571_231_079_12,
    -0.099_208_631_529_814_46,
    0.0,
];

/// The rule.
pub(crate) static RULE: Rule = {
    const GAUSS: [f64; 7] = [0.0, 5.0 / 9.0, 0.0, 8.0 / 9.0, 0.0, 5.0 / 9.0, 0.0];
    let mut rule = Rule {
        nodes: [0.0; 8],
        fine: [0.0; 8],
        coarse: [0.0; 8],
        odd: ODD,
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

/// The share of [`Rule::odd`] that counts. The odd parts of integrands are a few times as large as the even ones of
/// the next degree; chosen by `cargo truth hunt`, which finds no broken pixel from 0.05 on.
pub(crate) const OF_ODD: f64 = 0.1;

/// A measure of the distance of an integrand from those that both rules integrate alike: the difference of the rules, and a
/// share of the sum that is blind where that is not. A difference alone vanishes by chance in one integral of
/// some hundred thousand, and its power with it; both together do not.
pub(crate) fn doubt(difference: f64, odd: f64) -> f64 {
    let odd = OF_ODD * odd;
    (difference * difference + odd * odd).sqrt()
}

/// The factor on the difference of the rules, before its power is taken.
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
