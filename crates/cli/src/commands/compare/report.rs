//! The results that `marbles compare` prints.
//!
//! Every row begins with a fixed name. Differences have four digits and are rounded up.

use super::difference_picture::DifferencePicture;
use super::pair::Pair;
use super::statistics::{Difference, Statistics};
use crate::base::numbers::{bound, bound_with, short};
use crate::base::shown::Shown;
use crate::base::size::Size;
use crate::commands::args::CompareArguments;
use crate::formats::picture::Picture;

/// Width of the column with the names of rows.
const NAMES: usize = 12;
/// Digits after the decimal point of a difference.
const DIGITS: usize = 3;

/// All that is known about two pictures.
pub(super) struct Report<'a> {
    pub(super) arguments: &'a CompareArguments,
    pub(super) pair: &'a Pair,
    pub(super) statistics: &'a Statistics,
    pub(super) difference_picture: Option<&'a DifferencePicture>,
}

impl Report<'_> {
    pub(super) fn lines(&self) -> Vec<String> {
        let Self {
            arguments,
            pair,
            statistics,
            ..
        } = self;
        let mut rows = vec![
            ("A", format!("{}: {}", arguments.a.shown(), about(&pair.a))),
            ("B", format!("{}: {}", arguments.b.shown(), about(&pair.b))),
        ];
        let worst = statistics.worst.first();
        rows.push(("largest", self.largest(worst)));
        rows.push(("rms", difference(statistics.rms)));
        rows.push(("99.9 %", difference(statistics.percentile)));
        if let Some(tolerance) = arguments.tolerance {
            let over = self.count(statistics.over_tolerance);
            rows.push(("over", format!("{over}, tolerance {tolerance:e}")));
        }
        if let Some(worst) = worst {
            rows.push(("rounding", Self::rounding(worst)));
            let beyond = self.count(statistics.beyond_rounding);
            rows.push(("beyond", format!("{beyond}, differ by more than rounding")));
        }
        if statistics.clipped > 0 {
            let clipped = self.count(statistics.clipped);
            rows.push((
                "clipped",
                format!("{clipped}, of these, too bright for a file"),
            ));
        }
        if let Some((col, row)) = statistics.first_not_finite {
            let count = self.count(statistics.not_finite);
            let first = format!("the first in column {col}, row {row}");
            rows.push(("not finite", format!("{count}, {first}")));
        }
        rows.extend(self.worst_pixels());
        if let Some(picture) = self.difference_picture {
            let scale = picture.scale(arguments.tolerance);
            rows.push(("diff", format!("{}: {scale}", picture.path().shown())));
        }
        rows.into_iter()
            .map(|(name, text)| format!("{name:NAMES$}{text}"))
            .collect()
    }

    fn largest(&self, worst: Option<&Difference>) -> String {
        match worst {
            None => format!("{}, the pictures are the same", difference(0.0)),
            Some(worst) => format!(
                "{} in {}, column {}, row {}",
                difference(worst.size),
                self.pair.name(worst.channel),
                worst.col,
                worst.row
            ),
        }
    }

    /// The rounding of both files at the pixel with the largest difference.
    fn rounding(worst: &Difference) -> String {
        let [a, b] = worst.rounding;
        format!(
            "{} at the largest: {} of A, {} of B",
            difference(a + b),
            difference(a),
            difference(b)
        )
    }

    /// `12 of 360000 pixels, fraction 3.4e-05`.
    fn count(&self, count: u64) -> String {
        let pixels = self.statistics.pixels;
        let fraction = bound(count as f64 / pixels as f64);
        format!("{count} of {pixels} pixels, fraction {fraction}")
    }

    /// A table of the worst pixels, under a line of titles.
    fn worst_pixels(&self) -> Vec<(&'static str, String)> {
        let worst = &self.statistics.worst;
        let worst = &worst[..worst.len().min(self.arguments.worst)];
        let mut lines = Vec::new();
        if !worst.is_empty() {
            let titles = ["column", "row", "in", "A", "B", "difference", "rounding"];
            lines.push(("worst", line(titles)));
        }
        for &Difference {
            col,
            row,
            channel,
            size,
            values: [a, b],
            rounding,
        } in worst
        {
            let cells = [
                &*col.to_string(),
                &row.to_string(),
                self.pair.name(channel),
                &short(a),
                &short(b),
                &difference(size),
                &difference(rounding.iter().sum()),
            ];
            lines.push(("", line(cells)));
        }
        lines
    }
}

fn about(picture: &Picture) -> String {
    let Size { width, height } = picture.size;
    format!("{width} x {height}, {}", picture.description)
}

/// Four digits, rounded up.
fn difference(size: f64) -> String {
    bound_with(size, DIGITS)
}

/// The cells of a table row, aligned with those of the other rows.
fn line(cells: [&str; 7]) -> String {
    let [col, row, channel, a, b, difference, rounding] = cells;
    format!("{col:>6}  {row:>6}  {channel:>2}  {a:>10}  {b:>10}  {difference:>10}  {rounding:>10}")
}
