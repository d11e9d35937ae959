//! A light in relation to points.

use glam::DVec3;
use marbles_core::{Light, LightFalloff};

use super::ball::Ball;

/// A light relative to the viewpoint.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Lamp {
    /// The unit vector toward it.
    Far(DVec3),
    Near {
        position: DVec3,
        /// The distance at which it has its intensity, if it has a falloff.
        reference: Option<f64>,
        /// The direction that it faces, and the power of the cosine of the angle to it.
        facing: Option<(DVec3, f64)>,
    },
}

impl Lamp {
    pub(crate) fn new(light: &Light, eye: DVec3) -> Self {
        match light {
            Light::Directional(light) => Self::Far(light.toward()),
            Light::Point(light) => Self::Near {
                position: light.position() - eye,
                reference: match light.falloff() {
                    LightFalloff::InverseSquare => Some(light.reference()),
                    LightFalloff::None => None,
                },
                facing: light
                    .emission()
                    .map(|emission| (emission.direction(), emission.mu())),
            },
        }
    }

    /// The unit vector toward it from a point, and the factor on its intensity there.
    pub(crate) fn seen_from(&self, point: DVec3) -> (DVec3, f64) {
        match *self {
            Self::Far(toward) => (toward, 1.0),
            Self::Near {
                position,
                reference,
                facing,
            } => {
                let way = position - point;
                let distance = way.length();
                let toward = way / distance;
                let mut factor = reference.map_or(1.0, |reference| (reference / distance).powi(2));
                if let Some((direction, mu)) = facing {
                    let cosine = -toward.dot(direction);
                    factor *= if cosine > 0.0 { cosine.powf(mu) } else { 0.0 };
                }
                (toward, factor)
            }
        }
    }

    /// The distance of a point ahead of the plane beyond which the light sends nothing; `None` if it sends as much in all
    /// directions.
    pub(crate) fn ahead(&self, point: DVec3) -> Option<f64> {
        let Self::Near {
            position,
            facing: Some((direction, _)),
            ..
        } = *self
        else {
            return None;
        };
        Some((point - position).dot(direction))
    }

    /// The circle in which this plane cuts a ball: its middle, the direction that the light faces, and its radius.
    pub(crate) fn cutoff(&self, ball: &Ball) -> Option<(DVec3, DVec3, f64)> {
        let ahead = self.ahead(ball.center)?;
        let Self::Near {
            facing: Some((direction, _)),
            ..
        } = *self
        else {
            return None;
        };
        let radius_sq = (ball.radius - ahead) * (ball.radius + ahead);
        (radius_sq > 0.0).then(|| (ball.center - direction * ahead, direction, radius_sq.sqrt()))
    }

    /// Whether it is inside a ball, whose outer side is then dark.
    pub(crate) fn is_inside(&self, ball: &Ball) -> bool {
        match *self {
            Self::Far(_) => false,
            Self::Near { position, .. } => position.distance(ball.center) <= ball.radius,
        }
    }

    /// A function of points that changes its sign where the shadow of a ball ends, negative if the line to the light
    /// misses the ball; and whether the ball is between the point and the light.
    ///
    /// Between two points, the surface of a ball is met if exactly one of them is inside, or if the line cuts the ball
    /// between them.
    pub(crate) fn shadow(&self, caster: &Ball, point: DVec3) -> (f64, bool) {
        let (toward, _) = self.seen_from(point);
        let (chord_sq, is_ahead) = caster.shadow(point, toward);
        let Self::Near { position, .. } = *self else {
            return (chord_sq, is_ahead);
        };
        let has_point = point.distance(caster.center) <= caster.radius;
        if self.is_inside(caster) || has_point {
            return (1.0, self.is_inside(caster) != has_point);
        }
        let is_behind = (caster.center - position).dot(toward) >= 0.0;
        (chord_sq, is_ahead && !is_behind)
    }
}
