//! A sun with a disc, and the part of its light that reaches a point.

use super::cap::Cap;
use super::point::{Occluders, SurfacePoint};
use super::sky::add_horizons;
use super::visible::{Hidden, share_of};
use crate::model::color::Color;
use crate::search::beyond::Beyond;

/// A light of infinite distance that is not a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sun {
    pub(crate) disc: Cap,
    pub(crate) intensity: Color,
}

/// What a point receives of a sun.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Received {
    /// E₀, what it would receive of the whole disc if there were no other sphere.
    pub(crate) whole: f64,
    /// The share of that which no other sphere hides.
    pub(crate) share: f64,
}

impl Sun {
    /// What a point receives.
    pub(crate) fn received(
        &self,
        point: &SurfacePoint,
        occluders: Option<&Occluders<'_>>,
        hidden: &mut Hidden,
    ) -> Received {
        let disc = &self.disc;
        let heights = [point.normal, point.shading].map(|normal| normal.dot(disc.axis));
        if heights[0].min(heights[1]) <= -disc.sine {
            return Received::default();
        }
        hidden.clear();
        let is_above = heights[0].min(heights[1]) >= disc.sine;
        let whole = if is_above {
            // s² π n·a over the solid angle.
            heights[1] * 0.5 * (1.0 + disc.cosine)
        } else {
            add_horizons(point, hidden);
            share_of(hidden.seen_of(disc), point.shading, disc)
        };
        if whole <= 0.0 {
            return Received::default();
        }
        let horizons = hidden.len();
        if let Some(occluders) = occluders {
            let toward = Beyond::Cone {
                apex: point.position,
                around: 0.0,
                axis: disc.axis,
                sine: disc.sine,
                cosine: disc.cosine,
            };
            occluders.for_each(point, &toward, |cap| hidden.add(cap));
        }
        if hidden.len() == horizons {
            return Received { whole, share: 1.0 };
        }
        let seen = share_of(hidden.seen_of(disc), point.shading, disc);
        Received {
            whole,
            share: (seen / whole).clamp(0.0, 1.0),
        }
    }
}
