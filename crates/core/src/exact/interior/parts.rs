//! Cells that one rough sphere fills, in parts: the worst of them is divided, again and again.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use fearless_simd::Simd;

use super::estimate::CAUTION;
use super::filled::Filled;
use super::half_turns::{nearness_of_silhouette, view_turn};
use super::light_cosines::LightCosines;
use super::samples::{GAUSS_SAMPLES, POINTS, Rule, STAR_SAMPLES};
use crate::exact::points::Points;
use crate::exact::scene::MOST_LIGHTS;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// All eight parts, bit by bit.
pub(super) const ALL: u64 = 0xff;

/// Samples that a division takes.
const SAMPLES_OF_DIVISION: u64 = 8 * STAR_SAMPLES as u64;

/// The divisions after which the error is looked at whether it falls fast enough: at twice as many again, and so on.
const FIRST_CHECK: usize = 1;

/// An average over a cell that one sphere fills.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Average {
    pub(crate) value: Color,
    pub(crate) error: f64,
    pub(crate) samples: u64,
    /// Whether it is by random samples: no rung knows more.
    pub(crate) is_random: bool,
}

/// A part of a cell.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Its middle, from the cell's, and its sides, in sides of the cell.
    place: [f64; 2],
    size: [f64; 2],
    value: Color,
    /// Its share of the cell, and what it adds to the cell's error.
    share: f64,
    cost: f64,
}

/// The error of all parts together.
///
/// # Accuracy
/// An estimate: the errors of parts are taken to have one sign as far as light's bend tells them. What they are multiplied
/// by for the few parts that are farther off is taken to be the same in no two of them, so that its squares add up. Bumps
/// that are alike in many parts could fool it; those of noise are not.
#[derive(Clone, Copy, Debug, Default)]
struct Claim {
    /// The claim of the parts that may be off by all light that there may be.
    unknown: f64,
    /// The claim of the others, and the sum of the squares.
    known: f64,
    squares: f64,
}

impl Claim {
    fn add(&mut self, piece: &Piece, range: f64) {
        if piece.cost < range * piece.share {
            self.known += piece.cost;
            self.squares += piece.cost * piece.cost;
        } else {
            self.unknown += piece.cost;
        }
    }

    fn remove(&mut self, piece: &Piece, range: f64) {
        if piece.cost < range * piece.share {
            self.known -= piece.cost;
            self.squares -= piece.cost * piece.cost;
        } else {
            self.unknown -= piece.cost;
        }
    }

    fn error(&self) -> f64 {
        const COMMON: f64 = 1.0 / CAUTION;
        let apart = self.squares.max(0.0).sqrt();
        self.unknown + COMMON * self.known + (1.0 - COMMON) * apart
    }
}

