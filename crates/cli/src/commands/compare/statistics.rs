//! Numbers about the differences of two pictures.
//!
//! The difference of a pixel is the largest one of its channels.

use super::pair::Pair;

/// The statistics of the differences of two pictures.
#[derive(Debug)]
pub(super) struct Statistics {
    /// Row by row, the difference of every pixel; infinite where a value is no finite number.
    pub(super) differences: Vec<f64>,
    /// The root of the mean square over all channels of all pixels.
    pub(super) rms: f64,
    /// The 99.9th percentile, see [`percentile`].
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
            differences: Vec::with_capacity(pair.size().pixels() as usize),
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
        for (col, row) in pair.size().places() {
            let differences = pair.differences(col, row);
            let largest = channels.iter().map(|&channel| differences[channel]);
            let largest = largest.fold(0.0, f64::max);
            statistics.differences.push(largest);
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
        let count = statistics.differences.len() as f64 * channels.len() as f64;
        statistics.rms = (squares / count).sqrt();
        statistics.percentile = percentile(statistics.differences.clone());
        statistics.worst = largest(&statistics.differences, worst.max(1))
            .into_iter()
            .map(|index| {
                let width = pair.size().width as usize;
                let (col, row) = ((index % width) as u32, (index / width) as u32);
                worst_channel(pair, col, row)
            })
            .collect();
        statistics
    }

    pub(super) fn pixels(&self) -> u64 {
        self.differences.len() as u64
    }
}

/// Returns whether a difference needs more than the rounding of the files, whose numbers, themselves
/// rounded to doubles, leave the last few bits open.
fn exceeds(difference: f64, rounding: f64) -> bool {
    /// More than operations on doubles lose, and less than anybody would call a difference.
    const SLACK: f64 = 1e-9;
    difference > rounding * (1.0 + SLACK)
}

/// The 99.9th percentile by nearest rank: the least of the differences that at least 99.9 % of the
/// pixels do not exceed.
fn percentile(mut differences: Vec<f64>) -> f64 {
    /// One pixel of so many may lie above.
    const ABOVE: usize = 1000;
    let count = differences.len();
    if count == 0 {
        return 0.0;
    }
    let rank = count - count / ABOVE; // ⌈0.999 · count⌉
    *differences
        .select_nth_unstable_by(rank - 1, f64::total_cmp)
        .1
}

/// The indices of the `most` largest differences, the largest first, equal ones in their order.
/// Those without a difference are left out.
fn largest(differences: &[f64], most: usize) -> Vec<usize> {
    let mut indices: Vec<usize> = (0..differences.len())
        .filter(|&index| differences[index] > 0.0)
        .collect();
    let order = |one: &usize, other: &usize| {
        let larger = differences[*other].total_cmp(&differences[*one]);
        larger.then(one.cmp(other))
    };
    if indices.len() > most {
        indices.select_nth_unstable_by(most, order);
        indices.truncate(most);
    }
    indices.sort_unstable_by(order);
    indices
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
