//! The soft lights of a world, and what changes along a surface under them.

use glam::DVec3;
use marbles_core::{Highlight, Sky, World};

use super::cap::{Cap, angle_between};
use super::point::{Place, Seen};
use crate::reference::ball::Ball;
use crate::reference::light::Spot;
use crate::reference::patch::{Candidate, Patch};

/// A light with a disc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sun {
    pub(crate) toward: DVec3,
    /// Half of the angle that it has across, in radians.
    pub(crate) half: f64,
}

/// The soft lights of a world.
#[derive(Clone, Debug)]
pub(crate) struct Softness {
    /// For each light its disc, if it has one.
    pub(crate) suns: Vec<Option<Sun>>,
    pub(crate) sky: Option<Sky>,
}

/// What is the same at points between which the light of a sun changes smoothly: which spheres reach into its disc, which
/// cover it, and how much of it is above the horizon. Hashed; 0 where there is no light.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(crate) struct SoftState(u64);

/// A function of points.
type Border<'a> = Box<dyn Fn(&Spot) -> f64 + 'a>;

/// Of a wide sun with more occluders than this, they do not count: their borders would cut a pixel into too many pieces, and
/// its light is smooth enough.
const MANY: usize = 12;
const WIDE: f64 = 0.2;

impl Softness {
    pub(crate) fn of(world: &World) -> Self {
        let suns = world.lights.iter().map(|light| {
            light.sun().map(|sun| Sun {
                toward: sun.toward(),
                half: 0.5 * sun.diameter(),
            })
        });
        Self {
            suns: suns.collect(),
            sky: world.sky,
        }
    }

    /// Returns whether there is any.
    pub(crate) fn is_any(&self) -> bool {
        self.sky.is_some() || self.suns.iter().any(Option::is_some)
    }
}

impl Sun {
    /// Returns whether the borders of occluders count.
    fn has_borders(&self, casters: &[usize]) -> bool {
        self.half < WIDE || casters.len() <= MANY
    }

    /// The angle between the middle of the disc and that of a ball, and the angle of the ball, seen from a point.
    fn beside(&self, ball: &Ball, point: DVec3) -> [f64; 2] {
        let cap = cap(ball, point, 0.0);
        [angle_between(self.toward, cap.axis), cap.angle]
    }

    /// Functions of points of a surface that change their sign where the horizon, or a ball, begins or ceases to hide a part
    /// of the disc.
    pub(crate) fn borders<'a>(&self, balls: &'a [Ball], casters: &'a [usize]) -> Vec<Border<'a>> {
        let Self { toward, half } = *self;
        let height = |sine: f64| -> Border<'a> {
            Box::new(move |spot: &Spot| spot.normal.dot(toward) - sine)
        };
        let sine = libm::sin(half);
        let mut borders = vec![height(-sine), height(sine)];
        if !self.has_borders(casters) {
            return borders;
        }
        let sun = *self;
        for &caster in casters {
            let ball = &balls[caster];
            borders.push(Box::new(move |spot| {
                let [apart, angle] = sun.beside(ball, spot.point);
                apart - angle - half
            }));
            borders.push(Box::new(move |spot| {
                let [apart, angle] = sun.beside(ball, spot.point);
                apart - (angle - half).abs()
            }));
        }
        borders
    }

    /// Returns whether a ball may hide a part of the disc from a point within a distance of another.
    pub(crate) fn may_be_hidden(&self, ball: &Ball, from: DVec3, around: f64) -> bool {
        let to_center = ball.center - from;
        let (distance, reach) = (to_center.length(), (ball.radius + around) * (1.0 + 1e-9));
        distance <= reach
            || angle_between(self.toward, to_center)
                <= self.half + libm::asin(reach / distance) + 1e-9
    }
}

/// The directions in which a ball lies, seen from a point near the rounding error `error`.
fn cap(ball: &Ball, point: DVec3, error: f64) -> Cap {
    Cap::of_ball(
        ball.center - point,
        ball.radius,
        ball.power_from(point),
        error,
    )
}

