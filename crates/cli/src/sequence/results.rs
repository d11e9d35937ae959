//! The results of a picture: the size of its errors, and the number of values that its file could not store.

use marbles_core::{Image, Summary};

use crate::base::size::Size;

/// The results of a picture, or of a part of one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Results {
    /// `None` if there are no pixels yet.
    pub(super) summary: Option<Summary>,
    /// The worst pixel over the tolerance.
    pub(super) worst: Option<WorstPixel>,
    /// The number of clipped pixels of a PNG, or of finite numbers that were too large for an EXR.
    pub(super) clipped: u64,
}

/// The pixel with the largest error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WorstPixel {
    pub(super) col: u32,
    pub(super) row: u32,
    pub(super) error: f64,
}

impl Results {
    /// The results for the part of a picture whose first pixel is (`col`, `row`).
    pub(super) fn of(part: &Image, (col, row): (u32, u32), clipped: u64) -> Self {
        let summary = part.summary();
        let mut worst = None;
        if summary.over_tolerance > 0 {
            let (width, height) = (part.width(), part.height());
            let pixels = Size { width, height }.places();
            let missed = pixels.filter(|&(c, r)| part.status(c, r).is_over_tolerance());
            worst = missed.fold(None, |worst, (c, r)| {
                let error = part.error(c, r);
                let (col, row) = (col + c, row + r);
                WorstPixel::of(worst, Some(WorstPixel { col, row, error }))
            });
        }
        Self {
            summary: Some(summary),
            worst,
            clipped,
        }
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.summary = match (self.summary, &other.summary) {
            (Some(one), Some(other)) => Some(one.and(other)),
            (one, other) => one.or(*other),
        };
        self.worst = WorstPixel::of(self.worst, other.worst);
        self.clipped += other.clipped;
    }
}

impl WorstPixel {
    /// The same with all errors multiplied by `scale`.
    pub(super) fn scaled(self, scale: f64) -> Self {
        Self {
            error: self.error * scale,
            ..self
        }
    }

    /// The worse of two pixels; of equal ones the one farther down, or farther to the right.
    fn of(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        let (Some(first), Some(second)) = (one, other) else {
            return one.or(other);
        };
        let place = |pixel: &Self| (pixel.row, pixel.col);
        let order = first.error.total_cmp(&second.error);
        let order = order.then_with(|| place(&first).cmp(&place(&second)));
        if order.is_gt() { one } else { other }
    }
}

#[cfg(test)]
mod tests;
