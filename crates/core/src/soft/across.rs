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
