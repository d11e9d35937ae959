//! Cells that one rough sphere fills, with bumps far smaller than the cell, by random samples.

use fearless_simd::Simd;

use super::filled::Filled;
use super::parts::Average;
use crate::exact::points::Points;
use crate::model::color::Color;
use crate::model::roughness::noise::{NoiseCells, hash, spread};
use crate::numeric::bernstein::error_of_mean;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

impl<S: Simd> Filled<'_, S> {
    /// The average over one of the cells, by two random samples in each of `side` × `side` strata, a multiple
    /// of 2.
    ///
    /// # Accuracy
    /// An estimate that holds with a probability, as [`error_of_mean`] tells: the samples are independent, and light
    /// lies between those of the dark and of all lights at their brightest. Random places have nothing in common
    /// with a lattice of bumps; they depend on the cell's own place alone.
    #[inline(never)]
    pub(crate) fn by_strata(
        &self,
        simd: S,
        lane: usize,
        side: u32,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Average {
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let lit = self.lit_in_parts(lane);
                let mut place = [self.middle.x[lane], self.middle.y[lane]];
                if self.ball.is_parallel() {
                    // In sides, so that it has no unit of length.
                    place = [place[0] / self.size[0], place[1] / self.size[1]];
                }
                let key = hash(place[0].to_bits(), place[1].to_bits());
                let step = 1.0 / f64::from(side);
                let mut value = Color::ZERO;
                let mut squares = Color::ZERO;
                // Four strata at a time, two by two: bumps may be alike in them.
                for row in (0..side).step_by(2) {
                    for col in (0..side).step_by(2) {
                        let (mut u, mut v) = ([0.0; 8], [0.0; 8]);
                        for index in 0..8_u32 {
                            let stratum = [col + (index & 1), row + (index >> 1 & 1)];
                            let name = u64::from(stratum[0]) << 32 | u64::from(stratum[1]) << 1;
                            let [x, y, _] = spread(hash(key, name | u64::from(index >> 2)));
                            let place = |stratum: u32, offset: f64| {
                                (f64::from(stratum) + 0.5 + 0.5 * offset) * step - 0.5
                            };
                            u[index as usize] = place(stratum[0], x);
                            v[index as usize] = place(stratum[1], y);
                        }
                        let (u, v): (f64x8<S>, f64x8<S>) =
                            (f64x8::from_array(simd, u), f64x8::from_array(simd, v));
                        let ray = Vectors {
                            x: u * self.size[0] + self.middle.x[lane],
                            y: v * self.size[1] + self.middle.y[lane],
                            z: zero + self.middle.z[lane],
                        };
                        let points = Points::new(simd, self.ball, ray);
                        let mut normals = [points.normal];
                        self.finish.perturb(simd, self.scene, &mut normals, noise);
                        let light = self.finish.radiance(
                            simd,
                            self.scene,
                            &points,
                            &normals[0],
                            &lit,
                            None,
                        );
                        for channel in 0..self.scene.channels {
                            let light: [f64; 8] = light[channel].into();
                            for stratum in 0..4 {
                                let (one, other) = (light[stratum], light[stratum + 4]);
                                value[channel] += one + other;
                                squares[channel] += (one - other) * (one - other);
                            }
                        }
                    }
                }
                let count = 2.0 * f64::from(side) * f64::from(side);
                let range = self.range_of_light();
                let error = error_of_mean(squares.max_element(), range, count);
                Average {
                    value: value / count,
                    error: error.min(range),
                    samples: count as u64,
                    is_random: true,
                }
            },
        )
    }
}
