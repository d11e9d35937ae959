//! The means over pixels, and their errors, as neighboring samples tell them.
//!
//! An edge that crosses the way between two neighbors is somewhere on it: the mean is off by a part of what they
//! differ by, times the share that a sample has in the pixel. The errors of many edges add up as their squares do.
//! An edge along the grid lies between the same two rows or columns over a part of the pixel: there differences are
//! summed before they are squared. So they are along the diagonals: see [`Diagonals`]. Ways over the border of the
//! pixel count half: half of their edges are in it.
//!
//! Neighbors that see different balls are taken to differ at least by a part of the contrast, whatever their light:
//! a third ball or a shadow may lie between them.
//!
//! # Accuracy
//! An estimate. Several strips of the same light that are thinner than the distance of samples could fool it: one
//! that is as long as the pixel is within what is claimed. Balls that fit between samples could, too; tiles with such
//! are left to others. Of 800,000 pixels of six crowds none was off by more than .77 of what is claimed; so were none
//! of the tests, whose truth is 64 × 64 exact rays.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};

use super::diagonals::{Diagonals, add_to};
use super::samples::{NONE, Samples};
use crate::model::color::Color;
use crate::numeric::lanes::{LANES, f32x8, mask32x8};
use crate::numeric::pair::both;
use crate::picture::image::Channels;
use crate::picture::tile::Tile;

/// A pixel by samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    pub(crate) value: Color,
    pub(crate) alpha: f64,
    /// The standard error of both, of alpha times the unit of light; infinite if a sample could not be decided.
    pub(crate) error: f64,
}

/// What differences count.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    /// Samples on a side of a pixel.
    pub(super) side: usize,
    pub(super) channels: Channels,
    /// The light by parts of which samples of different balls differ at least.
    pub(super) of_spheres: f64,
    /// The brightest channel of the background, in units.
    pub(super) of_background: f64,
    /// The same of what the samples of the tile see, as if no ball kept light from it.
    pub(super) brightest: f32,
    /// The largest ratio of the albedos of what is seen in the tile.
    pub(super) of_albedos: f32,
}

/// The standard error of an edge that crosses the way between two neighbors, in parts of its contrast and of a
/// sample's area: 1/√12 for one that may be anywhere on it, less for a long one, which is at different places on
/// different ways.
const OF_PAIR: f64 = 0.22;

/// The same for an edge along the grid, whose errors are the same on all ways.
const OF_LINE: f64 = 0.15;

/// The part of the contrast by which samples of different balls are taken to differ.
const OF_SPHERES: f64 = 0.3;

/// The part of the light that may pass, or be kept, between two neighbors by which they are taken to differ, times
/// the root of the number of samples on a side: a thin strip of light or shadow is as long as an edge, and what it
/// adds is the same on all of its ways.
const OF_PASSING: f64 = 0.25;

/// The part of the light between a shadow and where a ball turns away from the light that is taken for a line: half, as
/// there it falls to nothing, and a little more for what [`OF_LINE`] lacks.
const OF_TURNING: f32 = 0.6;

/// The light below which what is seen does not tell how what is behind is lit, in parts of the brightest.
const BLACK: f32 = 1e-3;

/// The share of a pixel's corner in a way. A ball that no way along the grid meets reaches past the corner by no more
/// than s² / 4r, with the distance s of samples and a radius r of at least that: it covers (s² / 4r)², 1/16 of a sample. This
/// much is claimed for it, and more.
const OF_CORNER: f64 = 1.0 / 16.0;

/// The samples on a side of a pixel from which on edges along a diagonal are summed up. Such an edge is at the same place on
/// the way to the next column in each row: a pixel is off by up to half a sample for each, which is less than is claimed
/// of its ways one by one while these are few.
const FEWEST_OF_DIAGONALS: usize = 14;

const SIDE: usize = Tile::SIDE as usize;