impl Patch<'_> {
    /// The rounding error of the coordinates of a ball, seen from a point.
    fn error_beside(&self, ball: &Ball, point: DVec3) -> f64 {
        let eye = self.stage.view.camera.position.length();
        0.5 * f64::EPSILON * (eye + point.length() + ball.center.length())
    }

    fn place(&self, candidate: &Candidate, spot: &Spot) -> Place {
        let error = self.error_beside(&candidate.ball, spot.point);
        Place {
            normal: candidate.ball.normal(spot.point).normalize(),
            shading: spot.normal,
            is_bumpy: self
                .stage
                .world
                .material(candidate.sphere)
                .roughness
                .is_some(),
            blur: error / candidate.ball.radius,
        }
    }

    /// Returns whether a point is inside of one of some balls, which hides all light from it. Points where surfaces meet are not.
    fn is_inside(&self, casters: &[usize], point: DVec3) -> bool {
        const ROUNDING: f64 = 1e-12;
        casters.iter().any(|&caster| {
            let ball = &self.stage.balls[caster];
            let squares = ball.radius * ball.radius + point.length_squared();
            ball.power_from(point) < -ROUNDING * squares
        })
    }

    fn caps<'a>(
        &'a self,
        casters: &'a [usize],
        point: DVec3,
    ) -> impl Iterator<Item = Cap> + use<'a> {
        casters.iter().map(move |&caster| {
            let ball = &self.stage.balls[caster];
            cap(ball, point, self.error_beside(ball, point))
        })
    }

    /// What is seen of a sun.
    pub(super) fn of_sun(
        &self,
        sun: &Sun,
        (candidate, casters): (&Candidate, &[usize]),
        spot: &Spot,
    ) -> Seen {
        let place = self.place(candidate, spot);
        let caps = self.caps(casters, spot.point);
        place.under_sun(sun.toward, sun.half, caps, self.fine)
    }

    /// What is seen of the sky.
    pub(super) fn of_sky(&self, sky: &Sky, candidate: &Candidate, spot: &Spot) -> Seen {
        let place = self.place(candidate, spot);
        let caps = self.caps(&candidate.sky_casters, spot.point);
        let up = (sky.above() != sky.below()).then(|| sky.up());
        place.under_sky(up, caps, self.fine)
    }

    /// The light of all suns and the sky that a point reflects toward the eye, if it is seen in a direction.
    pub(crate) fn soft_light(&self, candidate: &Candidate, spot: &Spot, direction: DVec3) -> DVec3 {
        let world = self.stage.world;
        let material = world.material(candidate.sphere);
        let albedo = world.albedo(candidate.sphere);
        let mut light = DVec3::ZERO;
        for (number, sun) in self.stage.softness.suns.iter().enumerate() {
            let Some(sun) = sun else { continue };
            let casters = (candidate, &candidate.casters[number][..]);
            if self.state(sun, casters, spot).is_dark() {
                continue;
            }
            let seen = self.of_sun(sun, casters, spot);
            let diffuse = albedo * libm::pow(seen.whole, material.exponent);
            let shine = self.shine(sun, material.highlight.as_ref(), spot, direction);
            let intensity = world.lights[number].intensity();
            light += (diffuse + shine) * intensity * seen.share();
        }
        if let Some(sky) = &self.stage.softness.sky
            && !self.is_inside(&candidate.sky_casters, spot.point)
        {
            let seen = self.of_sky(sky, candidate, spot);
            light += albedo * (sky.below() * (seen.free - seen.above) + sky.above() * seen.above);
        }
        light
    }

    /// The highlight of a whole sun: that of its middle, if this is above the surface.
    pub(crate) fn shine(
        &self,
        sun: &Sun,
        highlight: Option<&Highlight>,
        spot: &Spot,
        direction: DVec3,
    ) -> f64 {
        let Some(highlight) = highlight else {
            return 0.0;
        };
        let cosine = spot.normal.dot(self.half_way(sun.toward, direction));
        if cosine <= 0.0 || spot.normal.dot(sun.toward) <= 0.0 {
            return 0.0;
        }
        highlight.strength * libm::pow(cosine, highlight.shininess)
    }

    /// The state of a sun at a point.
    pub(crate) fn state(
        &self,
        sun: &Sun,
        (candidate, casters): (&Candidate, &[usize]),
        spot: &Spot,
    ) -> SoftState {
        if self.is_inside(casters, spot.point) {
            return SoftState(0);
        }
        let sine = libm::sin(sun.half);
        let mut state = 1;
        for normal in [candidate.ball.normal(spot.point), spot.normal] {
            let height = normal.dot(sun.toward);
            if height <= -sine {
                return SoftState(0);
            }
            state = mixed(state, u64::from(height >= sine));
        }
        if !sun.has_borders(casters) {
            return SoftState(state);
        }
        for &caster in casters {
            let [apart, angle] = sun.beside(&self.stage.balls[caster], spot.point);
            if apart + sun.half <= angle {
                return SoftState(0);
            }
            if apart < angle + sun.half {
                let is_inside = apart + angle <= sun.half;
                state = mixed(state, 2 * caster as u64 + 2 + u64::from(is_inside));
            }
        }
        SoftState(state)
    }
}

impl SoftState {
    pub(crate) fn is_dark(self) -> bool {
        self.0 == 0
    }

    /// The states of several suns as one.
    pub(crate) fn and(self, other: Self) -> Self {
        Self(mixed(self.0, other.0))
    }
}

/// A hash of a number and one more.
fn mixed(state: u64, more: u64) -> u64 {
    let mixed =
        (state ^ more.wrapping_mul(0x9e37_79b9_7f4a_7c15)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (mixed ^ (mixed >> 29)).wrapping_add(1)
}
