//! Lines of a picture between two ends.

use glam::DVec2;

use super::candidate::Candidate;
use crate::model::camera::Projection;

/// A way from 0 to 1 through an interval, in which functions are smooth that go with the square root of the distance from
/// some of its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub(crate) ends: [f64; 2],
    /// Whether functions go with the square root at the begin, and at the end.
    pub(crate) is_root: [bool; 2],
}

impl Way {
    /// The place in the interval, and by how much it moves where the place on the way does.
    pub(crate) fn at(&self, place: f64) -> (f64, f64) {
        let [begin, end] = self.ends;
        let (share, speed) = match self.is_root {
            [false, false] => (place, 1.0),
            [true, false] => (place * place, 2.0 * place),
            [false, true] => (place * (2.0 - place), 2.0 - 2.0 * place),
            [true, true] => (
                place * place * (3.0 - 2.0 * place),
                6.0 * place * (1.0 - place),
            ),
        };
        (begin + (end - begin) * share, (end - begin) * speed)
    }
}

/// A part of a horizontal or a vertical line of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    pub(crate) is_vertical: bool,
    /// The coordinate across it.
    pub(crate) across: f64,
    pub(crate) along: Way,
}

impl Curve {
    /// On a line between two ends at which a candidate is seen.
    pub(crate) fn new(
        is_vertical: bool,
        across: f64,
        ends: [f64; 2],
        candidate: &Candidate,
        projection: Projection,
    ) -> Self {
        /// Less of what a candidate is met by at an end than in the middle means that a contour is near.
        const NEAR: f64 = 0.1;
        let meets = |along: f64| {
            let (u, v) = if is_vertical {
                (across, along)
            } else {
                (along, across)
            };
            candidate.meets(u, v, candidate.radius, projection)
        };
        let limit = NEAR * meets(0.5 * (ends[0] + ends[1]));
        Self {
            is_vertical,
            across,
            along: Way {
                ends,
                is_root: ends.map(|end| meets(end) < limit),
            },
        }
    }

    pub(crate) fn at(&self, place: f64) -> DVec2 {
        let (along, _) = self.along.at(place);
        if self.is_vertical {
            DVec2::new(self.across, along)
        } else {
            DVec2::new(along, self.across)
        }
    }
}