/// Sums over the ways between the samples of a row of pixels, for each column of samples.
struct Sums {
    /// The squares of the differences, and the differences that are rises and falls, layer by layer.
    pairs: Vec<f32>,
    /// The light that strips along the grid may add or take.
    edges: Vec<f32>,
    rises: Vec<Vec<f32>>,
    falls: Vec<Vec<f32>>,
    /// The squares of what edges along the grid add between a column and the next.
    squares: Vec<f32>,
    /// The differences on the ways that came last, in the layer where they are largest, and the light of strips there.
    changes: Vec<f32>,
    strips: Vec<f32>,
    diagonals: Diagonals,
    /// The light of the samples, layer by layer, those that see a ball, and those that are in doubt.
    light: Vec<Vec<f32>>,
    covered: Vec<f32>,
    doubts: Vec<f32>,
}

/// The pixels of a tile, row by row.
pub(super) fn pixels(level: Level, samples: &Samples, weights: &Weights) -> [Judged; SIDE * SIDE] {
    let mut judged = [Judged {
        value: Color::ZERO,
        alpha: 0.0,
        error: 0.0,
    }; SIDE * SIDE];
    let mut sums = Sums::new(samples);
    for (row, pixels) in judged.chunks_exact_mut(SIDE).enumerate() {
        of_row(level, samples, weights, &mut sums, (row, pixels));
    }
    judged
}

/// The brightest light that a sample sends, or would send if no ball kept any from it.
pub(super) fn brightest(level: Level, samples: &Samples) -> f32 {
    dispatch!(level, simd => brightest_of_lanes(simd, samples))
}

#[inline(always)]
fn brightest_of_lanes<S: Simd>(simd: S, samples: &Samples) -> f32 {
    let mut most = f32x8::splat(simd, 0.0);
    for place in (0..samples.kept.len()).step_by(LANES) {
        let mut of_layers = f32x8::splat(simd, 0.0);
        for light in &samples.light {
            of_layers = of_layers.max(f32x8::read(simd, light, place));
        }
        most = most.max(of_layers + f32x8::read(simd, &samples.kept, place));
    }
    let mut lanes = [0.0; LANES];
    most.write(&mut lanes, 0);
    lanes.into_iter().fold(0.0, f32::max)
}

/// The same of a row of pixels.
fn of_row(
    level: Level,
    samples: &Samples,
    weights: &Weights,
    sums: &mut Sums,
    (row, pixels): (usize, &mut [Judged]),
) {
    let (side, stride) = (weights.side, samples.stride);
    let first = row * side + 1;
    let rows = first..first + side;
    // The squares of differences and of sums of differences, by pixel.
    let (mut pairs, mut lines) = ([0.0_f64; SIDE], [0.0_f64; SIDE]);
    let share = |number: usize| {
        if number == 0 || number == side {
            0.5
        } else {
            1.0
        }
    };

    // Ways from one column to the next.
    let mut diagonals = [0.0; SIDE];
    let has_diagonals = side >= FEWEST_OF_DIAGONALS;
    sums.clear();
    if has_diagonals {
        sums.diagonals.clear(SIDE, side);
    }
    for (number, row) in rows.clone().enumerate() {
        sums.add(level, (samples, weights), (row * stride, 1));
        if has_diagonals {
            let ways = (&sums.changes[..], &sums.strips[..]);
            sums.diagonals.add(ways, side, number);
        }
    }
    sums.square_lines();
    for pixel in 0..SIDE {
        let columns = pixel * side..pixel * side + side + 1;
        pairs[pixel] = of_ways(&sums.pairs[columns.clone()]);
        lines[pixel] = of_ways(&sums.squares[columns]);
        if has_diagonals {
            diagonals[pixel] = sums.diagonals.squares(pixel);
        }
    }
    // Ways from one row to the next.
    for number in 0..=side {
        sums.clear();
        let place = (first + number - 1) * stride;
        sums.add(level, (samples, weights), (place, stride));
        for pixel in 0..SIDE {
            let columns = pixel * side + 1..pixel * side + 1 + side;
            pairs[pixel] += share(number) * sum(&sums.pairs[columns.clone()]);
            lines[pixel] += share(number) * sums.lines(columns);
        }
    }
    for (pixel, pairs) in pairs.iter_mut().enumerate() {
        let place = first * stride + pixel * side + 1;
        *pairs += OF_CORNER * of_corners(samples, weights, place);
    }
    sums.add_samples(samples, rows);
    let count = (side * side) as f64;
    for (pixel, judged) in pixels.iter_mut().enumerate() {
        let columns = pixel * side + 1..pixel * side + 1 + side;
        let of_pixel = |sums: &[f32]| sum(&sums[columns.clone()]);
        let mut light = Color::splat(of_pixel(&sums.light[0]));
        for channel in 1..weights.channels.count() {
            light[channel] = of_pixel(&sums.light[channel]);
        }
        let along = lines[pixel].max(diagonals[pixel]);
        let error = (OF_PAIR * pairs[pixel].sqrt()).max(OF_LINE * along.sqrt());
        *judged = Judged {
            value: light / count,
            alpha: of_pixel(&sums.covered) / count,
            error: if of_pixel(&sums.doubts) > 0.0 {
                f64::INFINITY
            } else {
                error / count
            },
        };
    }
}

