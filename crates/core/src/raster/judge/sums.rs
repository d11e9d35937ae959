//! Sums over the ways between the samples of a row of pixels.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};

use crate::numeric::lanes::{LANES, f32x8, mask32x8};
use crate::numeric::pair::both;
use crate::picture::image::Channels;
use crate::raster::diagonals::{Diagonals, add_to};
use crate::raster::samples::{NONE, Samples};

/// What differences count.
#[derive(Clone, Copy, Debug)]
pub(in crate::raster) struct Weights {
    /// Samples on a side of a pixel.
    pub(in crate::raster) side: usize,
    pub(in crate::raster) channels: Channels,
    /// The light by parts of which samples of different balls differ at least.
    pub(in crate::raster) of_spheres: f64,
    /// The brightest channel of the background, in units.
    pub(in crate::raster) of_background: f64,
    /// The same of what the samples of the tile see, as if no ball kept light from it.
    pub(in crate::raster) brightest: f32,
    /// The largest ratio of the albedos of what is seen in the tile.
    pub(in crate::raster) of_albedos: f32,
}

/// The part of the contrast by which samples of different balls are taken to differ.
pub(super) const OF_SPHERES: f64 = 0.3;

/// The part of the light that may pass, or be kept, between two neighbors by which they are taken to differ, times
/// the root of the number of samples on a side: a thin strip of light or shadow is as long as an edge, and what it
/// adds is the same on all of its ways.
const OF_PASSING: f64 = 0.25;

/// The part of the light between a shadow and where a ball turns away from the light that is taken for a line: half, as
/// there it falls to nothing, and a little more for what [`OF_LINE`] lacks.
const OF_TURNING: f32 = 0.6;

/// The light below which what is seen does not tell how what is behind is lit, in parts of the brightest.
const BLACK: f32 = 1e-3;

/// Sums over the ways between the samples of a row of pixels, for each column of samples.
pub(super) struct Sums {
    /// The squares of the differences, and the differences that are rises and falls, layer by layer.
    pub(super) pairs: Vec<f32>,
    /// The light that strips along the grid may add or take.
    pub(super) edges: Vec<f32>,
    rises: Vec<Vec<f32>>,
    falls: Vec<Vec<f32>>,
    /// The squares of what edges along the grid add between a column and the next.
    pub(super) squares: Vec<f32>,
    /// The differences on the ways that came last, in the layer where they are largest, and the light of strips there.
    pub(super) changes: Vec<f32>,
    pub(super) strips: Vec<f32>,
    pub(super) diagonals: Diagonals,
    /// The light of the samples, layer by layer, those that see a ball, and those that are in doubt.
    pub(super) light: Vec<Vec<f32>>,
    pub(super) covered: Vec<f32>,
    pub(super) doubts: Vec<f32>,
}

impl Sums {
    pub(super) fn new(samples: &Samples) -> Self {
        let none = vec![0.0; samples.stride];
        Self {
            rises: vec![none.clone(); samples.light.len()],
            falls: vec![none.clone(); samples.light.len()],
            light: vec![none.clone(); samples.light.len()],
            edges: none.clone(),
            covered: none.clone(),
            squares: none.clone(),
            changes: none.clone(),
            strips: none.clone(),
            diagonals: Diagonals::default(),
            doubts: none.clone(),
            pairs: none,
        }
    }

    pub(super) fn clear(&mut self) {
        self.pairs.fill(0.0);
        self.edges.fill(0.0);
        for layer in self.rises.iter_mut().chain(&mut self.falls) {
            layer.fill(0.0);
        }
    }

    /// Adds the ways from each sample of a row, from this place on, to the one so many places behind.
    pub(super) fn add(&mut self, level: Level, of: (&Samples, &Weights), ways: (usize, usize)) {
        dispatch!(level, simd => self.add_lanes(simd, of, ways));
    }

