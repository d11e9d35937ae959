//! Numbers: rounding, lanes, powers, polynomials, rules of integration.

pub(crate) mod angle;
pub(crate) mod bernstein;
pub(crate) mod bits;
pub(crate) mod double_double;
pub(crate) mod fused;
pub(crate) mod jacobi;
pub(crate) mod kronrod;
pub(crate) mod lanes;
pub(crate) mod order;
pub(crate) mod pair;
pub(crate) mod polynomial;
pub(crate) mod power;
pub(crate) mod rounding;
pub(crate) mod vectors;
