//! The directions that a sphere hides from a point.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

/// All directions within an angle of at most 90° of an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cap {
    pub(crate) axis: DVec3,
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
    /// The angle in radians.
    pub(crate) angle: f64,
    /// The largest rounding error of axis and angle.
    pub(crate) blur: f64,
}

/// The relative rounding error of vectors.
const ROUNDING: f64 = f64::EPSILON;

impl Cap {
    /// The directions toward a ball whose center is `to_center` away. `power` is the squared distance of the center less the
    /// squared radius. `error` is the rounding error of the point's coordinates.
    pub(crate) fn of_ball(to_center: DVec3, radius: f64, power: f64, error: f64) -> Self {
        let distance = to_center.length();
        let axis = to_center / distance;
        let reach = power.max(0.0).sqrt();
        let cosine = reach / distance;
        let sine = if power <= 0.0 {
            1.0
        } else {
            (radius / distance).min(1.0)
        };
        // The sine is off by the error of the distance, in distances. Where the point touches the ball, that is the square
        // of the angle's error.
        let off = error / distance + ROUNDING;
        Self {
            axis,
            sine,
            cosine,
            angle: libm::atan2(sine, cosine),
            blur: off + (off / cosine.max(f64::MIN_POSITIVE)).min((2.0 * off).sqrt()),
        }
    }

    /// The directions on the other side of the plane across a unit vector.
    pub(crate) fn below(normal: DVec3) -> Self {
        Self {
            axis: -normal,
            sine: 1.0,
            cosine: 0.0,
            angle: FRAC_PI_2,
            blur: ROUNDING,
        }
    }

    /// Returns whether all directions of another cap are within this one, by a margin.
    pub(crate) fn surely_contains(&self, other: &Self) -> bool {
        const MARGIN: f64 = 1e-12;
        angle_between(self.axis, other.axis) + other.angle < self.angle - MARGIN
    }

    /// The directions in which the borders of two caps cross.
    pub(crate) fn crossings(&self, other: &Self) -> Option<[DVec3; 2]> {
        let apart = angle_between(self.axis, other.axis);
        let turn = turn(apart, self.angle, other.angle)?;
        let across = other.axis - self.axis * self.axis.dot(other.axis);
        let across = across.normalize_or_zero();
        let side = self.axis.cross(across);
        let at = |sine: f64| {
            let around = across * libm::cos(turn) + side * sine;
            self.axis * self.cosine + around * self.sine
        };
        let sine = libm::sin(turn);
        Some([at(sine), at(-sine)])
    }
}

/// The angle, in a spherical triangle with these sides, between the first two of them; `None` if there is no such
/// triangle.
pub(crate) fn turn(one: f64, other: f64, opposite: f64) -> Option<f64> {
    let half = 0.5 * (one + other + opposite);
    let sine = |angle: f64| libm::sin(angle);
    let above = sine(half - one) * sine(half - other);
    let below = sine(half) * sine(half - opposite);
    (above > 0.0 && below > 0.0).then(|| 2.0 * libm::atan2(above.sqrt(), below.sqrt()))
}

pub(crate) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}
