//! The rays through a rectangle of the retina, and the spheres that they may meet.

use glam::DVec3;

use super::ball::Ball;

/// Relative slack in the search for spheres: far above rounding.
pub(super) const SLACK: f64 = 1e-7;

/// All rays of a patch.
pub(super) enum Beam {
    Cone(Cone),
    Cylinder(Cylinder),
}

impl Beam {
    pub(super) fn may_see(&self, ball: &Ball) -> bool {
        match self {
            Self::Cone(cone) => cone.may_see(ball),
            Self::Cylinder(cylinder) => cylinder.may_see(ball),
        }
    }

    /// The ends of a segment, and the distance around it that contains the visible part of a ball.
    pub(super) fn part_of(&self, ball: &Ball) -> ([DVec3; 2], f64) {
        match self {
            Self::Cone(cone) => {
                let (near, far) = cone.distances(ball);
                let around = far * cone.angle.sin() * (1.0 + SLACK) + SLACK * (far - near);
                let start = cone.axis * (near * cone.angle.cos());
                ([start, cone.axis * far], around)
            }
            Self::Cylinder(cylinder) => {
                let along = ball.center.dot(cylinder.forward);
                let at = |t: f64| cylinder.middle + cylinder.forward * t;
                let ends = [at(along - ball.radius), at(along)];
                (ends, cylinder.radius + SLACK * ball.radius)
            }
        }
    }
}

/// All parallel rays within a distance from an axis.
pub(super) struct Cylinder {
    /// The start of the axis.
    pub(super) middle: DVec3,
    pub(super) forward: DVec3,
    pub(super) radius: f64,
}

impl Cylinder {
    pub(super) fn may_see(&self, ball: &Ball) -> bool {
        let from_axis = ball.center - self.middle;
        let along = from_axis.dot(self.forward);
        let aside = (from_axis - self.forward * along).length();
        let slack = SLACK * ball.radius;
        aside <= self.radius + ball.radius + slack && along >= -ball.radius - slack
    }
}

/// All directions within an angle from an axis.
pub(super) struct Cone {
    pub(super) axis: DVec3,
    pub(super) angle: f64,
}

impl Cone {
    pub(super) fn may_see(&self, ball: &Ball) -> bool {
        if ball.has_eye_inside() {
            return true;
        }
        let size = ball.radius.atan2(ball.power.sqrt());
        angle(self.axis, ball.center) <= (size + self.angle) * (1.0 + SLACK) + 1e-15
    }

    /// The range of distances from the viewpoint to the near side of a ball.
    fn distances(&self, ball: &Ball) -> (f64, f64) {
        let between = angle(self.axis, ball.center);
        let distance = |angle: f64| {
            let along = ball.center.length() * angle.cos();
            let chord_sq = along * along - ball.power;
            // Beyond the contour: as far as the contour.
            if angle >= 1.6 || chord_sq <= 0.0 || along <= 0.0 {
                ball.power.sqrt()
            } else {
                ball.power / (along + chord_sq.sqrt())
            }
        };
        let near = distance((between - self.angle).max(0.0) * (1.0 - SLACK));
        let far = distance((between + self.angle) * (1.0 + SLACK));
        (near * (1.0 - 1e-12), far * (1.0 + 1e-12))
    }
}

pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}
