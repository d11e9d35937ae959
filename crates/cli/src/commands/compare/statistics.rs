//! Numbers about the differences of two pictures.
//!
//! The difference of a pixel is the largest one of its channels.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::pair::Pair;

/// The statistics of the differences of two pictures.
#[derive(Debug)]
pub(super) struct Statistics {
    pub(super) pixels: u64,
    /// The root of the mean square over all channels of all pixels.
    pub(super) rms: f64,
    /// The 99.9th percentile by nearest rank: the least of the differences that at least 99.9 % of the pixels do not
    /// exceed.
    pub(super) percentile: f64,
    /// Pixels over the tolerance; none where there is no tolerance.
    pub(super) over_tolerance: u64,
    /// Pixels with a channel that differs by more than the rounding of both files.
    pub(super) beyond_rounding: u64,
    /// Those of them that do so in a channel that one of the files could not hold.
    pub(super) clipped: u64,
    /// Pixels with a value that is no finite number, and the first of them.
    pub(super) not_finite: u64,
    pub(super) first_not_finite: Option<(u32, u32)>,
    /// The pixels that differ most, the worst first; no pixels without a difference.
    pub(super) worst: Vec<Difference>,
}

/// A difference in one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Difference {
    pub(super) col: u32,
    pub(super) row: u32,
    pub(super) channel: usize,
    pub(super) size: f64,
}

impl Statistics {
    /// Looks at all pixels, and keeps at least one and at most `worst` of the worst.
    pub(super) fn of(pair: &Pair, tolerance: Option<f64>, worst: usize) -> Self {
        let channels = pair.channels();
        let mut statistics = Self {
            pixels: pair.size().pixels(),
            rms: 0.0,
            percentile: 0.0,
            over_tolerance: 0,
            beyond_rounding: 0,
            clipped: 0,
            not_finite: 0,
            first_not_finite: None,
            worst: Vec::new(),
        };
        let mut squares = 0.0;
        let mut above = Largest::new(above_percentile(statistics.pixels));
        let mut found = Largest::new(worst.max(1));
        for ((col, row), index) in pair.size().places().zip(0..) {
            let differences = pair.differences(col, row);
            let largest = pair.largest(&differences);
            above.add(largest, index);
            found.add(largest, index);
            if largest == 0.0 {
                continue;
            }
            let square = |&channel: &usize| differences[channel] * differences[channel];
            squares += channels.iter().map(square).sum::<f64>();
            statistics.over_tolerance += u64::from(tolerance.is_some_and(|most| largest > most));
            let rounding = pair.rounding(col, row);
            let beyond = |channel: usize| exceeds(differences[channel], rounding[channel]);
            if channels.iter().any(|&channel| beyond(channel)) {
                statistics.beyond_rounding += 1;
                let clipped = pair.is_clipped(col, row);
                let clipped = |&channel: &usize| clipped[channel] && beyond(channel);
                statistics.clipped += u64::from(channels.iter().any(clipped));
            }
            if largest.is_infinite() {
                statistics.not_finite += 1;
                statistics.first_not_finite.get_or_insert((col, row));
            }
        }
        let count = statistics.pixels as f64 * channels.len() as f64;
        statistics.rms = (squares / count).sqrt();
        statistics.percentile = above.least();
        let indices = found.indices().into_iter();
        let width = u64::from(pair.size().width);
        let worst = indices.map(|index| {
            let (col, row) = ((index % width) as u32, (index / width) as u32);
            worst_channel(pair, col, row)
        });
        statistics.worst = worst.collect();
        statistics
    }
}

/// Returns whether a difference needs more than the rounding of the files, whose numbers, themselves
/// rounded to doubles, leave the last few bits open.
fn exceeds(difference: f64, rounding: f64) -> bool {
    /// More than operations on doubles lose, and less than anybody would call a difference.
    const SLACK: f64 = 1e-9;
    difference > rounding * (1.0 + SLACK)
}

/// The number of the differences of so many pixels that are not below the 99.9th percentile.
fn above_percentile(pixels: u64) -> usize {
    /// One pixel of so many may lie above.
    const ABOVE: u64 = 1000;
    (pixels / ABOVE + 1) as usize
}

/// The largest of some differences, of which all others are forgotten.
#[derive(Debug)]
struct Largest {
    most: usize,
    /// The bits of those, which have their order, and the indices, the first of equal ones the largest; the least is at
    /// hand.
    kept: BinaryHeap<Reverse<(u64, Reverse<u64>)>>,
}

impl Largest {
    /// Keeps at most so many, at least one.
    fn new(most: usize) -> Self {
        Self {
            most,
            kept: BinaryHeap::new(),
        }
    }

    /// Takes the difference with this index, at least 0.
    fn add(&mut self, difference: f64, index: u64) {
        let new = (difference.to_bits(), Reverse(index));
        if self.kept.len() < self.most {
            self.kept.push(Reverse(new));
        } else if let Some(mut least) = self.kept.peek_mut()
            && new > least.0
        {
            *least = Reverse(new);
        }
    }

    /// The least of those that are kept; 0 where there is none.
    fn least(&self) -> f64 {
        let least = self.kept.peek();
        least.map_or(0.0, |Reverse((bits, _))| f64::from_bits(*bits))
    }

    /// The indices of those that are kept and above 0, the largest first, equal ones in their order.
    fn indices(self) -> Vec<u64> {
        let sorted = self.kept.into_sorted_vec().into_iter();
        let above = sorted.filter(|Reverse((bits, _))| f64::from_bits(*bits) > 0.0);
        above.map(|Reverse((_, Reverse(index)))| index).collect()
    }
}

/// The first of the channels in which a pixel differs most.
fn worst_channel(pair: &Pair, col: u32, row: u32) -> Difference {
    let differences = pair.differences(col, row);
    let mut worst = pair.channels()[0];
    for &channel in pair.channels() {
        if differences[channel] > differences[worst] {
            worst = channel;
        }
    }
    Difference {
        col,
        row,
        channel: worst,
        size: differences[worst],
    }
}

#[cfg(test)]
mod tests;
