//! A sun with a disc, and the part of its light that reaches a point.

use glam::DMat3;

use super::cap::Cap;
use super::edges::Edge;
use super::point::SurfacePoint;
use super::sky::add_horizons;
use super::visible::{Hidden, share_of};
use crate::model::color::Color;

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
    /// The same sun in another frame.
    pub(crate) fn turned(&self, rotation: &DMat3) -> Self {
        let mut turned = *self;
        turned.disc.axis = *rotation * self.disc.axis;
        turned
    }

    /// What a point receives, where some edges may hide a part of the disc.
    pub(crate) fn received(
        &self,
        place: &SurfacePoint,
        edges: &[Edge],
        hidden: &mut Hidden,
    ) -> Received {
        let disc = &self.disc;
        let height = place.least_height(disc.axis);
        if height <= -disc.sine {
            return Received::default();
        }
        hidden.clear();
        let whole = if height >= disc.sine {
            // s² π n·a over the solid angle.
            place.shading.dot(disc.axis) * 0.5 * (1.0 + disc.cosine)
        } else {
            add_horizons(place, hidden);
            share_of(hidden.seen_of(disc), place.shading, disc)
        };
        if whole <= 0.0 {
            return Received::default();
        }
        let mut is_partial = false;
        for edge in edges {
            if matches!(edge, Edge::Horizon { .. }) {
                continue;
            }
            let height = edge.height(place, disc);
            if height.inner < 0.0 {
                return Received { whole, share: 0.0 };
            }
            if height.outer < 0.0 {
                is_partial = true;
                edge.hide(place, hidden);
            }
        }
        if !is_partial {
            return Received { whole, share: 1.0 };
        }
        let seen = share_of(hidden.seen_of(disc), place.shading, disc);
        Received {
            whole,
            share: (seen / whole).clamp(0.0, 1.0),
        }
    }
}
