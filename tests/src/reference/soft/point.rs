//! The light of a sun or of a sky at a point.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::cap::{Cap, angle_between};
use super::meridians::Meridians;

/// A point of a surface: its outward normal, and the normal with which light is computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) normal: DVec3,
    pub(crate) shading: DVec3,
    pub(crate) is_bumpy: bool,
    /// The rounding error of the normals.
    pub(crate) blur: f64,
}

/// What a point sees of a light.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// The integral of max(0, n·ω) over all directions to the light that the own surface does not hide; of a sun divided by
    /// its solid angle, of a sky by π.
    pub(crate) whole: f64,
    /// The same over those that no other sphere hides, and of them those above a plane.
    pub(crate) free: f64,
    pub(crate) above: f64,
    /// The largest effect of rounding.
    pub(crate) error: f64,
    /// Whether borders of spheres, or of the own horizon, are within the light.
    pub(crate) is_partial: bool,
}

impl Seen {
    /// The part of the light that no other sphere hides.
    pub(crate) fn share(&self) -> f64 {
        if self.whole > 0.0 {
            (self.free / self.whole).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

impl Place {
    fn horizons(&self) -> Vec<Cap> {
        let normals = [self.normal, self.shading];
        let count = if self.is_bumpy { 2 } else { 1 };
        let horizons = normals[..count].iter().map(|&normal| {
            let mut cap = Cap::below(normal);
            cap.blur += self.blur;
            cap
        });
        horizons.collect()
    }

    /// The light of the disc within an angle of a direction.
    pub(crate) fn under_sun(
        &self,
        toward: DVec3,
        half: f64,
        caps: impl Iterator<Item = Cap>,
        tolerance: f64,
    ) -> Seen {
        let solid_angle = 2.0 * TAU * libm::sin(0.5 * half).powi(2);
        let meridians = Meridians::new(toward, half);
        let mut hidden = self.horizons();
        let horizons = hidden.len();
        let light = |hidden: &[Cap]| {
            let [free, _] = meridians.integral(self.shading, hidden, None, solid_angle, tolerance);
            // Rounding must not make it negative: it has no powers then.
            free.max(0.0)
        };
        // A surface that faces the whole disc: s² π n·a over the solid angle.
        let sine = libm::sin(half);
        let heights = [self.normal, self.shading].map(|normal| normal.dot(toward));
        if heights[0].min(heights[1]) <= -sine {
            return Seen::default();
        }
        let faces_it = heights[0].min(heights[1]) > sine;
        let whole = if faces_it {
            heights[1] * libm::cos(0.5 * half).powi(2)
        } else {
            light(&hidden)
        };
        // The length of a circle's part within the disc, over the solid angle.
        let around = |cap: &Cap| TAU * sine.min(cap.sine) / solid_angle;
        let mut error: f64 = hidden.iter().map(|cap| cap.blur).sum::<f64>() * TAU * sine;
        error /= solid_angle;
        if faces_it {
            error = 0.0;
        }
        error += self.blur + f64::EPSILON;
        let mut is_dark = false;
        for cap in caps {
            let apart = angle_between(toward, cap.axis);
            if apart >= half + cap.angle + cap.blur {
                continue;
            }
            is_dark |= apart + half < cap.angle - cap.blur;
            error += around(&cap) * cap.blur;
            hidden.push(cap);
        }
        let free = if is_dark {
            0.0
        } else if hidden.len() == horizons {
            whole
        } else {
            light(&without_contained(&hidden, horizons))
        };
        let error = if is_dark { 0.0 } else { error };
        Seen {
            is_partial: !is_dark && (!faces_it || hidden.len() > horizons),
            whole,
            free,
            above: free,
            error,
        }
    }

    /// The light of a sky of radiance 1, and of its half on one side of a plane.
    pub(crate) fn under_sky(
        &self,
        up: Option<DVec3>,
        caps: impl Iterator<Item = Cap>,
        tolerance: f64,
    ) -> Seen {
        let meridians = Meridians::new(self.shading, 0.5 * PI);
        let mut hidden = self.horizons();
        let horizons = hidden.len();
        hidden.extend(caps.filter(|cap| cap.axis.dot(self.normal) > -cap.sine));
        let more = up.map(Cap::below);
        let blur = |cap: &Cap| cap.blur * TAU * cap.sine / PI;
        let error = self.blur + hidden.iter().map(blur).sum::<f64>();
        let kept = without_contained(&hidden, horizons);
        let light =
            |caps: &[Cap]| meridians.integral(self.shading, caps, more.as_ref(), PI, tolerance);
        let whole = if horizons == 1 {
            1.0
        } else {
            light(&hidden[..horizons])[0]
        };
        let [free, above] = light(&kept);
        Seen {
            is_partial: kept.len() > horizons,
            whole,
            free,
            above,
            error,
        }
    }
}

/// The caps that no other contains, and the first `count` in any case.
fn without_contained(caps: &[Cap], count: usize) -> Vec<Cap> {
    let is_needed = |(index, cap): &(usize, &Cap)| {
        *index < count || !caps.iter().any(|other| other.surely_contains(cap))
    };
    let needed = caps.iter().enumerate().filter(is_needed);
    needed.map(|(_, cap)| *cap).collect()
}
