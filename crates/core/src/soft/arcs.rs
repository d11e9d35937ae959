//! The arcs of a circle that no cap covers.

use glam::DVec2;

use crate::numeric::pair::both;

/// Arcs of one circle that are covered: some that are apart, in the order of their begins.
#[derive(Debug, Default)]
pub(crate) struct CoveredArcs {
    arcs: Vec<Arc>,
}

/// An arc from a point counterclockwise to another, which does not pass where [`order`] begins.
#[derive(Clone, Copy, Debug)]
struct Arc {
    /// Where it begins and ends, as [`order`] tells.
    begin: f64,
    end: f64,
    /// These points; an end of the order needs none.
    ends: [End; 2],
}

/// An end of an arc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    /// A vector toward it in the circle's frame.
    pub(crate) at: DVec2,
    /// The number of the cap whose circle crosses there.
    pub(crate) cap: usize,
}

/// What [`order`] grows by in a turn.
const TURN: f64 = 4.0;

/// A number that grows with the angle of a vector, from 0 to [`TURN`].
#[inline]
fn order(at: DVec2) -> f64 {
    let ratio = at.x / (at.x.abs() + at.y.abs());
    if at.y >= 0.0 {
        1.0 - ratio
    } else {
        3.0 + ratio
    }
}

impl CoveredArcs {
    pub(crate) fn clear(&mut self) {
        self.arcs.clear();
    }

    #[inline]
    pub(crate) fn is_whole(&self) -> bool {
        match &self.arcs[..] {
            [only] => only.begin <= 0.0 && only.end >= TURN,
            _ => false,
        }
    }

    /// Covers the arc from the first point counterclockwise to the second, by the cap with some number; vectors toward the
    /// points may have any length.
    #[inline]
    pub(crate) fn cover(&mut self, points: [DVec2; 2], cap: usize) {
        let [begin, end] = both(points, order);
        let ends = both(points, |at| End { at, cap });
        let arc = Arc { begin, end, ends };
        if end < begin {
            self.insert(Arc { end: TURN, ..arc });
            self.insert(Arc { begin: 0.0, ..arc });
        } else if end >= begin {
            self.insert(arc);
        }
    }

    /// Adds an arc to those that it touches.
    fn insert(&mut self, arc: Arc) {
        let arcs = &mut self.arcs;
        let mut first = arcs.len();
        while first > 0 && arcs[first - 1].end >= arc.begin {
            first -= 1;
        }
        let mut last = first;
        while last < arcs.len() && arcs[last].begin <= arc.end {
            last += 1;
        }
        if first == last {
            arcs.insert(first, arc);
            return;
        }
        let end = arcs[last - 1];
        let merged = &mut arcs[first];
        if arc.begin < merged.begin {
            merged.begin = arc.begin;
            merged.ends[0] = arc.ends[0];
        }
        let end = if arc.end > end.end { arc } else { end };
        merged.end = end.end;
        merged.ends[1] = end.ends[1];
        arcs.drain(first + 1..last);
    }

    /// Calls `visit` with the begin and the end of each arc that is not covered, and unit vectors toward them; `None` stands
    /// for the whole circle.
    pub(crate) fn for_each_exposed(&self, mut visit: impl FnMut(Option<[End; 2]>)) {
        let (Some(first), Some(last)) = (self.arcs.first(), self.arcs.last()) else {
            visit(None);
            return;
        };
        let mut between = |one: &Arc, other: &Arc| {
            visit(Some(both([one.ends[1], other.ends[0]], |end| End {
                at: end.at.normalize(),
                ..end
            })));
        };
        for pair in self.arcs.windows(2) {
            between(&pair[0], &pair[1]);
        }
        if first.begin > 0.0 || last.end < TURN {
            between(last, first);
        }
    }
}
