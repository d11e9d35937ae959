//! The errors of a picture against a reference, and the errors that it claims.

use marbles_core::Image;

use crate::base::size::Size;
use crate::formats::form::color_count;

/// The largest claim of a usable reference pixel: a tenth of the smallest measured tolerance.
pub(super) const LARGEST_UNKNOWN: f64 = 1e-7;
/// A ratio of true and claimed error is meaningful only if the claim is at least this many times that of the reference.
const MARGIN: f64 = 10.0;

/// The errors of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Accuracy {
    /// The root of the mean square, over all channels of all known pixels.
    pub(super) rmse: f64,
    /// The largest error of any channel of any known pixel.
    pub(super) largest: f64,
    /// The largest claim of any known pixel.
    pub(super) largest_claimed: f64,
    /// The median of true over claimed errors, over the pixels for which it is meaningful.
    pub(super) median_of_claimed: Option<f64>,
    /// The number of known pixels whose error is over the tolerance, even with the error of the reference subtracted.
    pub(super) over: u64,
    /// The number of pixels over the tolerance, by measurement or by their own report.
    pub(super) missed: u64,
}

/// Returns whether a pixel of the reference is accurate enough.
pub(super) fn is_known(reference: &Image, (col, row): (u32, u32)) -> bool {
    reference.error(col, row) <= LARGEST_UNKNOWN
}

impl Accuracy {
    /// Compares a picture with a reference of the same size; without a tolerance no pixel is over.
    pub(super) fn of(image: &Image, reference: &Image, tolerance: Option<f64>) -> Self {
        let channels = color_count(image.channels());
        let mut accuracy = Self {
            rmse: 0.0,
            largest: 0.0,
            largest_claimed: 0.0,
            median_of_claimed: None,
            over: 0,
            missed: 0,
        };
        let (mut squares, mut count) = (0.0, 0_u64);
        let mut ratios = Vec::new();
        for (col, row) in places(image) {
            let says_so = image.status(col, row).is_over_tolerance();
            if !is_known(reference, (col, row)) {
                accuracy.missed += u64::from(says_so);
                continue;
            }
            let (values, exact) = (image.rgba(col, row), reference.rgba(col, row));
            let differences = (0..channels).map(|index| (values[index] - exact[index]).abs());
            squares += differences.clone().map(|size| size * size).sum::<f64>();
            count += channels as u64;
            let largest = differences.fold(0.0, f64::max);
            let (claimed, unknown) = (image.error(col, row), reference.error(col, row));
            accuracy.largest = accuracy.largest.max(largest);
            accuracy.largest_claimed = accuracy.largest_claimed.max(claimed);
            if claimed.is_finite() && claimed > 0.0 && claimed >= MARGIN * unknown {
                ratios.push(largest / claimed);
            }
            let is_over = tolerance.is_some_and(|most| largest > most + unknown);
            accuracy.over += u64::from(is_over);
            accuracy.missed += u64::from(is_over || says_so);
        }
        accuracy.rmse = (squares / count.max(1) as f64).sqrt();
        accuracy.median_of_claimed = median(&mut ratios);
        accuracy
    }

    /// The largest true error divided by the largest claimed error.
    pub(super) fn largest_of_claimed(&self) -> Option<f64> {
        let says_something = self.largest_claimed > 0.0 && self.largest_claimed.is_finite();
        says_something.then(|| self.largest / self.largest_claimed)
    }
}

/// The places of all pixels, row by row.
pub(super) fn places(image: &Image) -> impl Iterator<Item = (u32, u32)> {
    let (width, height) = (image.width(), image.height());
    Size { width, height }.places()
}

/// The median: the number in the middle, or the mean of the two in the middle.
pub(super) fn median(numbers: &mut [f64]) -> Option<f64> {
    numbers.sort_unstable_by(f64::total_cmp);
    let middle = numbers.len() / 2;
    let upper = *numbers.get(middle)?;
    if numbers.len() % 2 == 1 {
        return Some(upper);
    }
    Some((numbers[middle - 1] + upper) / 2.0)
}

#[cfg(test)]
mod tests;
