//! Numbers about the differences of two pictures.
//!
//! The difference of a pixel is the largest one of its channels.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::ops::Range;

use super::pair::Pair;

/// The statistics of the differences of two pictures.
#[derive(Debug)]
pub(super) struct Statistics {
    pub(super) pixels: u64,
    /// The root of the mean square over all channels of all pixels.
    pub(super) rms: f64,
    /// The 99.9th percentile by nearest rank: the smallest difference that is not exceeded by at least 99.9 % of the
    /// pixels.
    pub(super) percentile: f64,
    /// Pixels over the tolerance; none where there is no tolerance.
    pub(super) over_tolerance: u64,
    /// Pixels with a channel that differs by more than the rounding of both files.
    pub(super) beyond_rounding: u64,
    /// Those among them whose differing channel was too large for one of the files.
    pub(super) clipped: u64,
    /// The number of pixels with a value that is not finite, and the first of them.
    pub(super) not_finite: u64,
    pub(super) first_not_finite: Option<(u32, u32)>,
    /// The pixels with the largest differences, the worst first; no pixels without a difference.
    pub(super) worst: Vec<Difference>,
}

/// A difference in one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Difference {
    pub(super) col: u32,
    pub(super) row: u32,
    pub(super) channel: usize,
    pub(super) size: f64,
    /// The numbers of both pictures.
    pub(super) values: [f64; 2],
    /// The differences that the rounding of each file can explain.
    pub(super) rounding: [f64; 2],
}

/// The statistics of two pictures, up to the current row.
#[derive(Debug)]
pub(super) struct Counter {
    statistics: Statistics,
    tolerance: Option<f64>,
    channels: &'static [usize],
    /// The sum of the squares of all differences.
    squares: f64,
    above_percentile: Largest<()>,
    worst: Largest<Difference>,
    width: u32,
    row: u32,
}

impl Counter {
    /// Keeps at most `worst` of the worst pixels, but at least one.
    pub(super) fn new(pair: &Pair, tolerance: Option<f64>, worst: usize) -> Self {
        let pixels = pair.size().pixels();
        Self {
            statistics: Statistics {
                pixels,
                rms: 0.0,
                percentile: 0.0,
                over_tolerance: 0,
                beyond_rounding: 0,
                clipped: 0,
                not_finite: 0,
                first_not_finite: None,
                worst: Vec::new(),
            },
            tolerance,
            channels: pair.channels(),
            squares: 0.0,
            above_percentile: Largest::new(above_percentile(pixels)),
            worst: Largest::new(worst.max(1)),
            width: pair.size().width,
            row: 0,
        }
    }

    /// Adds the current row.
    pub(super) fn add_row(&mut self, pair: &Pair) {
        let first = u64::from(self.row) * u64::from(self.width);
        for run in pair.runs(pair.columns()) {
            let differences = pair.differences(run.start);
            let largest = pair.largest(&differences);
            if largest == 0.0 {
                continue;
            }
            let index = |col: u32| first + u64::from(col);
            // As far as they are kept: behind one that is not, none is.
            let mut columns = run.clone();
            columns.all(|col| self.above_percentile.add(largest, index(col), || ()));
            let mut columns = run.clone();
            columns.all(|col| {
                let worst = || worst_channel(pair, &differences, col, self.row);
                self.worst.add(largest, index(col), worst)
            });
            self.add(pair, run, &differences, largest);
        }
        self.row += 1;
    }

