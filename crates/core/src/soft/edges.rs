//! Where a sun begins to be hidden along a curve on a sphere, and where it is hidden altogether.

use glam::DVec3;

use super::cap::Cap;
use super::point::SurfacePoint;
use super::visible::Hidden;
use crate::numeric::pair::both;

/// What may hide a part of a sun from points of a sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Edge {
    /// Another sphere, in the camera's frame and the units of candidates.
    Sphere { center: DVec3, radius: f64 },
    /// The own surface; with a highlight, which ends suddenly.
    Horizon { has_highlight: bool },
}

/// How far a point is from where something begins to hide a sun.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Height {
    /// Positive where nothing of the disc is hidden, and negative where all of it is. Below a sphere both are lengths, and
    /// change by no more than the point moves.
    pub(crate) outer: f64,
    pub(crate) inner: f64,
    /// Half of their difference, unless the sphere is far from the way to the sun.
    pub(crate) wide: f64,
    /// Positive where there is a highlight; of a horizon only.
    pub(crate) highlight: f64,
    /// The radius of the sphere; infinite for a horizon.
    pub(crate) radius: f64,
}

impl Height {
    /// The height over an edge, and a number of the same sign that is quadratic along straight lines: with the distance a from
    /// the middle of a shadow whose radius is r, that is (a² − r²)/2r.
    fn over(&self, edge: usize) -> [f64; 2] {
        let (height, shadow) = match edge {
            OUTER => (self.outer, self.radius + self.wide),
            INNER => (self.inner, self.radius - self.wide),
            _ => return [self.highlight; 2],
        };
        // Behind the point of the cone there is no shadow.
        let factor = if shadow > 0.0 {
            1.0 + 0.5 * height / shadow
        } else {
            1.0
        };
        [height, height * factor]
    }
}

/// The edges at which the disc begins to be hidden, at which all of it is, and at which a highlight ends.
const OUTER: usize = 0;
const INNER: usize = 1;
const HIGHLIGHT: usize = 2;

impl Edge {
    /// The height of a point.
    ///
    /// A sphere touches the disc if the angle between both is at most the sum of the angles that they fill. With the
    /// distances along the sun's direction and across it these are two cones around the sphere's shadow.
    pub(crate) fn height(&self, place: &SurfacePoint, disc: &Cap) -> Height {
        match self {
            Self::Sphere { center, radius } => {
                let to_center = *center - place.position;
                let along = to_center.dot(disc.axis);
                let aside = (to_center - disc.axis * along).length();
                let (near, wide) = (aside * disc.cosine, along * disc.sine);
                // Behind the point of a cone the nearest point is that one.
                let from_point = |is_beside: bool, distance: f64| {
                    if is_beside {
                        distance - radius
                    } else {
                        // It hides nothing, even if rounding puts the point into the sphere.
                        (to_center.length() - radius).max(0.0)
                    }
                };
                let is_near = along * disc.cosine + aside * disc.sine >= 0.0;
                let is_before = along * disc.cosine - aside * disc.sine >= 0.0;
                Height {
                    outer: from_point(is_near, near - wide),
                    inner: from_point(is_before, near + wide),
                    wide: wide.abs(),
                    highlight: 0.0,
                    radius: *radius,
                }
            }
            Self::Horizon { .. } => {
                let height = place.least_height(disc.axis);
                Height {
                    outer: height - disc.sine,
                    inner: height + disc.sine,
                    wide: disc.sine,
                    highlight: place.highlight_height(disc),
                    radius: f64::INFINITY,
                }
            }
        }
    }

    /// Adds the cap of the directions that it hides.
    pub(crate) fn hide(&self, place: &SurfacePoint, hidden: &mut Hidden) {
        if let Self::Sphere { center, radius } = self {
            hidden.add(Cap::of_sphere(*center - place.position, *radius));
        }
    }
}

/// A place from 0 to 1 on a curve at which light is not smooth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Break {
    pub(crate) place: f64,
    /// Tells apart what begins or ends there: the edges of several spheres, and those of one.
    pub(crate) of: usize,
}

/// What is sought on a curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sought {
    /// Also where a highlight ends.
    pub(crate) has_highlight: bool,
    /// True if edges are to be exact, not only known to a part of the penumbra's width.
    pub(crate) is_exact: bool,
    /// A number that tells the edge from others.
    pub(crate) number: usize,
}

/// The places from 0 to 1, evenly apart, at which heights are computed before others are sought between them: on most curves, and
/// on those that turn around a large part of their sphere.
pub(crate) const KNOTS: usize = 5;
pub(crate) const MOST_KNOTS: usize = 2 * KNOTS - 1;

/// Steps that find where a height is 0.
const STEPS: u32 = 40;

/// What is known at a place.
#[derive(Clone, Copy, Debug)]
struct Knot {
    place: f64,
    height: f64,
    /// A number of the same sign that is quadratic along straight lines.
    square: f64,
    wide: f64,
}

impl Knot {
    fn is_below(&self) -> bool {
        self.height < 0.0
    }
}

