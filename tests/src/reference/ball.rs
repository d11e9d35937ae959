//! A sphere in relation to the viewpoint.

use glam::DVec3;

/// A sphere relative to the viewpoint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// |center|² − radius², computed with twice as many digits: near a floor of radius 10⁶, most digits of the two
    /// agree. At most 0 if the viewpoint is inside or on the surface.
    pub(crate) power: f64,
    /// The direction of all rays, if they are parallel. A ray is then given by its origin, relative to the viewpoint,
    /// instead of its direction.
    pub(crate) forward: Option<DVec3>,
}

impl Ball {
    pub(crate) fn new(center: DVec3, radius: f64, eye: DVec3, forward: Option<DVec3>) -> Self {
        let mut power = Twice::default();
        let mut relative = DVec3::ZERO;
        for axis in 0..3 {
            let (high, low) = exact_sum(center[axis], -eye[axis]);
            relative[axis] = high;
            power.add_product(high, high);
            power.add_product(2.0 * high, low);
            power.add_product(low, low);
        }
        power.add_product(-radius, radius);
        Self {
            center: relative,
            radius,
            power: power.high + power.low,
            forward,
        }
    }

    /// Whether the common viewpoint of all rays is inside.
    pub(crate) fn has_eye_inside(&self) -> bool {
        self.forward.is_none() && self.power <= 0.0
    }

    /// Whether the origin of a ray is inside.
    pub(crate) fn begins_inside(&self, direction: DVec3) -> bool {
        match self.forward {
            None => self.power <= 0.0,
            Some(_) => (self.center - direction).length() <= self.radius,
        }
    }

    /// The radius of the circle in which the ball is cut by the plane in which parallel rays begin.
    pub(crate) fn cut_radius(&self) -> Option<f64> {
        let along = self.center.dot(self.forward?);
        let square = (self.radius - along) * (self.radius + along);
        (square > 0.0).then(|| square.sqrt())
    }

    /// The point of a ray at `t` times its direction.
    pub(crate) fn point(&self, direction: DVec3, t: f64) -> DVec3 {
        match self.forward {
            None => direction * t,
            Some(forward) => direction + forward * t,
        }
    }

    /// The square of half the chord of the line through the viewpoint along `direction`, in scene units; negative if
    /// the line misses the ball.
    pub(crate) fn chord_sq(&self, direction: DVec3) -> f64 {
        if let Some(forward) = self.forward {
            let from_ray = self.center - direction;
            let aside = (from_ray - forward * from_ray.dot(forward)).length();
            return (self.radius - aside) * (self.radius + aside);
        }
        chord_sq(self.center, self.radius, self.power, direction.normalize())
    }

    /// The point where the ray from the viewpoint hits the surface, in multiples of `direction`.
    pub(crate) fn hit(&self, direction: DVec3) -> Option<f64> {
        let chord_sq = self.chord_sq(direction);
        if self.forward.is_some() {
            let t = self.clamped_hit(direction, chord_sq);
            return (chord_sq >= 0.0 && t > 0.0).then_some(t);
        }
        if chord_sq < 0.0 || (!self.has_eye_inside() && self.center.dot(direction) <= 0.0) {
            return None;
        }
        let t = self.clamped_hit(direction, chord_sq);
        (t > 0.0).then_some(t)
    }

    /// Like [`Ball::hit`], for a ray that is known to hit the ball although rounding may contradict.
    pub(crate) fn forced_hit(&self, direction: DVec3) -> f64 {
        self.clamped_hit(direction, self.chord_sq(direction))
    }

    fn clamped_hit(&self, direction: DVec3, chord_sq: f64) -> f64 {
        if let Some(forward) = self.forward {
            let along = (self.center - direction).dot(forward);
            let half = chord_sq.max(0.0).sqrt();
            return if self.begins_inside(direction) {
                along + half
            } else {
                along - half
            };
        }
        let length = direction.length();
        let along = self.center.dot(direction) / length;
        let half = chord_sq.max(0.0).sqrt();
        let distance = if self.has_eye_inside() {
            if along >= 0.0 {
                along + half
            } else {
                -self.power / (half - along)
            }
        } else {
            self.power / (along + half)
        };
        distance / length
    }

    /// A hit of a parallel ray with a ball that is large beside its distance, where [`Ball::hit`] loses digits.
    pub(crate) fn refined_hit(&self, direction: DVec3, t: f64) -> f64 {
        let Some(forward) = self.forward else {
            return t;
        };
        let is_large = direction.length_squared() < self.radius * self.radius;
        if !is_large || self.begins_inside(direction) {
            return t;
        }
        let power = self.power_from(direction);
        let along = (self.center - direction).dot(forward);
        power / (along + (along * along - power).max(0.0).sqrt())
    }

    /// The outward normal at a point of the surface, given relative to the viewpoint.
    pub(crate) fn normal(&self, point: DVec3) -> DVec3 {
        (point - self.center) / self.radius
    }

    /// |center − point|² − radius²; for a large ball near the viewpoint without the cancellation of their large parts.
    pub(crate) fn power_from(&self, point: DVec3) -> f64 {
        if point.length_squared() < self.radius * self.radius {
            self.power + point.dot(point - 2.0 * self.center)
        } else {
            (self.center - point).length_squared() - self.radius * self.radius
        }
    }

    /// The square of half the chord of a ray from `point` (relative to the viewpoint) toward a light, negative if the
    /// ray misses the ball; and whether the chord lies ahead.
    pub(crate) fn shadow(&self, point: DVec3, toward: DVec3) -> (f64, bool) {
        let center = self.center - point;
        let power = self.power_from(point);
        let chord_sq = chord_sq(center, self.radius, power, toward);
        (chord_sq, power < 0.0 || center.dot(toward) > 0.0)
    }
}

/// The square of half the chord of a line through the origin along a unit vector: from the foot of the perpendicular,
/// or, near a large ball, where this cancels, from the power of the origin.
fn chord_sq(center: DVec3, radius: f64, power: f64, unit: DVec3) -> f64 {
    let along = center.dot(unit);
    if center.length_squared() > 4.0 * radius * radius {
        let perpendicular = (center - along * unit).length();
        (radius - perpendicular) * (radius + perpendicular)
    } else {
        along * along - power
    }
}

/// A number as the sum of two doubles.
#[derive(Clone, Copy, Debug, Default)]
struct Twice {
    high: f64,
    low: f64,
}

impl Twice {
    fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        let rest = a.mul_add(b, -product);
        let (high, low) = exact_sum(self.high, product);
        self.high = high;
        self.low += low + rest;
    }
}

/// The rounded sum, and its rounding error.
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}
