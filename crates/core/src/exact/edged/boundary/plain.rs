//! n·l summed up along chords, by a rule whose error is known beforehand.

use fearless_simd::Simd;
use glam::DVec3;

use super::chord::{Chord, Homogeneous};
use super::primitive::{Lines, NEGLIGIBLE, RULES, Sender, Summed, greatest};
use crate::edges::cell::{Ball, Cell};
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// The errors of the rules for n·l on a way of the parameter that is 1 long, wherever it lies: the
/// largest that a test finds, made larger. It falls with the power of the way that is twice the nodes and
/// one.
const OFF: [f64; 4] = [2e-2, 2e-3, 1.6e-5, 1e-7];

impl Sender<'_, '_> {
    /// Returns whether light is n·l and nothing else, and the error of the rules for it is known.
    pub(super) fn is_plain(&self) -> bool {
        !self.scene.has_near_lights
            && self.finish.is_plain()
            && is_far(self.cell, &self.active.ball)
    }

    /// The light of a surface that is n·l and nothing else, of a sphere that the eye is far from.
    #[inline(always)]
    pub(super) fn plain<S: Simd>(&self, simd: S, chord: &Chord<S>, lines: &Lines<S>) -> Summed<S> {
        let negligible = NEGLIGIBLE * self.tolerance;
        // Normals are no longer than 1 in any direction.
        let brightest = if self.scene.is_of_normals {
            1.0
        } else {
            self.finish.brightest(self.scene, lines.lights)
        };
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
        let normals = normals(
            simd,
            (self.cell, &self.active.ball),
            chord,
            lines.y,
            RULES[index],
        );

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
            ..Summed::nothing(simd)
        }
    }
}

/// Returns whether a sphere is far enough from the eye, and a cell small enough, for what the rules are said
/// to be off by.
fn is_far(cell: &Cell, ball: &Ball) -> bool {
    /// The largest radius, relative to the center's distance. Chosen by the test of the rules, which fails at 0.98.
    const LARGEST: f64 = 0.9;
    /// Sides of a cell, at distance 1.
    const WIDEST: f64 = 0.1;
    if ball.is_parallel() {
        return true;
    }
    let [width, height] = cell.size;
    ball.center.z > ball.radius
        && ball.radius < LARGEST * ball.center.length()
        && width.max(height) < WIDEST
}

/// Normals of a ball summed up along the chords of lines with these y.
///
/// With the ray times the denominator of a chord's parameter as R, the root times the denominator as w, the
/// ball's center c, radius r and K = c·c − r², the normal is (R × (R × c) − R w) / (R² r), or, where that loses
/// nothing, (K R / (R·c + w) − c) / r.
#[inline(never)]
fn normals<S: Simd>(
    simd: S,
    (cell, ball): (&Cell, &Ball),
    chord: &Chord<S>,
    y: f64x8<S>,
    rule: &[(f64, f64)],
) -> Vectors<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let mut sum = Vectors::splat(simd, DVec3::ZERO);
            for (node, weight) in rule {
                let at = chord.homogeneous(2.0 * node - 1.0);
                let ray = ray_times(cell, &at, y);
                let (normal, length, _) = normal_times(simd, ball, &ray, at.root);
                let below = at.denominator * at.denominator * length * ball.radius;
                sum = sum.plus(&normal.times(at.slope * (2.0 * weight) / below));
            }
            sum
        },
    )
}

/// The rays to places of chords on lines with these y, times the denominators of the places.
#[inline(always)]
pub(super) fn ray_times<S: Simd>(cell: &Cell, at: &Homogeneous<S>, y: f64x8<S>) -> Vectors<S> {
    let [width, height] = cell.size;
    let upward = y * height + cell.middle.y;
    Vectors {
        x: at.x * width + at.denominator * cell.middle.x,
        y: at.denominator * upward,
        z: at.denominator,
    }
}

/// The normals of a ball where rays R with the roots w meet it, times its radius and the second numbers that
/// are returned. The third are R·c + w. For parallel rays, which are their places (u, v, 1) times the denominators,
/// normals need no more than these.
#[inline(always)]
pub(super) fn normal_times<S: Simd>(
    simd: S,
    ball: &Ball,
    ray: &Vectors<S>,
    root: f64x8<S>,
) -> (Vectors<S>, f64x8<S>, f64x8<S>) {
    if ball.is_parallel() {
        let from_center = Vectors {
            x: ray.x - ray.z * ball.center.x,
            y: ray.y - ray.z * ball.center.y,
            z: -root,
        };
        return (from_center, ray.z, ray.z);
    }
    let center = Vectors::splat(simd, ball.center);
    let along = ray.dot_one(ball.center) + root;
    if ball.is_apart() {
        let foot = ray.cross(&ray.cross(&center));
        (foot.minus(&ray.times(root)), ray.length_squared(), along)
    } else {
        let place = ray.times(f64x8::splat(simd, ball.outside));
        (place.minus(&center.times(along)), along, along)
    }
}

#[cfg(test)]
mod tests;