/// The squares of the differences across the corners of a pixel whose first sample has this place.
fn of_corners(samples: &Samples, weights: &Weights, place: usize) -> f64 {
    let (stride, last) = (samples.stride, weights.side - 1);
    let of_spheres = OF_SPHERES * weights.of_spheres;
    let ways = [
        (place, place - stride - 1),
        (place + last, place + last - stride + 1),
        (place + last * stride, place + (last + 1) * stride - 1),
        (
            place + last * (stride + 1),
            place + (last + 1) * (stride + 1),
        ),
    ];
    let of_way = |(one, other): (usize, usize)| {
        let changes = samples.light.iter().map(|light| light[other] - light[one]);
        let most = f64::from(changes.fold(0.0, |most: f32, change| most.max(change.abs())));
        let is_same = samples.balls[one] == samples.balls[other];
        most * most
            + if is_same {
                0.0
            } else {
                of_spheres * of_spheres
            }
    };
    ways.into_iter().map(of_way).sum()
}

impl Sums {
    fn new(samples: &Samples) -> Self {
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

    fn clear(&mut self) {
        self.pairs.fill(0.0);
        self.edges.fill(0.0);
        for layer in self.rises.iter_mut().chain(&mut self.falls) {
            layer.fill(0.0);
        }
    }

    /// Adds the ways from each sample of a row, from this place on, to the one so many places behind.
    fn add(&mut self, level: Level, of: (&Samples, &Weights), ways: (usize, usize)) {
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
    fn add_samples(&mut self, samples: &Samples, rows: Range<usize>) {
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
    fn square_lines(&mut self) {
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
    fn lines(&self, columns: Range<usize>) -> f64 {
        let mut most = 0.0_f64;
        for (rises, falls) in self.rises.iter().zip(&self.falls) {
            let [rise, fall] = both([rises, falls], |layer| sum(&layer[columns.clone()]));
            most = most.max(rise * rise + fall * fall);
        }
        let edges = sum(&self.edges[columns]);
        most + edges * edges
    }
}

/// The sum over the ways between the columns of a pixel, and half of those across its borders, the first and the last.
fn of_ways(numbers: &[f32]) -> f64 {
    let [first, .., last] = numbers else {
        return 0.0;
    };
    sum(numbers) - 0.5 * (f64::from(*first) + f64::from(*last))
}

/// The sum of some numbers, four by four: one after the other they would wait for each other.
fn sum(numbers: &[f32]) -> f64 {
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

#[cfg(test)]
mod tests;
