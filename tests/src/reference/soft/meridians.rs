//! Integrals over the directions around an axis, meridian by meridian.

use std::f64::consts::TAU;

use glam::{DVec3, DVec4};

use super::cap::{Cap, angle_between, turn};
use crate::reference::quadrature::integrate;

/// Directions from an axis up to an angle of at most 90°. A meridian is the directions of the same azimuth.
pub(crate) struct Meridians {
    axis: DVec3,
    x: DVec3,
    y: DVec3,
    limit: f64,
}

/// A cap in relation to meridians: the part of its axis along theirs, and the parts across.
struct Turned<'cap> {
    cap: &'cap Cap,
    along: f64,
    x: f64,
    y: f64,
}

/// The distance of azimuths, in radians, below which they count as one.
const CLOSE: f64 = 1e-13;
/// The distance from the border of a cap, as a part of the limit, within which a direction may be on the border.
const MARGIN: f64 = 1e-7;
/// The number of azimuths that divide the turn in any case.
const PARTS: u32 = 3;
const HALVINGS: u32 = 14;

impl Meridians {
    pub(crate) fn new(axis: DVec3, limit: f64) -> Self {
        let (x, y) = axis.any_orthonormal_pair();
        Self { axis, x, y, limit }
    }

    /// The part of a unit vector along the axis, and the parts across. The difference from the axis is exact for small
    /// angles.
    fn parts(&self, vector: DVec3) -> [f64; 3] {
        let along = vector.dot(self.axis);
        let apart = if along > 0.0 {
            vector - self.axis
        } else {
            vector
        };
        [along, apart.dot(self.x), apart.dot(self.y)]
    }

    /// The integrals of max(0, n·ω) over the directions that no cap hides, divided by `unit`: over all of them, and over those
    /// that `more` does not hide either. The caps hide all directions below the plane across n.
    pub(crate) fn integral(
        &self,
        normal: DVec3,
        caps: &[Cap],
        more: Option<&Cap>,
        unit: f64,
        tolerance: f64,
    ) -> [f64; 2] {
        let turned = |cap| {
            let [along, x, y] = self.parts(Cap::axis_of(cap));
            Turned { cap, along, x, y }
        };
        let caps_turned: Vec<Turned<'_>> = caps.iter().map(turned).collect();
        let more_turned = more.map(turned);
        let [along, x, y] = self.parts(normal);
        let mut hidden = Vec::new();
        let mut light = |azimuth: f64| {
            let (sine, cosine) = libm::sincos(azimuth);
            let weight = |from: f64, to: f64| {
                let squares = libm::sin(to - from) * libm::sin(to + from);
                0.5 * (along * squares + (x * cosine + y * sine) * (excess(to) - excess(from)))
            };
            hidden.clear();
            let intervals = caps_turned.iter();
            hidden.extend(intervals.filter_map(|cap| cap.hidden(sine, cosine)));
            let all = visible(&mut hidden, self.limit, &weight);
            let above = match &more_turned {
                Some(more) => {
                    hidden.extend(more.hidden(sine, cosine));
                    visible(&mut hidden, self.limit, &weight)
                }
                None => all,
            };
            DVec4::new(all, above, 0.0, 0.0) / unit
        };
        let azimuths = self.azimuths(caps, more);
        let mut sum = DVec4::ZERO;
        let share = tolerance / azimuths.len() as f64;
        for pair in azimuths.windows(2) {
            sum += integrate(pair[0], pair[1], share, HALVINGS, &mut light).value;
        }
        [sum.x, sum.y]
    }

