//! Tests of `light_cosines.rs`.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::exact::interior::samples::POINTS;
use crate::numeric::lanes::f64x8;

/// Parabolas along both diagonals are followed to the corners.
#[test]
fn parabolas_lead_to_corners() {
    let cosine = |u: f64, v: f64| 0.1 + 0.7 * u - 0.4 * v + 0.9 * u * u + 0.3 * u * v;
    let [lowest, highest] = dispatch!(Level::new(), simd => {
        let mut cosines = LightCosines::new(simd);
        for sample in &POINTS[..STAR_SAMPLES] {
            cosines.add(0, f64x8::splat(simd, cosine(sample.u, sample.v)));
            cosines.taken += 1;
        }
        let range = cosines.with_corners(0);
        [range.lowest[3], range.highest[5]]
    });
    let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)];
    let corners = corners.map(|(u, v)| cosine(u, v));
    let above = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let below = corners.into_iter().fold(cosine(0.0, 0.0), f64::min);
    assert!(
        (highest - above).abs() < 1e-15,
        "{highest} instead of {above}"
    );
    assert!(
        (lowest - below).abs() < 1e-15,
        "{lowest} instead of {below}"
    );
}
