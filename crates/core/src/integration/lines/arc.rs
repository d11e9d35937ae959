//! The circle in which the plane of a line of the retina cuts a sphere.
//!
//! Points of the circle are M + U cos φ + V sin φ, with U toward the viewpoint; with
//! τ = tan(φ / 2) what is seen has τ between −1 and 1, and everything below is a rational function
//! of τ. A silhouette is an ordinary point of it, where the place on the line has slope 0.

use glam::DVec3;

use super::polynomial::quadratic_roots;
use super::scene::Ball;

/// The plane through the viewpoint and a line of the retina: the directions a · along + base.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScanPlane {
    /// Unit, in the direction of the line.
    pub(super) along: DVec3,
    /// Orthogonal to it.
    pub(super) base: DVec3,
    pub(super) base_sq: f64,
}

impl ScanPlane {
    /// The places on the line where the sphere's outline crosses it; not a number for none.
    ///
    /// With K = |c|² − r², the roots of (a c·x + c·w)² − (a² + w²) K, whose discriminant is
    /// K (w² ((c·x)² − K) + (c·w)²): nothing cancels for a viewpoint outside.
    pub(super) fn silhouette(&self, ball: &Ball) -> [f64; 2] {
        let (x, w, k) = (
            ball.center.dot(self.along),
            ball.center.dot(self.base),
            ball.outside,
        );
        let leading = x * x - k;
        let discriminant = k * (self.base_sq * leading + w * w);
        if discriminant.is_nan() || discriminant < 0.0 {
            return [f64::NAN; 2];
        }
        let half = x * w;
        let q = -(half + discriminant.sqrt().copysign(half));
        let in_front = |a: f64| if a * x + w > 0.0 { a } else { f64::NAN };
        [
            in_front(q / leading),
            in_front((w * w - self.base_sq * k) / q),
        ]
    }

    /// The places where the plane p·(c₁ − c₂) = (K₁ − K₂) / 2, in which two spheres intersect, cuts
    /// the first: A m² − 2 B m q + K q² = 0 with q = d·(c₁ − c₂).
    pub(super) fn seam(&self, first: &Ball, second: &Ball) -> [f64; 2] {
        let across = first.center - second.center;
        let m = 0.5 * (first.outside - second.outside);
        let (q1, q0) = (across.dot(self.along), across.dot(self.base));
        let (b1, b0) = (first.center.dot(self.along), first.center.dot(self.base));
        let k = first.outside;
        quadratic_roots(
            m * m - 2.0 * m * b1 * q1 + k * q1 * q1,
            k * q1 * q0 - m * (b1 * q0 + b0 * q1),
            m * m * self.base_sq - 2.0 * m * b0 * q0 + k * q0 * q0,
        )
    }

    /// Distance, in multiples of the direction, at which the sphere is seen; K > 0.
    pub(super) fn distance(&self, ball: &Ball, a: f64) -> Option<f64> {
        let direction_sq = a * a + self.base_sq;
        let along = a * ball.center.dot(self.along) + ball.center.dot(self.base);
        let discriminant = along * along - direction_sq * ball.outside;
        if ball.outside <= 0.0 {
            return Some((along + discriminant.max(0.0).sqrt()) / direction_sq);
        }
        (discriminant >= 0.0 && along > 0.0).then(|| ball.outside / (along + discriminant.sqrt()))
    }
}

/// The part of a sphere that a plane sees, from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    plane: ScanPlane,
    middle: DVec3,
    toward: DVec3,
    across: DVec3,
    radius: f64,
}

/// A point of an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArcPoint {
    /// In the camera's frame.
    pub(super) point: DVec3,
    /// How fast its place on the line changes with τ.
    pub(super) slope: f64,
}

impl Arc {
    pub(super) fn new(plane: &ScanPlane, ball: &Ball) -> Self {
        let normal = plane.along.cross(plane.base).normalize();
        let height = ball.center.dot(normal);
        let middle = ball.center - normal * height;
        let radius = ((ball.radius - height) * (ball.radius + height))
            .max(0.0)
            .sqrt();
        let toward = -middle.normalize_or_zero();
        let across = normal.cross(toward);
        Self {
            plane: *plane,
            middle,
            toward: toward * radius,
            across: across * radius,
            radius,
        }
    }

    /// The parameter of the point seen at a place of the line.
    pub(super) fn parameter(&self, ball: &Ball, a: f64) -> f64 {
        let plane = &self.plane;
        let direction = plane.along * a + plane.base;
        let along = direction.dot(ball.center);
        let direction_sq = a * a + plane.base_sq;
        let root = (along * along - direction_sq * ball.outside)
            .max(0.0)
            .sqrt();
        let point = direction * (ball.outside / (along + root)) - self.middle;
        let sine = point.dot(self.across) / self.radius;
        let cosine = point.dot(self.toward) / self.radius;
        sine / (self.radius + cosine)
    }

    pub(super) fn at(&self, tau: f64) -> ArcPoint {
        let scale = 1.0 / (1.0 + tau * tau);
        let (cosine, sine) = ((1.0 - tau * tau) * scale, 2.0 * tau * scale);
        let point = self.middle + self.toward * cosine + self.across * sine;
        let tangent = (self.across * cosine - self.toward * sine) * (2.0 * scale);
        let plane = &self.plane;
        let (x, w) = (point.dot(plane.along), point.dot(plane.base));
        let (dx, dw) = (tangent.dot(plane.along), tangent.dot(plane.base));
        ArcPoint {
            point,
            slope: plane.base_sq * (dx * w - x * dw) / (w * w),
        }
    }

