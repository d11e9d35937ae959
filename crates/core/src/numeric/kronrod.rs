//! Kronrod's rule with seven points on −1 to 1, in which Gauss's with three is.
//!
//! # Source
//! Kronrod, Nodes and Weights of Quadrature Formulas, 1965.

pub(crate) const POINTS: usize = 7;

pub(crate) const ABSCISSAS: [f64; POINTS] = [
    -0.960_491_268_708_020_3,
    -0.774_596_669_241_483_4,
    -0.434_243_749_346_802_6,
    0.0,
    0.434_243_749_346_802_6,
    0.774_596_669_241_483_4,
    0.960_491_268_708_020_3,
];

pub(crate) const WEIGHTS: [f64; POINTS] = [
    0.104_656_226_026_467_3,
    0.268_488_089_868_333_4,
    0.401_397_414_775_962_2,
    0.450_916_538_658_474_1,
    0.401_397_414_775_962_2,
    0.268_488_089_868_333_4,
    0.104_656_226_026_467_3,
];
