//! The part of space in which a cell sees a sphere.

use glam::{DVec2, DVec3};

use crate::edges::cell::{Ball, Cell};
use crate::numeric::pair::both;
use crate::numeric::polynomial::{Linear, Quadratic};
use crate::numeric::rounding::{GEOMETRY_SLACK, WIDER};

/// The part of space in which a cell sees a sphere: all that lies within `around` of the way between
/// two points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    pub(crate) ends: [DVec3; 2],
    pub(crate) around: f64,
    /// Whether the rays are parallel, which do not diverge.
    pub(super) is_parallel: bool,
}

/// The distance from a point, at least, of all that lies within widths of the way between two ends, which grow along it.
///
/// # Source
/// At w along a way of the length L a part is as wide as `start` + b w. From a point x beside the way and l along it
/// the least of √(x² + (w − l)²) − b w lies at w − l = b x / √(1 − b²).
pub(super) fn distance_from_cone(
    [start, end]: [DVec3; 2],
    [around, around_end]: [f64; 2],
    point: DVec3,
) -> f64 {
    let way = end - start;
    let length = way.length();
    if !(length > 0.0 && length.is_finite()) {
        return ((start - point).length() - around_end).max(0.0);
    }
    let unit = way / length;
    let along = (point - start).dot(unit);
    let aside = (point - start - unit * along).length();
    let wider = (around_end - around) / length;
    let share = if wider < 1.0 {
        let rest = ((1.0 - wider) * (1.0 + wider)).sqrt();
        (along + aside * wider / rest).clamp(0.0, length)
    } else {
        length
    };
    let further = share - along;
    let distance = (aside * aside + further * further).sqrt();
    (distance - around - wider * share).max(0.0)
}

/// The side of another sphere's surface on which all of a patch lies.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Side {
    Inside,
    Outside,
}

impl Patch {
    /// For an eye outside. The ray d through the middle of the cell is off by half its diagonal at
    /// most; with Q = B² − A K ≥ 0, t = K / (B + √Q) lies between K / (B⁺ + √Q⁺) and √(K / A⁻).
    pub(crate) fn new(cell: &Cell, ball: &Ball, discriminant: &Quadratic, along: &Linear) -> Self {
        if cell.is_parallel() {
            return Self::of_parallel_rays(cell, ball, discriminant);
        }
        let k = ball.outside;
        let spread = discriminant.spread();
        let (lowest, highest) = (discriminant.one - spread, discriminant.one + spread);
        let half = 0.5 * (along.x.abs() + along.y.abs());
        let half_diagonal = 0.5 * DVec2::from_array(cell.size).length();
        let shortest = (cell.middle.length() - half_diagonal).max(1.0);
        let nearest = k / (along.one + half + highest.max(0.0).sqrt());
        let mut farthest = k.sqrt() / shortest;
        if along.one > half {
            farthest = farthest.min(k / (along.one - half + lowest.max(0.0).sqrt()));
        }
        Self {
            ends: [cell.middle * nearest, cell.middle * farthest],
            around: farthest * half_diagonal * WIDER
                + GEOMETRY_SLACK * farthest * cell.middle.length(),
            is_parallel: false,
        }
    }

    /// For parallel rays, which all begin outside: they meet the sphere at c_z − √Q = K' / (c_z + √Q), with K' of where
    /// they begin.
    fn of_parallel_rays(cell: &Cell, ball: &Ball, discriminant: &Quadratic) -> Self {
        let spread = discriminant.spread();
        let root = |square: f64| square.max(0.0).sqrt();
        let z = ball.center.z;
        let roots = both([spread, -spread], |spread| root(discriminant.one + spread));
        let [nearest, farthest] = if ball.is_apart() {
            roots.map(|root| z - root)
        } else {
            let power = ball.power_of(cell.middle.with_z(0.0));
            let around = both([-spread, spread], |spread| power + spread);
            both([0, 1], |end| around[end] / (z + roots[end]))
        };
        // Nothing is seen behind the plane, and no near side behind the center.
        let [nearest, farthest] = both([nearest, farthest], |place| place.min(z).max(0.0));
        let half_diagonal = 0.5 * DVec2::from_array(cell.size).length();
        let size = if ball.is_apart() {
            cell.extent() + ball.center.length() + ball.radius
        } else {
            cell.extent() + farthest.abs()
        };
        Self {
            ends: [cell.at(nearest), cell.at(farthest)],
            around: half_diagonal * WIDER + GEOMETRY_SLACK * size,
            is_parallel: true,
        }
    }

