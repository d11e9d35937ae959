//! The intersections of rays and spheres: every decision exact, every distance to the last place.
//!
//! With o the ray's origin, d its direction, c the center, r the radius and f = c − o, the ray
//! meets the sphere where A t² − 2 B t + K = 0 with
//!
//! > A = d·d,  B = d·f,  K = f·f − r²,  Q = B² − A K = A r² − |d × f|².
//!
//! K < 0 inside. From outside (K > 0) the ray hits where B > 0 and Q ≥ 0, at t = K / (B + √Q);
//! from inside always, at the far root; from the surface (K = 0) where B > 0, at t = 2 B / A.
//!
//! Three floors answer. [`fast`] knows bounds of its rounding errors and answers wherever they
//! decide; [`double`] does the same with twice the digits; [`exact`] computes with integers and
//! always answers.

pub(crate) mod ball;
pub(crate) mod components;
pub(crate) mod crossings;
mod double;
mod exact;
pub(crate) mod fast;
pub(crate) mod floors;
pub(crate) mod nearest;
pub(crate) mod outcome;
mod scaled;

#[cfg(test)]
mod tests;
