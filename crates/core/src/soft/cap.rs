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
    /// The number of the sphere that lies there, or [`NO_SPHERE`].
    pub(crate) sphere: u32,
}

/// Stands for the sphere of a cap that is none's.
pub(crate) const NO_SPHERE: u32 = u32::MAX;

/// The versine of the angle between axes from which on their sum is used. Caps so far apart that touch are wide ones: both
/// formulas are accurate there.
pub(super) const NEARLY_OPPOSITE: f64 = 1.5;

/// How the circle around a cap lies to another cap.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Meeting {
    /// None of it is in the other cap.
    Apart,
    /// All of it is.
    Inside,
    Crossing(Crossing),
}

/// Where a circle enters and leaves another cap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// A vector that points to the middle of the covered arc, but for a part along the circle's axis.
    across: DVec3,
    /// √D and t, whose ratio is the tangent of half of the covered arc.
    pub(super) root: f64,
    pub(super) t: f64,
}

impl Crossing {
    /// Half of the angle of the covered arc.
    pub(super) fn half_width(&self) -> f64 {
        libm::atan2(self.root, self.t)
    }

    /// The vector in the circle's frame that points to the middle of the covered arc.
    #[inline]
    pub(super) fn toward(&self, frame: &Frame) -> DVec2 {
        DVec2::new(self.across.dot(frame.x), self.across.dot(frame.y))
    }
}

/// Two unit vectors that form a frame with the axis of a circle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(super) x: DVec3,
    pub(super) y: DVec3,
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
            sphere: NO_SPHERE,
        }
    }

    /// The directions below the plane across a unit normal.
    pub(crate) fn below(normal: DVec3) -> Self {
        Self {
            axis: -normal,
            sine: 1.0,
            cosine: 0.0,
            versine: 1.0,
            sphere: NO_SPHERE,
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
            sphere: NO_SPHERE,
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

    /// How the circle around this cap lies to another cap. Of two equal caps `is_first` tells whether this one counts as the
    /// larger one.
    ///
    /// With the versines u of this cap, v of the other and w of the angle between the axes, the circles cross if
    /// D = 4 u v − (w − u − v)² − 2 u v w is positive. The covered arc is centered on the other axis, and its half width has
    /// the tangent √D / t, where t = u + w − v − u w. If the axes are nearly opposite, these formulas cancel; their sum
    /// takes the place of their difference then.
    #[inline]
    pub(crate) fn meeting(&self, other: &Self, is_first: bool) -> Meeting {
        let (u, v) = (self.versine, other.versine);
        let difference = other.axis - self.axis;
        let w = difference.length_squared() * 0.5;
        if w > NEARLY_OPPOSITE {
            return self.meeting_of_nearly_opposite(other);
        }
        let excess = w - u - v;
        let uv = u * v;
        let discriminant = uv * 4.0 - excess * excess - uv * w * 2.0;
        if discriminant <= 0.0 || w == 0.0 {
            // One contains the other, or they are apart.
            let is_smaller = u < v || (u == v && !is_first);
            return if is_smaller && excess + uv < 0.0 {
                Meeting::Inside
            } else {
                Meeting::Apart
            };
        }
        Meeting::Crossing(Crossing {
            across: difference,
            root: discriminant.sqrt(),
            t: (u - v) + w * (1.0 - u),
        })
    }

    /// The same of axes that are nearly opposite.
    #[cold]
    fn meeting_of_nearly_opposite(&self, other: &Self) -> Meeting {
        let sum = other.axis + self.axis;
        let half = 0.5 * sum.length_squared();
        let (c, d) = (self.cosine, other.cosine);
        let discriminant = half * (2.0 - half) - (c + d) * (c + d) + 2.0 * c * d * half;
        // Neither is wider than 90°: none contains the other.
        if discriminant <= 0.0 {
            return Meeting::Apart;
        }
        Meeting::Crossing(Crossing {
            across: sum,
            root: discriminant.sqrt(),
            t: (c + d) - c * half,
        })
    }
}
