//! The integral over a strip of a cell from five lines across it.

use crate::model::color::Color;

/// A line of a strip: its place from 0 to 1, and its weight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RuleNode {
    pub(crate) place: f64,
    pub(crate) weight: f64,
}

const fn node(place: f64, weight: f64) -> RuleNode {
    RuleNode { place, weight }
}

/// Kronrod's rule with 5 nodes, which contains Gauss's with 2.
pub(crate) const RULE: [RuleNode; 5] = [
    node(0.037_089_950_113_724_27, 0.098_989_898_989_898_99),
    node(0.211_324_865_405_187_1, 0.245_454_545_454_545_45),
    node(0.5, 0.311_111_111_111_111_1),
    node(0.788_675_134_594_812_9, 0.245_454_545_454_545_45),
    node(0.962_910_049_886_275_7, 0.098_989_898_989_898_99),
];

/// What Kronrod's rule differs by from Gauss's, for values at its nodes, or would differ by if that were not by chance.
///
/// The difference is a sum that vanishes for cubic polynomials. Of narrow dips of light it may be small, too: three more
/// sums, as long, and at right angles to it, vanish for polynomials of degree 0, 1 and 2. Where light is smooth they are in a
/// geometric series, and so the one before tells how large the last one should be.
///
/// It is an estimate. Dips narrower than 0.15 of the strip may still fall between the lines: the doubts of cells tell of what
/// makes them.
///
/// Source: Berntsen and Espelid, Error estimation in automatic quadrature routines (1991).
pub(crate) fn doubt_of_rule(values: &[Color; 5]) -> Color {
    let [first, second, third, fourth, fifth] = *values;
    let (outer, inner) = (fifth - first, fourth - second);
    let first_order = (outer * 0.297_575_140_405_457_6 + inner * 0.185_570_703_703_062_2).abs();
    let third_order = (outer * 0.185_570_703_703_062_2 - inner * 0.297_575_140_405_457_6).abs();
    let (outer, inner) = (fifth + first, fourth + second);
    let second_order =
        ((outer * 8.0 - inner * 3.0 - third * 10.0) * 0.031_621_163_318_178_85).abs();
    let difference = (outer * 0.098_989_898_989_898_99 - inner * 0.254_545_454_545_454_5
        + third * 0.311_111_111_111_111_1)
        .abs();
    let expected = |[first, second, third]: [f64; 3]| {
        let ratio = (third / second).min((third / first).sqrt()).min(1.0);
        third * ratio
    };
    let expected = Color::new(
        expected([first_order.x, second_order.x, third_order.x]),
        expected([first_order.y, second_order.y, third_order.y]),
        expected([first_order.z, second_order.z, third_order.z]),
    );
    difference.max(expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the rule makes of a function on (0, 1), and what that may be off by.
    fn integral(function: impl Fn(f64) -> f64) -> (f64, f64) {
        let values = RULE
            .each_ref()
            .map(|node| Color::splat(function(node.place)));
        let weighted = RULE
            .iter()
            .zip(&values)
            .map(|(node, value)| value.x * node.weight);
        (weighted.sum(), doubt_of_rule(&values).x)
    }

    #[test]
    fn dips_are_not_missed_by_chance() {
        for width in [0.15, 0.2, 0.3, 0.5, 1.0] {
            for place in -20..=120 {
                let middle = f64::from(place) / 100.0;
                let scaled = |x: f64| (x - middle) / width;
                let (found, doubt) = integral(|x| libm::exp(-scaled(x).powi(2)));
                let part = libm::erf(scaled(1.0)) - libm::erf(scaled(0.0));
                let exact = 0.5 * std::f64::consts::PI.sqrt() * width * part;
                let error = (found - exact).abs();
                assert!(
                    error <= doubt,
                    "{middle}, {width}: off by {error}, doubt {doubt}"
                );
            }
        }
    }

    #[test]
    fn polynomials_are_not_in_doubt() {
        for degree in 0..=2 {
            let (found, doubt) = integral(|x| (x - 0.3).powi(degree));
            let power = degree + 1;
            let exact = (0.7_f64.powi(power) - (-0.3_f64).powi(power)) / f64::from(power);
            assert!(
                (found - exact).abs() < 1e-15 && doubt < 1e-15,
                "{degree}: {doubt}"
            );
        }
    }
}