    /// Azimuths in order, over one turn, between which the visible part of a meridian changes smoothly.
    fn azimuths(&self, caps: &[Cap], more: Option<&Cap>) -> Vec<f64> {
        let all: Vec<&Cap> = caps.iter().chain(more).collect();
        let mut directions = Vec::new();
        let azimuth = |direction: DVec3| {
            let [_, x, y] = self.parts(direction);
            libm::atan2(y, x).rem_euclid(TAU)
        };
        let mut found: Vec<f64> = (0..PARTS)
            .map(|part| TAU * f64::from(part) / f64::from(PARTS))
            .collect();
        for (index, cap) in all.iter().enumerate() {
            let [_, x, y] = self.parts(cap.axis);
            let middle = libm::atan2(y, x);
            let aside = x.hypot(y);
            // Meridians that touch the cap, and those that meet its border at their ends.
            let widths = [
                (cap.sine < aside).then(|| libm::asin(cap.sine / aside)),
                turn(angle_between(self.axis, cap.axis), self.limit, cap.angle),
            ];
            for width in widths.into_iter().flatten() {
                found.extend([middle - width, middle + width].map(|it| it.rem_euclid(TAU)));
            }
            for (number, other) in all[..index].iter().enumerate() {
                let crossings = cap.crossings(other).into_iter().flatten();
                directions.extend(crossings.map(|direction| (direction, [index, number])));
            }
        }
        let margin = MARGIN * self.limit;
        directions.retain(|(direction, own)| {
            angle_between(*direction, self.axis) < self.limit + margin
                && caps
                    .iter()
                    .enumerate()
                    .all(|(index, cap)| own.contains(&index) || !cap.holds(*direction, margin))
        });
        found.extend(
            directions
                .into_iter()
                .map(|(direction, _)| azimuth(direction)),
        );
        found.sort_by(f64::total_cmp);
        found.dedup_by(|a, b| *a - *b < CLOSE);
        found.push(TAU);
        found
    }
}

impl Cap {
    fn axis_of(cap: &Self) -> DVec3 {
        cap.axis
    }

    /// Returns whether a direction is inside, by a margin.
    fn holds(&self, direction: DVec3, margin: f64) -> bool {
        // Most are far outside.
        if self.axis.dot(direction) < self.cosine - margin {
            return false;
        }
        angle_between(self.axis, direction) < self.angle - margin
    }
}

impl Turned<'_> {
    /// The interval of angles from the axis that the cap hides on the meridian of an azimuth.
    fn hidden(&self, sine: f64, cosine: f64) -> Option<[f64; 2]> {
        let Cap {
            sine: of_cap,
            cosine: from_middle,
            ..
        } = *self.cap;
        let aside = self.y * cosine - self.x * sine;
        if aside.abs() >= of_cap {
            return None;
        }
        let middle = libm::atan2(self.x * cosine + self.y * sine, self.along);
        let half = libm::atan2(((of_cap - aside) * (of_cap + aside)).sqrt(), from_middle);
        Some([middle - half, middle + half])
    }
}

/// The integral from 0 to `limit` outside of the hidden intervals.
fn visible(hidden: &mut [[f64; 2]], limit: f64, weight: &impl Fn(f64, f64) -> f64) -> f64 {
    hidden.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut reached, mut sum) = (0.0, 0.0);
    for &[from, to] in &*hidden {
        if from > reached {
            let end = from.min(limit);
            if end > reached {
                sum += weight(reached, end);
            }
        }
        reached = to.max(reached);
    }
    if reached < limit {
        sum += weight(reached, limit);
    }
    sum
}

/// x − sin x cos x, twice the integral of the squared sine.
fn excess(angle: f64) -> f64 {
    if angle > 0.25 {
        return angle - libm::sin(angle) * libm::cos(angle);
    }
    // Half of y³/3! − y⁵/5! + …, for y twice the angle.
    let square = 4.0 * angle * angle;
    let mut sum = 0.0;
    for order in [17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0] {
        sum = square / (order * (order - 1.0)) * (1.0 - sum);
    }
    square * angle / 6.0 * (1.0 - sum)
}

#[cfg(test)]
mod tests {
    use super::excess;

    #[test]
    fn the_series_meets_the_formula() {
        let formula = 0.25 - libm::sin(0.25) * libm::cos(0.25);
        assert!((excess(0.25) - formula).abs() < 1e-16);
        let cube = 2.0 / 3.0 * 1e-9;
        assert!((excess(1e-3) / cube - 1.0).abs() < 3e-7);
    }
}