/// Finds the places from 0 to 1 on a curve at which an edge begins or ceases to hide some of a disc, or all of it: heights
/// are 0 there, to a part of the penumbra's width.
///
/// Heights bend little between knots; where one may turn before it reaches 0, its turn is sought.
pub(crate) fn add_breaks(
    knots: &[Height],
    height: &mut dyn FnMut(f64) -> Height,
    sought: Sought,
    breaks: &mut Vec<Break>,
) {
    /// The part of a penumbra's half width to which an edge is known.
    const CLOSE: f64 = 0.01;
    const EXACT: f64 = 1e-9;
    for edge in OUTER..=if sought.has_highlight {
        HIGHLIGHT
    } else {
        INNER
    } {
        let knot = |place: f64, there: &Height| {
            let [height, square] = there.over(edge);
            Knot {
                place,
                height,
                square,
                wide: there.wide,
            }
        };
        let last_knot = knots.len() - 1;
        let mut of_edge = [knot(0.0, &knots[0]); MOST_KNOTS];
        for (index, there) in knots.iter().enumerate() {
            of_edge[index] = knot(index as f64 / last_knot as f64, there);
        }
        let knots = &of_edge[..knots.len()];
        if knots.iter().all(|knot| knot.height == knots[0].height) {
            continue;
        }
        let close = if sought.is_exact || edge == HIGHLIGHT {
            EXACT
        } else {
            CLOSE
        };
        let mut at = |place: f64| knot(place, &height(place));
        let mut add = |low: Knot, high: Knot, at: &mut dyn FnMut(f64) -> Knot| {
            breaks.push(Break {
                place: root(low, high, close, at),
                of: sought.number * (HIGHLIGHT + 1) + edge,
            });
        };
        for ends in knots.windows(2) {
            if ends[0].is_below() != ends[1].is_below() {
                add(ends[0], ends[1], &mut at);
            }
        }
        let mut last = f64::NEG_INFINITY;
        for near in knots.windows(3) {
            // Between places on different sides something was found already.
            let is_alike = |other: &Knot| other.is_below() == near[1].is_below();
            let [from, to] = both([near[0], near[2]], |end| {
                if is_alike(&end) { end } else { near[1] }.place
            });
            if let Some([low, there, high]) =
                turn([near[0], near[1], near[2]], [from.max(last), to], &mut at)
            {
                add(low, there, &mut at);
                add(there, high, &mut at);
                // The next three places have an interval in common with these.
                let next = usize::from(there.place >= near[1].place) + 1;
                last = near[next].place;
            }
        }
    }
}

/// The turn of a height between three places, if it is on the other side of 0 than the middle one and within an interval whose
/// ends are on the side of that one, and two places beside it. It is sought by parabolas, through places that are closer if it
/// may be much nearer to 0 than they are.
fn turn(
    [mut before, mut middle, mut after]: [Knot; 3],
    [from, to]: [f64; 2],
    at: &mut dyn FnMut(f64) -> Knot,
) -> Option<[Knot; 3]> {
    const STEPS: u32 = 8;
    /// A turn is not sought any further where a height becomes less by a lesser factor.
    const FASTER: f64 = 0.5;
    /// Unless it is less than this part of those beside it.
    const NEAR: f64 = 0.1;
    for _ in 0..STEPS {
        let [low, high] = both([before, after], |one| {
            let away = one.place - middle.place;
            (away, (one.square - middle.square) / away)
        });
        // Of the parabola s + b x + c x².
        let c = (high.1 - low.1) / (high.0 - low.0);
        let b = low.1 - c * low.0;
        let place = middle.place - 0.5 * b / c;
        let is_toward_zero = c * middle.height > 0.0;
        let is_between = place > before.place.max(from) && place < after.place.min(to);
        if !(is_toward_zero && is_between) {
            return None;
        }
        let there = at(place);
        let (low, high) = if place < middle.place {
            (before, middle)
        } else {
            (middle, after)
        };
        if there.is_below() != middle.is_below() {
            return Some([low, there, high]);
        }
        if there.height.abs() <= FASTER * middle.height.abs() {
            (before, middle, after) = (low, there, high);
            continue;
        }
        let nearest = middle.height.abs();
        if nearest > NEAR * before.height.abs().min(after.height.abs()) {
            return None;
        }
        let [low, high] = both([before, after], |one| at(0.5 * (one.place + middle.place)));
        for found in [low, high] {
            let is_between = found.place > from && found.place < to;
            if is_between && found.is_below() != middle.is_below() {
                return Some(if found.place < middle.place {
                    [before, found, middle]
                } else {
                    [middle, found, after]
                });
            }
        }
        (before, after) = (low, high);
    }
    None
}

/// Where a height changes its sign, between two places with different ones, to a part of the penumbra's half width: by false
/// position, with the values halved at an end that stays (Illinois).
fn root(mut low: Knot, mut high: Knot, close: f64, at: &mut dyn FnMut(f64) -> Knot) -> f64 {
    let mut place = 0.5 * (low.place + high.place);
    let mut moved_high = None;
    for _ in 0..STEPS {
        let share = low.height / (low.height - high.height);
        place = low.place + (high.place - low.place) * share;
        let there = at(place);
        if there.height.abs() <= close * there.wide {
            break;
        }
        let is_high = there.is_below() == high.is_below();
        if is_high {
            high = there;
            if moved_high == Some(true) {
                low.height *= 0.5;
            }
        } else {
            low = there;
            if moved_high == Some(false) {
                high.height *= 0.5;
            }
        }
        moved_high = Some(is_high);
    }
    place
}

#[cfg(test)]
mod tests;
