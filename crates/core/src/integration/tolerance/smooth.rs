//! Pixels that one sphere fills, eight at a time.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::cut::MOST_LIGHTS;
use super::scene::InCamera;
use super::surface::{Facings, Finish, Points};
use crate::edges::{Ball, Vectors};
use crate::roughness::NoiseCells;
use crate::{Color, Radiance};

/// Gauss's rules with one, two and three points on −½ to ½: nodes and weights.
const ONE: [(f64, f64); 1] = [(0.0, 1.0)];
const TWO: [(f64, f64); 2] = [
    (-0.288_675_134_594_812_9, 0.5),
    (0.288_675_134_594_812_9, 0.5),
];
const THREE: [(f64, f64); 3] = [
    (-0.387_298_334_620_741_7, 5.0 / 18.0),
    (0.0, 4.0 / 9.0),
    (0.387_298_334_620_741_7, 5.0 / 18.0),
];

/// Samples that a pixel takes.
pub(super) const SAMPLES: u64 = 14;

/// Light of eight pixels, and its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Smooth {
    pub(super) values: [Color; 8],
    pub(super) errors: [f64; 8],
}

/// The averages over pixels whose middles are the rays `middle` and whose sides are `size` long.
///
/// # Accuracy
/// An estimate. The errors of the rules with 1, 2 and 3 points a side form a geometric sequence
/// where light is analytic, so that the last is as much smaller than the second as that is smaller
/// than the first. A rough surface has terminators inside its bumps: there the difference of the
/// last two rules stands as it is.
#[inline(always)]
#[expect(
    clippy::too_many_arguments,
    reason = "all of it is at hand where it is called"
)]
pub(super) fn smooth<S: Simd, C: Radiance>(
    simd: S,
    scene: &InCamera<'_>,
    ball: &Ball,
    finish: &Finish<'_>,
    middle: &Vectors<S>,
    size: f64,
    lit: &[u64; MOST_LIGHTS],
    noise: &mut Option<Box<NoiseCells>>,
) -> Smooth {
    let zero = f64x8::splat(simd, 0.0);
    let is_rough = finish.is_rough();
    let mut facings = Facings::new(simd);
    let mut averages = [[zero; 3]; 3];
    let rules: [&[(f64, f64)]; 3] = [&ONE, &TWO, &THREE];
    for (average, rule) in averages.iter_mut().zip(rules) {
        for &(v, across) in rule {
            for &(u, along) in rule {
                let mut ray = *middle;
                ray.x += u * size;
                ray.y += v * size;
                let points = Points::new(simd, ball, ray);
                let light = finish.radiance::<S, C>(
                    simd,
                    scene,
                    &points,
                    lit,
                    noise,
                    is_rough.then_some(&mut facings),
                );
                for channel in 0..C::CHANNELS {
                    average[channel] += light[channel] * (along * across);
                }
            }
        }
    }
    let [one, two, three] = averages;
    let mut error = zero;
    let mut result = Smooth {
        values: [Color::ZERO; 8],
        errors: [0.0; 8],
    };
    let undecided = if is_rough {
        facings.undecided(scene.lights.len(), lit)
    } else {
        0
    };
    let undecided = mask64x8::from_bitmask(simd, undecided);
    for channel in 0..C::CHANNELS {
        let first = (two[channel] - one[channel]).abs();
        let second = (three[channel] - two[channel]).abs();
        let estimate = if is_rough {
            let rough = second * 3.0 + first * 0.01;
            undecided.select(rough + first, rough)
        } else {
            const CAUTION: f64 = 4.0;
            let ratio = second * CAUTION / (first + f64::MIN_POSITIVE);
            second * 4.0 * ratio.min(f64x8::splat(simd, 1.0))
        };
        // Where a number is not finite, the estimate tells.
        error = error.max(estimate + three[channel].abs() * 1e-15);
        for (value, average) in result.values.iter_mut().zip(three[channel].iter()) {
            value[channel] = *average;
        }
    }
    for lane in 0..8 {
        result.errors[lane] = error[lane];
    }
    result
}