    #[inline(always)]
    fn add_lanes<S: Simd>(
        &mut self,
        simd: S,
        (samples, weights): (&Samples, &Weights),
        (first, step): (usize, usize),
    ) {
        let zero = f32x8::splat(simd, 0.0);
        let of_spheres = OF_SPHERES * weights.of_spheres;
        let of_spheres = f32x8::splat(simd, (of_spheres * of_spheres) as f32);
        let background = f32x8::splat(simd, weights.of_background as f32);
        let brightest_strip = f32x8::splat(simd, weights.brightest);
        // What is black tells nothing of how bright others are.
        let least = f32x8::splat(simd, BLACK * weights.brightest);
        let of_passing = (OF_PASSING * (weights.side as f64).sqrt()) as f32;
        for column in (0..samples.stride - LANES).step_by(LANES) {
            let place = first + column;
            let (mut most, mut signed) = (zero, zero);
            let mut brightest = least;
            for (layer, light) in samples.light.iter().enumerate() {
                let [one, other] = two(simd, light, (place, step));
                let change = other - one;
                signed = change.abs().simd_gt(most).select(change, signed);
                most = most.max(change.abs());
                brightest = brightest.max(one).max(other);
                let sums = [
                    (&mut self.rises, change.max(zero)),
                    (&mut self.falls, change.min(zero)),
                ];
                for (sums, change) in sums {
                    add(simd, &mut sums[layer], (column, change));
                }
            }
            let balls = two(simd, &samples.balls, (place, step));
            let names = two(simd, &samples.occluders, (place, step));
            signed.write(&mut self.changes, column);
            let is_alike = balls[0].simd_eq(balls[1]) & names[0].simd_eq(names[1]);
            if !(!is_alike).any_true() {
                add(simd, &mut self.pairs, (column, most * most));
                zero.write(&mut self.strips, column);
                continue;
            }
            let kept = two(simd, &samples.kept, (place, step));
            let same: mask32x8<S> = balls[0].simd_eq(balls[1]);
            let are_dark = kept[0].simd_gt(zero) & kept[1].simd_gt(zero);
            let kept = kept[0].max(kept[1]);
            // On a ball light may pass between two others that keep it from both, or between one of them and where the
            // ball turns away from the light; at its edge there may be a strip of whatever is behind, lit as its
            // neighbors are.
            let is_between = !names[0].simd_eq(names[1]);
            let on_ball = is_between.select((kept - most).max(zero), zero);
            let turning = (same & !are_dark).select(on_ball, zero) * OF_TURNING;
            let alike = kept + brightest;
            let strip = alike.max((alike * weights.of_albedos).min(brightest_strip));
            let at_edge = same.select(zero, strip.max(background));
            let passing = (on_ball + at_edge) * of_passing;
            (at_edge + turning).write(&mut self.strips, column);
            add(simd, &mut self.edges, (column, at_edge + turning));
            let square = most * most + same.select(zero, of_spheres) + passing * passing;
            add(simd, &mut self.pairs, (column, square));
        }
    }

    /// Sums up what the samples of some rows see.
    pub(super) fn add_samples(&mut self, samples: &Samples, rows: Range<usize>) {
        self.covered.fill(0.0);
        self.doubts.fill(0.0);
        for layer in &mut self.light {
            layer.fill(0.0);
        }
        let count = self.covered.len();
        for row in rows {
            let first = row * samples.stride;
            let balls = &samples.balls[first..first + count];
            let covered = &mut self.covered[..count];
            for column in 0..count {
                covered[column] += if balls[column] == NONE { 0.0 } else { 1.0 };
            }
            add_to(&mut self.doubts, &samples.doubts[first..]);
            for layer in 0..self.light.len() {
                add_to(&mut self.light[layer], &samples.light[layer][first..]);
            }
        }
    }

    /// Squares the sums of each column, as [`Self::lines`] does.
    pub(super) fn square_lines(&mut self) {
        let count = self.squares.len();
        let squares = &mut self.squares[..count];
        squares.fill(0.0);
        for layer in 0..self.rises.len() {
            let (rises, falls) = (&self.rises[layer][..count], &self.falls[layer][..count]);
            for column in 0..count {
                let square = rises[column] * rises[column] + falls[column] * falls[column];
                squares[column] = squares[column].max(square);
            }
        }
        let edges = &self.edges[..count];
        for column in 0..count {
            squares[column] += edges[column] * edges[column];
        }
    }

    /// The squares of the sums of rises and of falls over some columns, in the layer where they are largest, and of
    /// what strips at edges may add.
    pub(super) fn lines(&self, columns: Range<usize>) -> f64 {
        let mut most = 0.0_f64;
        for (rises, falls) in self.rises.iter().zip(&self.falls) {
            let [rise, fall] = both([rises, falls], |layer| sum(&layer[columns.clone()]));
            most = most.max(rise * rise + fall * fall);
        }
        let edges = sum(&self.edges[columns]);
        most + edges * edges
    }
}

/// The sum of some numbers, four by four: one after the other they would wait for each other.
pub(super) fn sum(numbers: &[f32]) -> f64 {
    const STEP: usize = 4;
    let mut sums = [0.0_f32; STEP];
    let whole = numbers.len() / STEP * STEP;
    let mut first = 0;
    while first < whole {
        add_to(&mut sums, &numbers[first..first + STEP]);
        first += STEP;
    }
    let mut rest = 0.0;
    for &number in &numbers[whole..] {
        rest += number;
    }
    f64::from((sums[0] + sums[1]) + (sums[2] + sums[3]) + rest)
}

/// Eight numbers from a place on, and those so many places behind.
#[inline(always)]
fn two<S: Simd>(simd: S, numbers: &[f32], (place, step): (usize, usize)) -> [f32x8<S>; 2] {
    [
        f32x8::read(simd, numbers, place),
        f32x8::read(simd, numbers, place + step),
    ]
}

/// Adds eight numbers to those from a place on.
#[inline(always)]
fn add<S: Simd>(simd: S, sums: &mut [f32], (place, more): (usize, f32x8<S>)) {
    (f32x8::read(simd, sums, place) + more).write(sums, place);
}
