//! The directions in which a sphere lies, seen from a point.

use glam::{DVec2, DVec3};

/// All directions within an angle of at most 90° of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cap {
    /// A unit vector.
    pub(crate) axis: DVec3,
    /// The sine, the cosine and the versine 1 − cos of the angle. Small angles are accurate in the versine.
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
    pub(crate) versine: f64,
}

/// The versine of the angle between axes from which on their sum is used. Caps so far apart that touch are wide ones: both
/// formulas are accurate there.
const NEARLY_OPPOSITE: f64 = 1.5;

/// What a cap covers of the circle around another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cover {
    Nothing,
    All,
    /// The arc from the first point counterclockwise to the second. A point is a unit vector in the circle's frame.
    Arc([DVec2; 2]),
}

/// Two unit vectors that form a frame with the axis of a circle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    x: DVec3,
    y: DVec3,
}

impl Cap {
    /// The directions toward a sphere with this center, seen from the origin. If the origin is inside the sphere, it
    /// counts as a point of its surface.
    pub(crate) fn of_sphere(center: DVec3, radius: f64) -> Self {
        let distance = center.length();
        let sine = (radius / distance).min(1.0);
        let apart = (distance - radius).max(0.0);
        let cosine = (apart * (distance + radius)).sqrt() / distance;
        Self {
            axis: center / distance,
            sine,
            cosine,
            versine: sine * sine / (1.0 + cosine),
        }
    }

    /// The directions below the plane across a unit normal.
    pub(crate) fn below(normal: DVec3) -> Self {
        Self {
            axis: -normal,
            sine: 1.0,
            cosine: 0.0,
            versine: 1.0,
        }
    }

    /// The directions within an angle in radians, at most a right one, of a unit vector.
    pub(crate) fn within(axis: DVec3, angle: f64) -> Self {
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        Self {
            axis,
            sine,
            cosine,
            versine: sine * sine / (1.0 + cosine),
        }
    }

    /// The solid angle.
    pub(crate) fn solid_angle(&self) -> f64 {
        std::f64::consts::TAU * self.versine
    }

    /// The frame of the circle around the cap.
    ///
    /// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6 (2017).
    pub(crate) fn frame(&self) -> Frame {
        let DVec3 { x, y, z } = self.axis;
        let sign = 1_f64.copysign(z);
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        Frame {
            x: DVec3::new(1.0 + sign * x * x * a, sign * b, -sign * x),
            y: DVec3::new(b, sign + y * y * a, -y),
        }
    }

    /// The point of the circle around the cap that a unit vector in its frame leads to, less `origin`.
    pub(crate) fn point(&self, frame: &Frame, at: DVec2, origin: DVec3) -> DVec3 {
        // The difference of axes is exact where they are close.
        (self.axis - origin) - self.axis * self.versine
            + (frame.x * at.x + frame.y * at.y) * self.sine
    }

    /// What another cap covers of the circle around this one. Of two equal caps `is_first` tells whether this one counts
    /// as the larger one.
    ///
    /// With the versines u of this cap, v of the other and w of the angle between the axes, the circles cross if
    /// D = 4 u v − (w − u − v)² − 2 u v w is positive. The covered arc is centered on the other axis, and its half width has
    /// the tangent √D / t, where t = u + w − v − u w. If the axes are nearly opposite, these formulas cancel; their sum
    /// takes the place of their difference then.
    pub(crate) fn covered(&self, frame: &Frame, other: &Self, is_first: bool) -> Cover {
        let (u, v) = (self.versine, other.versine);
        let difference = other.axis - self.axis;
        let w = 0.5 * difference.length_squared();
        let (across, discriminant, t);
        let is_inside;
        if w <= NEARLY_OPPOSITE {
            let excess = w - u - v;
            across = difference;
            discriminant = 4.0 * u * v - excess * excess - 2.0 * u * v * w;
            t = (u - v) + w * (1.0 - u);
            is_inside = excess + u * v < 0.0;
        } else {
            let sum = other.axis + self.axis;
            let half = 0.5 * sum.length_squared();
            let (c, d) = (self.cosine, other.cosine);
            across = sum;
            discriminant = half * (2.0 - half) - (c + d) * (c + d) + 2.0 * c * d * half;
            t = (c + d) - c * half;
            // Neither is wider than 90°.
            is_inside = false;
        }
        let toward = DVec2::new(across.dot(frame.x), across.dot(frame.y));
        let length = toward.length();
        if discriminant <= 0.0 || length == 0.0 {
            // One contains the other, or they are apart.
            let is_smaller = u < v || (u == v && !is_first);
            return if is_inside && is_smaller {
                Cover::All
            } else {
                Cover::Nothing
            };
        }
        let toward = toward / length;
        let half_width = DVec2::new(t, discriminant.sqrt());
        let half_width = half_width / half_width.length();
        let turned = |sine: f64| {
            DVec2::new(
                toward.x * half_width.x - toward.y * sine,
                toward.y * half_width.x + toward.x * sine,
            )
        };
        Cover::Arc([turned(-half_width.y), turned(half_width.y)])
    }

    /// True if the cap contains another that is smaller, or the same and not `is_first`.
    pub(crate) fn contains(&self, other: &Self, is_first: bool) -> bool {
        if other.versine > self.versine || (other.versine == self.versine && is_first) {
            return false;
        }
        // The angle between the axes is at most the difference of the angles.
        let cosine = self.cosine * other.cosine + self.sine * other.sine;
        self.axis.dot(other.axis) >= cosine
    }
}
