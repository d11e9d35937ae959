//! Where a sun begins to be hidden along a curve on a sphere, and where it is hidden altogether.

use super::cap::Cap;
use super::point::SurfacePoint;
use super::visible::Hidden;
use glam::DVec3;

/// What may hide a part of a sun from points of a sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Edge {
    /// Another sphere, in the camera's frame and the units of candidates.
    Sphere { center: DVec3, radius: f64 },
    /// The own surface; with a highlight, which ends where the disc's middle sets.
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
}

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
                }
            }
            Self::Horizon { .. } => {
                let height = place.least_height(disc.axis);
                Height {
                    outer: height - disc.sine,
                    inner: height + disc.sine,
                    wide: disc.sine,
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

/// The places from 0 to 1 at which heights are computed before others are sought between them.
pub(crate) const KNOTS: usize = 5;

/// Steps that find where a height is 0.
const STEPS: u32 = 40;

/// Finds the places from 0 to 1 on a curve at which an edge begins or ceases to hide some of a disc, or all of it: heights
/// are 0 there, to a part of the penumbra's width. With `has_middle` also those at which it hides about half.
///
/// Heights bend little between knots; where one may turn before it reaches 0, its turn is looked at.
pub(crate) fn add_breaks(
    knots: &[Height; KNOTS],
    mut height: impl FnMut(f64) -> Height,
    has_middle: bool,
    breaks: &mut Vec<f64>,
) {
    let kinds: [fn(&Height) -> f64; 3] = [
        |of| of.outer,
        |of| of.inner,
        |of| 0.5 * (of.outer + of.inner),
    ];
    for kind in &kinds[..if has_middle { 3 } else { 2 }] {
        let values = knots.map(|knot| kind(&knot));
        if values.iter().all(|&value| value == values[0]) {
            continue;
        }
        let knot = |index: usize| (index as f64 / (KNOTS - 1) as f64, values[index]);
        for index in 1..KNOTS {
            let (low, high) = (knot(index - 1), knot(index));
            if (low.1 < 0.0) != (high.1 < 0.0) {
                breaks.push(root(low, high, *kind, &mut height));
            }
        }
        for index in 1..KNOTS - 1 {
            let [before, at, after] = [index - 1, index, index + 1].map(knot);
            let is_one_side = (before.1 < 0.0) == (at.1 < 0.0) && (at.1 < 0.0) == (after.1 < 0.0);
            if !is_one_side {
                continue;
            }
            // The parabola through three knots: its turn, if it is nearer to 0 than they are.
            let (slope, bend) = (0.5 * (after.1 - before.1), before.1 - 2.0 * at.1 + after.1);
            if bend * at.1 <= 0.0 || slope.abs() > bend.abs() {
                continue;
            }
            let step = at.0 - before.0;
            let turn = at.0 - slope / bend * step;
            let height_there = kind(&height(turn));
            if (height_there < 0.0) != (at.1 < 0.0) {
                let there = (turn, height_there);
                let (low, high) = if turn < at.0 {
                    (before, at)
                } else {
                    (at, after)
                };
                breaks.push(root(low, there, *kind, &mut height));
                breaks.push(root(there, high, *kind, &mut height));
            }
        }
    }
}

/// Where a height changes its sign, between two places with different ones: by false position, with the values halved at an
/// end that stays (Illinois).
fn root(
    (mut low, mut at_low): (f64, f64),
    (mut high, mut at_high): (f64, f64),
    kind: fn(&Height) -> f64,
    height: &mut impl FnMut(f64) -> Height,
) -> f64 {
    /// The part of a penumbra's half width to which its edge is known.
    const CLOSE: f64 = 0.01;
    let mut place = 0.5 * (low + high);
    let mut moved_high = None;
    for _ in 0..STEPS {
        place = low + (high - low) * (at_low / (at_low - at_high));
        let there = height(place);
        let value = kind(&there);
        if value.abs() <= CLOSE * there.wide {
            break;
        }
        let is_high = (value < 0.0) == (at_high < 0.0);
        if is_high {
            (high, at_high) = (place, value);
            if moved_high == Some(true) {
                at_low *= 0.5;
            }
        } else {
            (low, at_low) = (place, value);
            if moved_high == Some(false) {
                at_high *= 0.5;
            }
        }
        moved_high = Some(is_high);
    }
    place
}

#[cfg(test)]
mod tests;
