//! Integrals along parts of curves.

use glam::DVec2;

use super::candidate::Candidate;
use super::curve::Curve;
use super::rectangle::{Along, Light, Lit};

/// Gauss's rule with 3 nodes from −1 to 1: nodes, their weights, and those in Kronrod's with 7.
const GAUSS: [[f64; 3]; 3] = [
    [-0.774_596_669_241_483_4, 5.0 / 9.0, 0.268_488_089_868_333_4],
    [0.0, 8.0 / 9.0, 0.450_916_538_658_474_14],
    [0.774_596_669_241_483_4, 5.0 / 9.0, 0.268_488_089_868_333_4],
];

/// The other nodes of Kronrod's rule.
const KRONROD: [[f64; 2]; 4] = [
    [-0.960_491_268_708_020_3, 0.104_656_226_026_467_27],
    [-0.434_243_749_346_802_6, 0.401_397_414_775_962_2],
    [0.434_243_749_346_802_6, 0.401_397_414_775_962_2],
    [0.960_491_268_708_020_3, 0.104_656_226_026_467_27],
];

/// The claim of a part of a curve, in parts of the second difference of its nodes. Not tuned.
const OF_BEND: f64 = 0.06;

/// The integral along all of a curve of light that has no breaks. Where light is not known, anything up to the brightest is
/// claimed.
pub(crate) fn whole_integral(
    light: &mut dyn Light,
    candidate: &Candidate,
    curve: &Curve,
    limit: f64,
) -> Along {
    let missed = Lit {
        error: light.brightest(),
        ..Lit::default()
    };
    let mut along = Along::default();
    integral_along(curve, [0.0, 1.0], limit, &mut along, &mut |place| {
        light.at(candidate, place).unwrap_or(missed)
    });
    along
}

/// Adds the integral of light along a part of a curve, and its claim; the limit is for the claim in parts of the length.
pub(crate) fn integral_along(
    curve: &Curve,
    ends: [f64; 2],
    limit: f64,
    along: &mut Along,
    light: &mut dyn FnMut(DVec2) -> Lit,
) {
    let length = ends[1] - ends[0];
    let at = |node: f64| ends[0] + length * (0.5 + 0.5 * node);
    let weight = |node: f64, weight: f64| 0.5 * weight * length * curve.along.at(at(node)).1;
    let of_nodes = GAUSS.map(|[node, ..]| light(curve.at(at(node))));
    let nodes = || GAUSS.iter().zip(of_nodes);
    let mut rough = Lit::default();
    for ([node, of_gauss, _], lit) in nodes() {
        rough.add(lit, weight(*node, *of_gauss));
    }
    let bend = of_nodes[0].light - 2.0 * of_nodes[1].light + of_nodes[2].light;
    let bend = bend.abs().max_element() * OF_BEND;
    let part = curve.along.at(ends[1]).0 - curve.along.at(ends[0]).0;
    if bend <= limit {
        along.integral += rough.light;
        along.error += bend * part + rough.error;
        return;
    }
    let mut fine = Lit::default();
    for ([node, _, of_kronrod], lit) in nodes() {
        fine.add(lit, weight(*node, *of_kronrod));
    }
    for [node, of_kronrod] in KRONROD {
        fine.add(light(curve.at(at(node))), weight(node, of_kronrod));
    }
    along.integral += fine.light;
    along.error += (fine.light - rough.light).abs().max_element() + fine.error;
}
