//! The means over pixels, and their errors, as neighboring samples tell them.
//!
//! An edge that crosses the way between two neighbors is somewhere on it: the mean is off by a part of what they
//! differ by, times the share that a sample has in the pixel. The errors of many edges add up as their squares do.
//! An edge along the grid lies between the same two rows or columns over a part of the pixel: there differences are
//! summed before they are squared, and along the [`diagonals`](super::diagonals) as well. Ways over the border of the
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

mod sums;

use fearless_simd::{Level, Simd, dispatch};

pub(super) use self::sums::Weights;
use self::sums::{OF_SPHERES, Sums, sum};
use super::samples::Samples;
use crate::model::color::Color;
use crate::numeric::lanes::{LANES, f32x8};
use crate::picture::tile::Tile;

/// A pixel by samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    pub(crate) value: Color,
    pub(crate) alpha: f64,
    /// The standard error of both, of alpha times the unit of light; infinite if a sample could not be decided.
    pub(crate) error: f64,
}

/// The standard error of an edge that crosses the way between two neighbors, in parts of its contrast and of a
/// sample's area: 1/√12 for one that may be anywhere on it, less for a long one, which is at different places on
/// different ways.
const OF_PAIR: f64 = 0.22;

/// The same for an edge along the grid, whose errors are the same on all ways.
const OF_LINE: f64 = 0.15;

/// The share of a pixel's corner in a way. A ball that no way along the grid meets reaches past the corner by no more
/// than s² / 4r, with the distance s of samples and a radius r of at least that: it covers (s² / 4r)², 1/16 of a sample. This
/// much is claimed for it, and more.
const OF_CORNER: f64 = 1.0 / 16.0;

/// The samples on a side of a pixel from which on edges along a diagonal are summed up. Such an edge is at the same place on
/// the way to the next column in each row: a pixel is off by up to half a sample for each, which is less than is claimed
/// of its ways one by one while these are few.
const FEWEST_OF_DIAGONALS: usize = 14;

const SIDE: usize = Tile::SIDE as usize;

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

/// The sum over the ways between the columns of a pixel, and half of those across its borders, the first and the last.
fn of_ways(numbers: &[f32]) -> f64 {
    let [first, .., last] = numbers else {
        return 0.0;
    };
    sum(numbers) - 0.5 * (f64::from(*first) + f64::from(*last))
}

#[cfg(test)]
mod tests;
