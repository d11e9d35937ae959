//! The arcs of a circle that no cap covers.

use glam::DVec2;

/// Arcs of one circle that are covered.
#[derive(Debug, Default)]
pub(crate) struct CoveredArcs {
    arcs: Vec<Arc>,
    is_whole: bool,
}

/// An arc from a point counterclockwise to another.
#[derive(Clone, Copy, Debug)]
struct Arc {
    /// Where it begins and ends, as [`order`] tells; the end may be a turn further.
    begin: f64,
    end: f64,
    points: [DVec2; 2],
}

/// What [`order`] grows by in a turn.
const TURN: f64 = 4.0;

/// A number that grows with the angle of a unit vector, from 0 to less than [`TURN`].
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
        self.is_whole = false;
    }

    /// Puts the arcs into the order of their begins. There are few.
    fn sort(&mut self) {
        for last in 1..self.arcs.len() {
            let mut place = last;
            while place > 0 && self.arcs[place].begin < self.arcs[place - 1].begin {
                self.arcs.swap(place, place - 1);
                place -= 1;
            }
        }
    }

    /// Covers the whole circle.
    pub(crate) fn cover_all(&mut self) {
        self.is_whole = true;
    }

    pub(crate) fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Covers the arc from the first point counterclockwise to the second.
    pub(crate) fn cover(&mut self, points: [DVec2; 2]) {
        let [begin, end] = points.map(order);
        self.arcs.push(Arc {
            begin,
            end: if end < begin { end + TURN } else { end },
            points,
        });
    }

    /// Calls `visit` with the begin and the end of each arc that is not covered; `None` stands for the whole circle.
    pub(crate) fn for_each_exposed(&mut self, mut visit: impl FnMut(Option<[DVec2; 2]>)) {
        if self.is_whole {
            return;
        }
        self.sort();
        let Some(first) = self.arcs.first() else {
            visit(None);
            return;
        };
        // What arcs across the beginning of the order cover of it.
        let across = self.arcs.iter().filter(|arc| arc.end >= TURN);
        let across = across.max_by(|one, other| one.end.total_cmp(&other.end));
        let mut reached = across.map(|arc| (arc.end - TURN, arc.points[1]));
        for arc in &self.arcs {
            if let Some((end, point)) = reached
                && arc.begin > end
            {
                visit(Some([point, arc.points[0]]));
            }
            if reached.is_none_or(|(end, _)| arc.end > end) {
                reached = Some((arc.end, arc.points[1]));
            }
        }
        if across.is_none()
            && let Some((_, point)) = reached
        {
            visit(Some([point, first.points[0]]));
        }
    }
}