    /// The distance of all of it from a point, at least.
    pub(crate) fn distance_from(&self, point: DVec3) -> f64 {
        distance_from_cone(self.ends, [self.width_at_start(), self.around], point)
    }

    /// Its widths where it begins and where it ends, if it is far wider there: seen from afar, such as the row of a
    /// floor at the horizon.
    pub(super) fn widths_of_cone(&self) -> Option<[f64; 2]> {
        const FAR: f64 = 2.0;
        let start = self.width_at_start();
        (FAR * start < self.around).then_some([start, self.around])
    }

    /// Its ends, and its widths there: it lies among the points that are no farther from the way between the ends.
    pub(super) fn widths(&self) -> [(DVec3, f64); 2] {
        let [start, end] = self.ends;
        [(start, self.width_at_start()), (end, self.around)]
    }

    /// The least and the largest cosine, from 0 to 1, of the angle between a direction and the way from a point to any of it.
    pub(super) fn cosines_from(&self, point: DVec3, direction: DVec3) -> [f64; 2] {
        const HALF_TURN: f64 = std::f64::consts::PI;
        let [one, other] = both(self.widths(), |(end, around)| {
            let way = end - point;
            let distance = way.length();
            let angle = if around < distance {
                libm::asin(around / distance)
            } else {
                HALF_TURN
            };
            (way / distance, angle)
        });
        let wider = one.1.max(other.1);
        let angle = |a: DVec3, b: DVec3| libm::atan2(a.cross(b).length(), a.dot(b));
        let [of_one, of_other] = both([one.0, other.0], |way| angle(way, direction));
        // Ways between both turn no farther from the nearer one of them than half of how far these are apart.
        let wider = wider + 0.5 * angle(one.0, other.0);
        let nearest = of_one.min(of_other) - wider;
        let farthest = of_one.max(of_other) + wider;
        // What is not a number may be anything.
        if !(nearest.is_finite() && farthest.is_finite()) {
            return [0.0, 1.0];
        }
        let farthest = farthest.min(0.5 * HALF_TURN);
        let nearest = nearest.clamp(0.0, 0.5 * HALF_TURN);
        both([farthest, nearest], |angle| {
            libm::cos(angle).clamp(0.0, 1.0)
        })
    }

    /// Its width where it begins: for rays from an eye, the width grows with the distance.
    fn width_at_start(&self) -> f64 {
        let [start, end] = self.ends;
        if self.is_parallel {
            return self.around;
        }
        let share = start.length() / end.length();
        if share < 1.0 {
            self.around * share
        } else {
            self.around
        }
    }

    /// A ball around it.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        let [start, end] = self.ends;
        (
            0.5 * (start + end),
            0.5 * (end - start).length() + self.around,
        )
    }

    /// The side of the sphere `other` on which all of this patch of `ball` lies, if it is one.
    ///
    /// A point p of a sphere i lies outside of a sphere j where p · w > m, with w = cᵢ − cⱼ and
    /// m = (Kᵢ − Kⱼ) / 2.
    pub(super) fn side_of(&self, ball: &Ball, other: &Ball) -> Option<Side> {
        let w = ball.center - other.center;
        let [k, other_k] = [ball.power, other.power];
        let m = 0.5 * (k - other_k);
        let places = self.ends.map(|point| point.dot(w) - m);
        let slack = GEOMETRY_SLACK * (k.abs() + other_k.abs());
        let around = self.around * w.length() + slack;
        if places[0].min(places[1]) > around {
            Some(Side::Outside)
        } else if places[0].max(places[1]) < -around {
            Some(Side::Inside)
        } else {
            None
        }
    }
}
