//! Pixels that one rough sphere fills, in parts.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::estimate::Rule;
use super::filled::{Filled, SIZE_OF_PARTS};
use super::light_cosines::LightCosines;
use super::samples::{GAUSS_SAMPLES, POINTS, STAR_SAMPLES};
use crate::exact::points::Points;
use crate::exact::scene::MOST_LIGHTS;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::vectors::Vectors;

/// All eight parts, bit by bit.
const ALL: u64 = 0xff;

impl<S: Simd> Filled<'_, S> {
    /// The average over one of the pixels, by the averages over eight parts of it, and its error.
    ///
    /// # Accuracy
    /// An estimate, as that of the parts. Terminators of bumps cost little in parts which are as small.
    #[inline(never)]
    pub(super) fn in_parts(
        &self,
        simd: S,
        lane: usize,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Option<(Color, f64)> {
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let mut lit = [0; MOST_LIGHTS];
                for (of_parts, of_pixels) in lit.iter_mut().zip(self.lit) {
                    if of_pixels >> lane & 1 == 1 {
                        *of_parts = ALL;
                    }
                }
                let (middle, size) = self.places_of_parts(simd, lane);
                let parts = Filled {
                    middle,
                    size,
                    lit: &lit,
                    turn: zero + self.turn[lane] * SIZE_OF_PARTS,
                    nearness: zero + self.nearness[lane] * SIZE_OF_PARTS,
                    which: ALL,
                    ..*self
                };
                let mut cosines = LightCosines::new(simd);
                let mut lights = [[zero; 3]; GAUSS_SAMPLES];
                parts.light(simd, 0, &mut cosines, noise, &mut lights[..STAR_SAMPLES]);
                let estimate = parts.estimate(simd, Rule::Star, &lights, &cosines);
                if estimate.is_known.to_bitmask() != ALL {
                    return None;
                }
                let mut value = Color::ZERO;
                for channel in 0..self.scene.channels {
                    let mut sum = zero;
                    for (light, sample) in lights.iter().zip(&POINTS[..STAR_SAMPLES]) {
                        sum += light[channel] * sample.star;
                    }
                    value[channel] = mean(&sum.into());
                }
                Some((value, mean(&estimate.error.into())))
            },
        )
    }

    /// The rays through the middles of the parts of one of the pixels, and their sides: halves along one
    /// axis, quarters along the one along which the surface recedes, the way that its normal leans.
    #[inline(always)]
    fn places_of_parts(&self, simd: S, lane: usize) -> (Vectors<S>, [f64; 2]) {
        const HALVES: [f64; 8] = [-0.25, 0.25, -0.25, 0.25, -0.25, 0.25, -0.25, 0.25];
        const QUARTERS: [f64; 8] = [-0.375, -0.375, -0.125, -0.125, 0.125, 0.125, 0.375, 0.375];
        let mut middle = Vectors {
            x: f64x8::splat(simd, self.middle.x[lane]),
            y: f64x8::splat(simd, self.middle.y[lane]),
            z: f64x8::splat(simd, self.middle.z[lane]),
        };
        let normal = Points::new(simd, self.ball, middle).normal;
        let halves: f64x8<S> = HALVES.simd_into(simd);
        let quarters: f64x8<S> = QUARTERS.simd_into(simd);
        let [width, height] = self.size;
        let (u, v, size);
        if normal.x[0].abs() > normal.y[0].abs() {
            (u, v, size) = (quarters, halves, [0.25 * width, 0.5 * height]);
        } else {
            (u, v, size) = (halves, quarters, [0.5 * width, 0.25 * height]);
        }
        middle.x += u * width;
        middle.y += v * height;
        (middle, size)
    }
}

/// The mean of the parts.
fn mean(of: &[f64; 8]) -> f64 {
    let mut sum = 0.0;
    for part in of {
        sum += part;
    }
    0.125 * sum
}