impl<S: Simd> Filled<'_, S> {
    /// The average over one of the cells by parts, divided until the error meets the tolerance, at most `most`
    /// times.
    ///
    /// # Accuracy
    /// An estimate, as those of the parts: terminators of bumps, and the tops of highlights on them, cost little
    /// in parts that are as small. A part that is large beside the bumps claims all light that there may be,
    /// however well its samples agree; so it is divided first.
    #[inline(never)]
    pub(crate) fn in_parts(
        &self,
        simd: S,
        lane: usize,
        most: usize,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Average {
        let range = self.range_of_light();
        let whole = Piece {
            place: [0.0; 2],
            size: [1.0; 2],
            value: Color::ZERO,
            share: 1.0,
            cost: range,
        };
        let mut claim = Claim::default();
        claim.add(&whole, range);
        let mut pieces = BinaryHeap::from([whole]);
        let mut divisions = 0;
        let mut check = FIRST_CHECK;
        while claim.error() > self.tolerance && divisions < most {
            let Some(worst) = pieces.pop() else { break };
            if divisions == check {
                // Errors fall with the number of parts; what is not seen yet, faster.
                let is_known = worst.cost < range * worst.share;
                if is_known && claim.error() * divisions as f64 > self.tolerance * most as f64 {
                    pieces.push(worst);
                    break;
                }
                check *= 2;
            }
            claim.remove(&worst, range);
            for part in self.divide(simd, lane, &worst, range, noise) {
                claim.add(&part, range);
                pieces.push(part);
            }
            divisions += 1;
        }
        // In an order that is the same everywhere, as that of the heap is.
        let mut average = Average {
            value: Color::ZERO,
            error: 0.0,
            samples: SAMPLES_OF_DIVISION * divisions as u64,
            is_random: false,
        };
        let mut claim = Claim::default();
        for piece in &pieces {
            average.value += piece.value * piece.share;
            claim.add(piece, range);
        }
        average.error = claim.error();
        average
    }

    /// More than the light that the lights may make in any channel.
    pub(super) fn range_of_light(&self) -> f64 {
        let lights = self.scene.lights.iter();
        let brightest = lights.map(|light| self.finish.reflectance.brightest(light.intensity));
        brightest
            .map(|[diffuse, highlight]| diffuse + highlight)
            .sum()
    }

    /// The lights that reach all of a cell, as masks of parts.
    pub(super) fn lit_in_parts(&self, lane: usize) -> [u64; MOST_LIGHTS] {
        let mut lit = [0; MOST_LIGHTS];
        for (of_parts, of_cells) in lit.iter_mut().zip(self.lit) {
            if of_cells >> lane & 1 == 1 {
                *of_parts = ALL;
            }
        }
        lit
    }

    /// Eight parts of a part, by five samples each.
    #[inline(never)]
    fn divide(
        &self,
        simd: S,
        lane: usize,
        of: &Piece,
        range: f64,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> [Piece; 8] {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut pieces = self.eighths(simd, lane, of);
                let zero = f64x8::splat(simd, 0.0);
                let mut middle = Vectors {
                    x: zero,
                    y: zero,
                    z: zero + self.middle.z[lane],
                };
                let (mut u, mut v) = ([0.0; 8], [0.0; 8]);
                for (index, piece) in pieces.iter().enumerate() {
                    u[index] = self.middle.x[lane] + piece.place[0] * self.size[0];
                    v[index] = self.middle.y[lane] + piece.place[1] * self.size[1];
                }
                middle.x = f64x8::from_array(simd, u);
                middle.y = f64x8::from_array(simd, v);
                let first = pieces[0];
                let size = [first.size[0] * self.size[0], first.size[1] * self.size[1]];
                let (turn, view_turn, nearness) = self.turn_of_parts(simd, middle, size);
                let parts = Filled {
                    middle,
                    size,
                    lit: &self.lit_in_parts(lane),
                    turn,
                    view_turn,
                    nearness,
                    which: ALL,
                    ..*self
                };
                let mut cosines = Some(LightCosines::new(simd));
                let mut lights = [[zero; 3]; GAUSS_SAMPLES];
                parts.light(simd, 0, &mut cosines, noise, &mut lights[..STAR_SAMPLES]);
                let kinks = match parts.finish.is_rough() {
                    true => parts.kinks(simd, noise),
                    false => None,
                };
                let (cosines, kinks) = (cosines.as_ref(), kinks.as_ref());
                let estimate = parts.estimate(simd, Rule::Star, &lights, cosines, kinks);
                let known = estimate.is_known.to_bitmask();
                for channel in 0..self.scene.channels {
                    let mut sum = zero;
                    for (light, sample) in lights.iter().zip(&POINTS[..STAR_SAMPLES]) {
                        sum += light[channel] * sample.star;
                    }
                    for (index, piece) in pieces.iter_mut().enumerate() {
                        piece.value[channel] = sum[index];
                    }
                }
                for (index, piece) in pieces.iter_mut().enumerate() {
                    let is_known = known >> index & 1 == 1;
                    let error = if is_known {
                        estimate.error[index].min(range)
                    } else {
                        range
                    };
                    piece.cost = error * piece.share;
                }
                pieces
            },
        )
    }

    /// The turns of normals and of directions toward the eye from the middles of parts to their corners, and how near the
    /// contour is, as [`Filled`] has it.
    ///
    /// Where the ray d moves by e, the point p = t d moves by t (e − d (n·e) / (n·d)), along the surface. With
    /// the cosine g = |n·d| / |d| this is at most t (|e| + |n·e| / g). Toward the contour g falls, like a root: to
    /// g √(1 − ν), with ν twice the turn over g, that of the view included, so that normals turn by g (1 − √(1 − ν))
    /// instead of g ν / 2; for ν up to ½ that is less than 1 + ν / 2 times as far.
    #[inline(always)]
    fn turn_of_parts(
        &self,
        simd: S,
        middle: Vectors<S>,
        [width, height]: [f64; 2],
    ) -> (f64x8<S>, f64x8<S>, f64x8<S>) {
        let points = Points::new(simd, self.ball, middle);
        let zero = f64x8::splat(simd, 0.0);
        let half_diagonal = 0.5 * (width * width + height * height).sqrt();
        let normal = &points.normal;
        let along = normal.x.abs() * (0.5 * width) + normal.y.abs() * (0.5 * height);
        let grazing = (normal.dot(&points.ray) / -points.ray_sq.sqrt()).max(zero);
        // Points on parallel rays move by as much as the rays, wherever they are.
        let scale = if self.ball.is_parallel() {
            zero + 1.0
        } else {
            points.t
        };
        let turn = scale * (along / grazing + half_diagonal) * (1.0 / self.ball.radius);
        let view_turn = view_turn(self.ball, points.ray_sq.sqrt(), half_diagonal);
        let nearness = nearness_of_silhouette(turn, view_turn, grazing);
        (turn * (nearness * 0.5 + 1.0), view_turn, nearness)
    }

    /// The places of eight parts of a part: halves along one axis, quarters along the one along which it is
    /// longer on the surface.
    #[inline(always)]
    fn eighths(&self, simd: S, lane: usize, of: &Piece) -> [Piece; 8] {
        const HALVES: [f64; 2] = [-0.25, 0.25];
        const QUARTERS: [f64; 4] = [-0.375, -0.125, 0.125, 0.375];
        let zero = f64x8::splat(simd, 0.0);
        let middle = Vectors {
            x: zero + (self.middle.x[lane] + of.place[0] * self.size[0]),
            y: zero + (self.middle.y[lane] + of.place[1] * self.size[1]),
            z: zero + self.middle.z[lane],
        };
        let normal = Points::new(simd, self.ball, middle).normal;
        let [x, y, z] = [normal.x[0], normal.y[0], normal.z[0]];
        // Squares of the lengths on the surface, over z².
        let [width, height] = [of.size[0] * self.size[0], of.size[1] * self.size[1]];
        let is_wide = width * width * (x * x + z * z) > height * height * (y * y + z * z);
        let [columns, rows]: [&[f64]; 2] = if is_wide {
            [&QUARTERS, &HALVES]
        } else {
            [&HALVES, &QUARTERS]
        };
        let mut pieces = [Piece {
            size: [
                of.size[0] / columns.len() as f64,
                of.size[1] / rows.len() as f64,
            ],
            share: 0.125 * of.share,
            ..*of
        }; 8];
        for (row, v) in rows.iter().enumerate() {
            for (col, u) in columns.iter().enumerate() {
                pieces[row * columns.len() + col].place =
                    [of.place[0] + u * of.size[0], of.place[1] + v * of.size[1]];
            }
        }
        pieces
    }
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Piece {}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost.total_cmp(&other.cost)
    }
}
