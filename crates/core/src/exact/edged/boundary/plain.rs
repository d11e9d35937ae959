//! n·l summed up along chords, by a rule whose error is known beforehand.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;
use glam::DVec3;

use super::chord::Chord;
use super::primitive::{Lines, NEGLIGIBLE, RULES, Sender, Summed, greatest};
use crate::numeric::vectors::Vectors;

/// What the rules are off by for n·l on a way of the parameter that is 1 long, wherever it lies: the
/// largest that a test finds, made larger. It falls with the power of the way that is twice the nodes and
/// one.
const OFF: [f64; 4] = [2e-2, 2e-3, 1.6e-5, 1e-7];

impl Sender<'_, '_> {
    /// The light of a surface that is n·l and nothing else, of a sphere that the eye is far from.
    #[inline(always)]
    pub(super) fn plain<S: Simd>(&self, simd: S, chord: &Chord<S>, lines: &Lines<S>) -> Summed<S> {
        let negligible = NEGLIGIBLE * self.tolerance;
        let brightest = self.finish.brightest(self.scene, lines.lights);
        let way_sq = chord.way_sq();
        // The power of the way that is twice the nodes, less one: the size holds its square.
        let mut power = chord.size_of_way() * way_sq * way_sq * brightest;
        let mut index = 0;
        while greatest(power) * OFF[index] > negligible && index + 1 < RULES.len() {
            let last = RULES[index].len();
            index += 1;
            for _ in last..RULES[index].len() {
                power *= way_sq;
            }
        }
        let normals = self.normals(simd, chord, lines, RULES[index]);

        // The sum over the lights is one over vectors, once for each channel.
        let mut light = [f64x8::splat(simd, 0.0); 3];
        for (channel, sum) in light.iter_mut().enumerate().take(self.scene.channels) {
            let mut toward = DVec3::ZERO;
            for (index, light) in self.scene.lights.iter().enumerate() {
                if lines.lights >> index & 1 == 1 {
                    toward += light.toward * light.intensity[channel];
                }
            }
            *sum = normals.dot_one(toward * self.finish.reflectance.albedo[channel]);
        }
        Summed {
            light,
            doubt: power * OFF[index],
            samples: 8 * RULES[index].len() as u64,
            unevenness: 0.0,
        }
    }

    /// Normals summed up along chords.
    ///
    /// With the ray times the denominator of a chord's parameter as R, w its root times the denominator,
    /// c and r the sphere's center and radius, the normal is (R × (R × c) − R w) / (R² r).
    #[inline(never)]
    fn normals<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        rule: &[(f64, f64)],
    ) -> Vectors<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let ball = &self.active.ball;
                let center = Vectors::splat(simd, ball.center);
                let [width, height] = self.cell.size;
                let upward = lines.y * height + self.cell.middle.y;
                let mut sum = Vectors::splat(simd, DVec3::ZERO);
                for (node, weight) in rule {
                    let at = chord.homogeneous(2.0 * node - 1.0);
                    let ray = Vectors {
                        x: at.x * width + at.denominator * self.cell.middle.x,
                        y: at.denominator * upward,
                        z: at.denominator,
                    };
                    let foot = ray.cross(&ray.cross(&center));
                    let normal = foot.minus(&ray.times(at.root));
                    let below = at.denominator * at.denominator * ray.length_squared();
                    let share = at.slope * (2.0 * weight) / (below * ball.radius);
                    sum = sum.plus(&normal.times(share));
                }
                sum
            },
        )
    }
}

#[cfg(test)]
mod tests;
