//! Two pictures that are compared.

use std::iter;
use std::ops::Range;
use std::path::PathBuf;

use glam::DVec4;

use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::formats::picture::Picture;

/// Two pictures of the same size, with the same current row.
pub(super) struct Pair {
    pub(super) a: Picture,
    pub(super) b: Picture,
    /// The paths of both.
    pub(super) paths: [PathBuf; 2],
}

/// The names of the four values of a pixel.
const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

impl Pair {
    /// The channels that are compared, among red, green, blue and alpha: a single color if both pictures are gray, and
    /// alpha if either has it.
    pub(super) fn channels(&self) -> &'static [usize] {
        let grey = self.a.grey && self.b.grey;
        match (grey, self.a.alpha || self.b.alpha) {
            (true, false) => &[0],
            (true, true) => &[0, 3],
            (false, false) => &[0, 1, 2],
            (false, true) => &[0, 1, 2, 3],
        }
    }

    /// The name of a channel that is compared.
    pub(super) fn name(&self, channel: usize) -> &'static str {
        if channel == 0 && self.a.grey && self.b.grey {
            "Y"
        } else {
            CHANNELS[channel]
        }
    }

    /// Advances both pictures to the next row, which must exist.
    pub(super) fn advance(&mut self) -> Result<(), Failure> {
        let [a, b] = &self.paths;
        for (picture, path) in [(&mut self.a, a), (&mut self.b, b)] {
            let row = picture.advance();
            row.map_err(|reason| Failure::unusable(path, &reason))?;
        }
        Ok(())
    }

    /// The columns of the row that can differ. This leaves out columns with the same codes in both files, or without
    /// data in both, if that is known without decoding pixels.
    pub(super) fn columns(&self) -> Range<u32> {
        let width = self.a.size.width;
        if let Some(differing) = self.a.row.differing(&*self.b.row) {
            return differing;
        }
        let held = [&self.a, &self.b].map(|picture| picture.row.held());
        let held = held.into_iter().filter(|held| !held.is_empty());
        let both = held.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
        let both = both.unwrap_or(0..0);
        let both = both.start.min(width)..both.end.min(width);
        // One that neither holds.
        let other = if both.start > 0 { 0 } else { both.end };
        if other < width && self.differences(other) != [0.0; 4] {
            return 0..width;
        }
        both
    }

    /// Divides these columns into runs of equal pixels.
    pub(super) fn runs(&self, columns: Range<u32>) -> impl Iterator<Item = Range<u32>> {
        let mut next = columns.start;
        let rows = [&self.a.row, &self.b.row];
        let mut ends = [next; 2];
        iter::from_fn(move || {
            let start = next;
            for (end, row) in ends.iter_mut().zip(rows) {
                if *end == start && start < columns.end {
                    *end = row.end_of_run(start);
                }
            }
            next = ends[0].min(ends[1]).min(columns.end);
            (start < next).then_some(start..next)
        })
    }

    /// The absolute differences of all four values; infinite if one of the values is not finite.
    pub(super) fn differences(&self, col: u32) -> [f64; 4] {
        let (a, b) = (self.a.row.rgba(col), self.b.row.rgba(col));
        let differences = (DVec4::from(a) - DVec4::from(b)).abs();
        let infinite = DVec4::splat(f64::INFINITY);
        DVec4::select(differences.is_finite_mask(), differences, infinite).to_array()
    }

    /// The difference of a pixel with these differences: the largest among the compared channels.
    pub(super) fn largest(&self, differences: &[f64; 4]) -> f64 {
        let compared = self.channels().iter();
        let compared = compared.map(|&channel| differences[channel]);
        compared.fold(0.0, f64::max)
    }

    /// The largest differences that the rounding of both files can explain.
    pub(super) fn rounding(&self, col: u32) -> [f64; 4] {
        let (a, b) = (self.a.row.rounding(col), self.b.row.rounding(col));
        (DVec4::from(a) + DVec4::from(b)).to_array()
    }

    /// Returns for each value whether one file contains the largest number of its format, and the other file a larger
    /// number.
    pub(super) fn is_clipped(&self, col: u32) -> [bool; 4] {
        let (a, b) = (self.a.row.rgba(col), self.b.row.rgba(col));
        let (full_a, full_b) = (self.a.row.is_full(col), self.b.row.is_full(col));
        [0, 1, 2, 3].map(|channel| {
            let (a, b) = (a[channel], b[channel]);
            full_a[channel] && a < b || full_b[channel] && b < a
        })
    }

    /// The size of both.
    pub(super) fn size(&self) -> Size {
        self.a.size
    }
}