    /// Adds a number of equal pixels with a difference.
    fn add(&mut self, pair: &Pair, run: Range<u32>, differences: &[f64; 4], largest: f64) {
        let (col, count) = (run.start, u64::from(run.end - run.start));
        let (statistics, channels) = (&mut self.statistics, self.channels);
        let square = |&channel: &usize| differences[channel] * differences[channel];
        self.squares += count as f64 * channels.iter().map(square).sum::<f64>();
        let is_over = self.tolerance.is_some_and(|most| largest > most);
        statistics.over_tolerance += count * u64::from(is_over);
        let rounding = pair.rounding(col);
        let beyond = |channel: usize| exceeds(differences[channel], rounding[channel]);
        if channels.iter().any(|&channel| beyond(channel)) {
            statistics.beyond_rounding += count;
            let clipped = pair.is_clipped(col);
            let clipped = |&channel: &usize| clipped[channel] && beyond(channel);
            statistics.clipped += count * u64::from(channels.iter().any(clipped));
        }
        if largest.is_infinite() {
            statistics.not_finite += count;
            statistics.first_not_finite.get_or_insert((col, self.row));
        }
    }

    /// The statistics, after the last row.
    pub(super) fn finish(self) -> Statistics {
        let count = self.statistics.pixels as f64 * self.channels.len() as f64;
        Statistics {
            rms: (self.squares / count).sqrt(),
            percentile: self.above_percentile.least_of_most(),
            worst: self.worst.into_values(),
            ..self.statistics
        }
    }
}

/// Returns whether a difference is larger than the rounding of the files. The last few bits are tolerated, because the
/// numbers of the files are themselves rounded to doubles.
fn exceeds(difference: f64, rounding: f64) -> bool {
    /// More than the rounding error of the operations on doubles, and less than any difference that matters.
    const SLACK: f64 = 1e-9;
    difference > rounding * (1.0 + SLACK)
}

/// The number of differences, among those of `pixels`, that are not below the 99.9th percentile.
fn above_percentile(pixels: u64) -> usize {
    /// One in this many pixels may be above the percentile.
    const ABOVE: u64 = 1000;
    (pixels / ABOVE + 1) as usize
}

/// Keeps the largest of some differences, with a value for each.
#[derive(Debug)]
struct Largest<T> {
    most: usize,
    /// Ordered by the bits of the differences, whose order is that of the numbers, then by index; among equal
    /// differences, the one with the smallest index counts as largest.
    kept: BTreeMap<(u64, Reverse<u64>), T>,
    /// The smallest kept difference, if the list is full.
    least: Option<(u64, Reverse<u64>)>,
}

impl<T> Largest<T> {
    /// Keeps at most `most` differences, but at least one.
    fn new(most: usize) -> Self {
        Self {
            most,
            kept: BTreeMap::new(),
            least: None,
        }
    }

    /// Adds the difference with this index, which is at least 0. Returns whether it is kept for now. If not, no equal
    /// difference with a larger index is kept either.
    fn add(&mut self, difference: f64, index: u64, about: impl FnOnce() -> T) -> bool {
        let new = (difference.to_bits(), Reverse(index));
        if self.least.is_some_and(|least| new < least) {
            return false;
        }
        self.kept.insert(new, about());
        if self.kept.len() > self.most {
            self.kept.pop_first();
        }
        if self.kept.len() == self.most {
            self.least = self.kept.keys().next().copied();
        }
        true
    }

    /// The smallest kept difference if the list is full, else 0: differences of 0 need not be added.
    fn least_of_most(&self) -> f64 {
        self.least.map_or(0.0, |(bits, _)| f64::from_bits(bits))
    }

    /// The kept values, the largest first, and equal ones in the order in which they were added.
    fn into_values(self) -> Vec<T> {
        self.kept.into_values().rev().collect()
    }
}

/// The first channel with the largest difference of a pixel.
fn worst_channel(pair: &Pair, differences: &[f64; 4], col: u32, row: u32) -> Difference {
    let mut worst = pair.channels()[0];
    for &channel in pair.channels() {
        if differences[channel] > differences[worst] {
            worst = channel;
        }
    }
    let both = [&pair.a.row, &pair.b.row];
    Difference {
        col,
        row,
        channel: worst,
        size: differences[worst],
        values: both.map(|row| row.rgba(col)[worst]),
        rounding: both.map(|row| row.rounding(col)[worst]),
    }
}

#[cfg(test)]
mod tests;
