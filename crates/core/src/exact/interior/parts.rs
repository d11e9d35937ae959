//! Pixels that one rough sphere fills, in parts.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::facings::Facings;
use super::samples::{GAUSS_SAMPLES, POINTS, STAR_SAMPLES};
use super::smooth::{Filled, Stage};
use crate::exact::points::Points;
use crate::exact::scene::{InCamera, MOST_LIGHTS};
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::vectors::Vectors;

/// How far normals turn from the middle of a part to its corners, over how far they do in its pixel:
/// parts are a half by a quarter, quarters where the surface recedes; and a little more, as it does
/// not recede evenly.
pub(crate) const SIZE_OF_PARTS: f64 = 0.45;

/// Samples that the parts of a pixel take.
pub(crate) const SAMPLES_OF_PARTS: u64 = 8 * STAR_SAMPLES as u64;

/// The average over one of the pixels, by the averages over eight parts of it, and its error.
///
/// # Accuracy
/// An estimate, as that of the parts. Terminators of bumps cost little in parts which are as small.
#[inline(never)]
pub(crate) fn in_parts<S: Simd>(
    simd: S,
    scene: &InCamera<'_>,
    filled: &Filled<'_, S>,
    lane: usize,
    noise: &mut Option<Box<NoiseCells>>,
) -> Option<(Color, f64)> {
    simd.vectorize(
        #[inline(always)]
        || {
            let zero = f64x8::splat(simd, 0.0);
            let mut middle = Vectors {
                x: zero + filled.middle.x[lane],
                y: zero + filled.middle.y[lane],
                z: zero + filled.middle.z[lane],
            };
            let normal = Points::new(simd, filled.ball, middle).normal;
            // The surface recedes the way that its normal leans.
            let is_wide = normal.x[0].abs() > normal.y[0].abs();
            // Halves along one axis, quarters along the other.
            let half: f64x8<S> =
                [-0.25, 0.25, -0.25, 0.25, -0.25, 0.25, -0.25, 0.25].simd_into(simd);
            let quarter: f64x8<S> =
                [-0.375, -0.375, -0.125, -0.125, 0.125, 0.125, 0.375, 0.375].simd_into(simd);
            let [u, v] = if is_wide {
                [quarter, half]
            } else {
                [half, quarter]
            };
            middle.x += u * filled.size[0];
            middle.y += v * filled.size[1];
            let [width, height] = filled.size;
            let mut lit = [0; MOST_LIGHTS];
            for (of_parts, of_pixels) in lit.iter_mut().zip(filled.lit) {
                if of_pixels >> lane & 1 == 1 {
                    *of_parts = 0xff;
                }
            }
            let parts = Filled {
                middle,
                size: if is_wide {
                    [0.25 * width, 0.5 * height]
                } else {
                    [0.5 * width, 0.25 * height]
                },
                lit: &lit,
                turn: zero + filled.turn[lane] * SIZE_OF_PARTS,
                pace: zero + filled.pace[lane] * SIZE_OF_PARTS,
                which: 0xff,
                ..*filled
            };
            let mut facings = Facings::new(simd);
            let mut lights = [[zero; 3]; GAUSS_SAMPLES];
            let mut sum = [zero; 3];
            let of_star = parts.light::<STAR_SAMPLES>(simd, scene, 0, &mut facings, noise);
            lights[..STAR_SAMPLES].copy_from_slice(&of_star);
            for (light, sample) in of_star.iter().zip(&POINTS) {
                for channel in 0..scene.channels {
                    sum[channel] += light[channel] * sample.star;
                }
            }
            let calm = parts.calm(simd, scene, &lights, Stage::Star, &facings);
            if calm.is_known.to_bitmask() != 0xff {
                return None;
            }
            let mut value = Color::ZERO;
            for channel in 0..scene.channels {
                value[channel] = mean(&sum[channel].into());
            }
            Some((value, mean(&calm.error.into())))
        },
    )
}

/// The mean of the parts.
fn mean(of: &[f64; 8]) -> f64 {
    let mut sum = 0.0;
    for part in of {
        sum += part;
    }
    0.125 * sum
}
