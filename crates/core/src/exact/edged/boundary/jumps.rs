//! Places on chords where cells of the noise meet: the second derivatives of bumps jump there, and nowhere else.

use fearless_simd::Simd;
use glam::{DMat3, DVec3};

use super::chord::Chord;
use super::plain::{normal_times, ray_times};
use super::primitive::{Lines, Noise, Sender};
use super::turns::Stops;
use crate::edges::cell::{Ball, Cell};
use crate::light::shading_normal::ShadingNormal;
use crate::model::roughness::Bumps;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// Eight chords on a sphere with bumps. At the parameter σ the normal is the quotient of two polynomials of degree 2.
#[derive(Clone, Copy, Debug)]
struct Way<S: Simd> {
    /// Those above the line, in the world's frame, at 1, σ and σ².
    normal: [Vectors<S>; 3],
    /// That below it.
    along: [f64x8<S>; 3],
}

/// A place where a chord passes from one cell to the next along an axis.
#[derive(Clone, Copy, Debug)]
struct Passage {
    lane: usize,
    axis: usize,
    sigma: f64,
}

/// The error of Kronrod's rule for a jump of the second derivative by 1, wherever it lies in an interval of length 1:
/// half of the largest error for the squares of distances on one side of it. The test `rules_miss_no_more_of_jumps`
/// computes it.
const OF_JUMP: f64 = 1e-4;

impl Sender<'_, '_> {
    /// The error of rules on chords that are divided into so many parts because second derivatives of bumps jump there:
    /// nothing where the chords are to be divided there, too, which is noted.
    ///
    /// # Accuracy
    /// An estimate: jumps are those where a chord meets a lattice plane, and the light's slope is a bound; jumps of third
    /// derivatives, which rules miss a twentieth as much of, are left out. Chords that are divided there miss nothing.
    #[inline(never)]
    pub(super) fn jumps<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        parts: usize,
        stops: &mut Stops,
        noise: &mut Noise,
    ) -> f64x8<S> {
        /// The share of the tolerance that jumps may cost before chords are divided at them.
        const MOST: f64 = 0.02;
        simd.vectorize(
            #[inline(always)]
            || {
                let mut missed = [0.0; 8];
                let ShadingNormal::Bumpy(bumps) = &self.finish.shading_normal else {
                    return f64x8::from_array(simd, missed);
                };
                let places = (self.cell, &self.active.ball);
                let frame = &self.scene.world_from_camera;
                let way = Way::new(simd, places, frame, chord, lines.y);
                let mut passages = Vec::new();
                way.passages(bumps, &mut passages);
                if passages.is_empty() {
                    return f64x8::from_array(simd, missed);
                }
                let noise = noise.get_or_insert_with(|| Box::new(NoiseCells::new()));
                let slope = self.finish.steepest(self.scene, lines.lights);
                let parts = parts as f64;
                for passage in &passages {
                    let Passage { lane, axis, sigma } = *passage;
                    let (normal, speed) = way.at(lane, axis, sigma);
                    let side = bumps.offset(normal[axis]).signum();
                    let jump = bumps.jump(normal, (axis, side), noise).length();
                    // The rule's interval is half as long as that of the parameter.
                    let step = 2.0 * speed * bumps.cells() / parts;
                    let (_, width) = chord.at(f64x8::splat(simd, sigma));
                    let width = 2.0 * width[lane].abs() / parts;
                    missed[lane] += OF_JUMP * jump * step * step * width * slope;
                }
                let most = missed.into_iter().fold(0.0, f64::max);
                if most > MOST * self.tolerance {
                    for passage in &passages {
                        stops.note(passage.lane, passage.sigma);
                    }
                    missed = [0.0; 8];
                }
                f64x8::from_array(simd, missed)
            },
        )
    }
}

impl<S: Simd> Way<S> {
    /// That of chords on lines with these y.
    #[inline(always)]
    fn new(
        simd: S,
        (cell, ball): (&Cell, &Ball),
        world_from_camera: &DMat3,
        chord: &Chord<S>,
        y: f64x8<S>,
    ) -> Self {
        let mut normals = [Vectors::splat(simd, DVec3::ZERO); 3];
        let mut alongs = [y * 0.0; 3];
        for (index, sigma) in [-1.0, 0.0, 1.0].into_iter().enumerate() {
            let at = chord.homogeneous(sigma);
            let ray = ray_times(cell, &at, y);
            let (normal, length, along) = normal_times(simd, ball, &ray, at.root);
            let scale = along / (length * ball.radius);
            normals[index] = normal.times(scale).rotated(world_from_camera);
            alongs[index] = along;
        }
        let [first, middle, last] = normals;
        let half = f64x8::splat(simd, 0.5);
        Self {
            normal: [
                middle,
                last.minus(&first).times(half),
                last.plus(&first).times(half).minus(&middle),
            ],
            along: [
                alongs[1],
                (alongs[2] - alongs[0]) * 0.5,
                (alongs[2] + alongs[0]) * 0.5 - alongs[1],
            ],
        }
    }

    /// The places where the chords pass from cell to cell.
    #[inline(always)]
    fn passages(&self, bumps: &Bumps, into: &mut Vec<Passage>) {
        let [below, below_1, below_2] = self.along;
        let (first, last) = (below - below_1 + below_2, below + below_1 + below_2);
        for axis in 0..3 {
            let [above, above_1, above_2] = [
                self.normal[0].along(axis),
                self.normal[1].along(axis),
                self.normal[2].along(axis),
            ];
            let middle = above / below * bumps.cells();
            let start = (above - above_1 + above_2) / first * bumps.cells();
            let end = (above + above_1 + above_2) / last * bumps.cells();
            // How far a parabola goes beyond all three places.
            let beyond = ((start + end) * 0.5 - middle).abs() * 0.5;
            let lowest = start.min(end).min(middle) - beyond;
            let highest = start.max(end).max(middle) + beyond;
            for lane in 0..8 {
                let mut plane = (lowest[lane] + 0.5).ceil() - 0.5;
                while plane <= highest[lane] {
                    let at = plane / bumps.cells();
                    let roots = roots(
                        above_2[lane] - at * below_2[lane],
                        above_1[lane] - at * below_1[lane],
                        above[lane] - at * below[lane],
                    );
                    for sigma in roots {
                        if sigma.abs() < 1.0 {
                            into.push(Passage { lane, axis, sigma });
                        }
                    }
                    plane += 1.0;
                }
            }
        }
    }

    /// The normal of one of the chords, and how fast its component along an axis goes with the parameter.
    fn at(&self, lane: usize, axis: usize, sigma: f64) -> (DVec3, f64) {
        let [constant, linear, square] = self.normal.map(|part| part.lane(lane));
        let above = (square * sigma + linear) * sigma + constant;
        let [below, below_1, below_2] = self.along.map(|part| part[lane]);
        let along = (below_2 * sigma + below_1) * sigma + below;
        let normal = above / along;
        let rise = linear[axis] + 2.0 * square[axis] * sigma;
        let of_along = below_1 + 2.0 * below_2 * sigma;
        (normal, ((rise - normal[axis] * of_along) / along).abs())
    }
}

/// The roots of a polynomial of degree 2, the highest power first; NaN or infinite where there are none.
fn roots(square: f64, linear: f64, constant: f64) -> [f64; 2] {
    let root = (linear * linear - 4.0 * square * constant).sqrt();
    let sum = -0.5 * (linear + root.copysign(linear));
    [sum / square, constant / sum]
}

#[cfg(test)]
mod tests;