    /// The place on the line of a parameter.
    pub(super) fn place(&self, tau: f64) -> f64 {
        let point = self.at(tau).point;
        self.plane.base_sq * point.dot(self.plane.along) / point.dot(self.plane.base)
    }

    /// Where n·l = 0.
    pub(super) fn terminator(&self, ball: &Ball, light: DVec3) -> [f64; 2] {
        let rest = (self.middle - ball.center).dot(light);
        let (u, v) = (self.toward.dot(light), self.across.dot(light));
        quadratic_roots(rest - u, v, rest + u)
    }

    /// The Bernstein coefficients, on τ from `low` to `high`, of |P|² − r² (1 + τ²)², where
    /// P / (1 + τ²) is the vector from the caster's center, seen along the light: negative in the
    /// caster's cylinder.
    pub(super) fn shadow(&self, caster: &Ball, light: DVec3, low: f64, high: f64) -> [f64; 5] {
        let flat = |vector: DVec3| vector - light * vector.dot(light);
        let from_caster = self.middle - caster.center;
        let p0 = flat(from_caster + self.toward);
        let p1 = flat(self.across) * 2.0;
        let p2 = flat(from_caster - self.toward);
        // The vector at low + (high − low) s, as a quadratic in Bernstein form.
        let span = high - low;
        let at = |tau: f64| p0 + (p1 + p2 * tau) * tau;
        let slope = p1 + p2 * (2.0 * low);
        let b0 = at(low);
        let b1 = b0 + slope * (0.5 * span);
        let b2 = at(high);
        let (r0, r1, r2) = (1.0 + low * low, 1.0 + low * high, 1.0 + high * high);
        let radius_sq = caster.radius * caster.radius;
        let product = |a: DVec3, b: DVec3, r: f64, s: f64| a.dot(b) - radius_sq * r * s;
        [
            product(b0, b0, r0, r0),
            product(b0, b1, r0, r1),
            (product(b0, b2, r0, r2) + 2.0 * product(b1, b1, r1, r1)) / 3.0,
            product(b1, b2, r1, r2),
            product(b2, b2, r2, r2),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball() -> Ball {
        let (center, radius) = (DVec3::new(0.3, -0.2, 5.0), 1.2);
        Ball {
            center,
            radius,
            outside: center.length_squared() - radius * radius,
        }
    }

    fn plane() -> ScanPlane {
        let base = DVec3::new(0.0, 0.05, 1.0);
        ScanPlane {
            along: DVec3::X,
            base,
            base_sq: base.length_squared(),
        }
    }

    #[test]
    fn outline_is_where_the_line_of_sight_touches() {
        let (ball, plane) = (ball(), plane());
        for place in plane.silhouette(&ball) {
            let direction = plane.along * place + plane.base;
            let foot = ball.center.reject_from(direction);
            assert!((foot.length() - ball.radius).abs() < 1e-14);
        }
    }

    #[test]
    fn points_of_the_arc_lie_on_the_sphere_and_in_the_line_of_sight() {
        let (ball, plane) = (ball(), plane());
        let arc = Arc::new(&plane, &ball);
        for place in [-0.1, 0.0, 0.06, 0.2] {
            let tau = arc.parameter(&ball, place);
            let at = arc.at(tau);
            assert!(((at.point - ball.center).length() - ball.radius).abs() < 1e-14);
            assert!((arc.place(tau) - place).abs() < 1e-14);
            let step = 1e-6;
            let slope = (arc.place(tau + step) - arc.place(tau - step)) / (2.0 * step);
            assert!((slope - at.slope).abs() < 1e-8);
        }
    }

    #[test]
    fn terminator_is_where_the_light_grazes() {
        let (ball, plane, light) = (ball(), plane(), DVec3::new(-0.6, 0.0, -0.8));
        let arc = Arc::new(&plane, &ball);
        for tau in arc.terminator(&ball, light) {
            assert!((arc.at(tau).point - ball.center).dot(light).abs() < 1e-13);
        }
    }

    #[test]
    fn shadow_is_negative_in_the_cylinder_behind_the_caster() {
        let (ball, plane, light) = (ball(), plane(), DVec3::new(-0.6, 0.0, -0.8));
        let arc = Arc::new(&plane, &ball);
        let (center, radius) = (DVec3::new(-0.4, -0.1, 3.0), 0.3);
        let caster = Ball {
            center,
            radius,
            outside: center.length_squared() - radius * radius,
        };
        let (low, high) = (-0.4, 0.3);
        let bernstein = arc.shadow(&caster, light, low, high);
        for step in 0..=10 {
            let s = f64::from(step) / 10.0;
            let tau = low + (high - low) * s;
            let weights = [1.0, 4.0, 6.0, 4.0, 1.0];
            let value: f64 = (0..5)
                .map(|index| {
                    let (power, rest) = (index as i32, 4 - index as i32);
                    bernstein[index] * weights[index] * s.powi(power) * (1.0 - s).powi(rest)
                })
                .sum();
            let from_axis = (arc.at(tau).point - center).reject_from_normalized(light);
            let expected = from_axis.length_squared() - radius * radius;
            let scale = (1.0 + tau * tau) * (1.0 + tau * tau);
            assert!((value / scale - expected).abs() < 1e-13);
        }
    }
}
