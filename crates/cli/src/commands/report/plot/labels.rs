//! Positions for labels next to points, so that they hide neither each other nor the curves.

use crate::commands::svg::{Anchor, Place};

/// The approximate width of a lowercase letter in common fonts.
const LETTER_WIDTH: f64 = 7.0;
/// Above the base line.
const HEIGHT: f64 = 9.0;
/// The distance between the center of a point and its label.
const GAP: f64 = 9.0;

/// The distance between the points of a line that labels must not hide.
const STEP: f64 = 4.0;

/// The places of labels, points and lines.
#[derive(Clone, Debug)]
pub(super) struct Labels {
    area: Box,
    taken: Vec<Box>,
}

/// A rectangle, from its top left to its bottom right corner.
#[derive(Clone, Copy, Debug)]
struct Box {
    low: Place,
    high: Place,
}

/// The side of a point on which a label is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Side {
    Below,
    BelowRight,
    Right,
    Left,
    AboveLeft,
    Above,
}

impl Labels {
    /// No labels yet, and an area for them between the top left and the bottom right corner.
    pub(super) fn within(low: Place, high: Place) -> Self {
        Self {
            area: Box { low, high },
            taken: Vec::new(),
        }
    }

    /// Keeps labels away from a point.
    pub(super) fn avoid(&mut self, (x, y): Place, radius: f64) {
        self.avoid_box((x - radius, y - radius), (x + radius, y + radius));
    }

    /// Keeps labels away from a rectangle, given by its top left and bottom right corner.
    pub(super) fn avoid_box(&mut self, low: Place, high: Place) {
        self.taken.push(Box { low, high });
    }

    /// Keeps labels away from a straight line.
    pub(super) fn avoid_line(&mut self, from: Place, to: Place) {
        let (x, y) = (to.0 - from.0, to.1 - from.1);
        let steps = (x.hypot(y) / STEP).ceil().max(1.0);
        for step in 0..=steps as u32 {
            let along = f64::from(step) / steps;
            self.avoid((from.0 + along * x, from.1 + along * y), 1.0);
        }
    }

    /// The base line of a label on the first of the sides that is free; `None` if no side is free.
    pub(super) fn place(
        &mut self,
        point: Place,
        text: &str,
        sides: &[Side],
    ) -> Option<(Place, Anchor)> {
        let width = text.chars().count() as f64 * LETTER_WIDTH;
        for side in sides {
            let (place, anchor) = side.of(point);
            let left = match anchor {
                Anchor::Start => place.0,
                Anchor::Middle => place.0 - width / 2.0,
                Anchor::End => place.0 - width,
            };
            let needed = Box {
                low: (left, place.1 - HEIGHT),
                high: (left + width, place.1),
            };
            let is_free = self.taken.iter().all(|taken| !taken.meets(&needed));
            if is_free && self.area.contains(&needed) {
                self.taken.push(needed);
                return Some((place, anchor));
            }
        }
        None
    }
}

impl Side {
    fn of(self, (x, y): Place) -> (Place, Anchor) {
        let middle = HEIGHT / 2.0;
        match self {
            Self::Below => ((x, y + GAP + HEIGHT), Anchor::Middle),
            Self::BelowRight => ((x + GAP - 2.0, y + GAP + middle), Anchor::Start),
            Self::Right => ((x + GAP, y + middle), Anchor::Start),
            Self::Left => ((x - GAP, y + middle), Anchor::End),
            Self::AboveLeft => ((x - GAP + 2.0, y - GAP + 2.0), Anchor::End),
            Self::Above => ((x, y - GAP), Anchor::Middle),
        }
    }
}

impl Box {
    fn contains(&self, other: &Self) -> bool {
        self.low.0 <= other.low.0
            && other.high.0 <= self.high.0
            && self.low.1 <= other.low.1
            && other.high.1 <= self.high.1
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.0 < other.high.0
            && other.low.0 < self.high.0
            && self.low.1 < other.high.1
            && other.low.1 < self.high.1
    }
}

#[cfg(test)]
mod tests;
