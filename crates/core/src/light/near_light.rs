//! Lights at points, as the points that they light see them.

use fearless_simd::Simd;
use glam::DVec3;

use super::lobe::{Beyond, Lobe};
use crate::model::light::PointLight;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// A light at a point, in the frame of the points that it lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearLight {
    pub(crate) position: DVec3,
    /// The distance at which its intensity is what it is said to be, where it falls off with the distance.
    reference: Option<f64>,
    /// The directions in which it sends light, if these are not all.
    pub(crate) lobe: Option<Lobe>,
}

impl NearLight {
    /// A light with this position and this lobe in the frame of the points.
    pub(crate) fn new(light: &PointLight, position: DVec3, lobe: Option<Lobe>) -> Self {
        Self {
            position,
            reference: light.falls_off_from(),
            lobe,
        }
    }

    /// The same light that sends as much in all directions as in the one that it faces.
    pub(crate) fn in_all_directions(self) -> Self {
        Self { lobe: None, ..self }
    }

    /// The unit vectors from points toward the light, and the factors of its intensity there; of points that it faces
    /// away from, as `beyond` says.
    #[inline(always)]
    pub(crate) fn seen_from<S: Simd>(
        &self,
        points: &Vectors<S>,
        beyond: Beyond,
    ) -> (Vectors<S>, f64x8<S>) {
        let (toward, factor) = self.at_distances(points);
        match &self.lobe {
            None => (toward, factor),
            Some(lobe) => (toward, factor * lobe.toward(&toward, beyond)),
        }
    }

    /// The unit vectors from points toward the light, and the factors of its intensity at their distances.
    #[inline(always)]
    pub(crate) fn at_distances<S: Simd>(&self, points: &Vectors<S>) -> (Vectors<S>, f64x8<S>) {
        let simd = points.x.simd();
        let way = Vectors::splat(simd, self.position).minus(points);
        let one = f64x8::splat(simd, 1.0);
        let least = f64x8::splat(simd, f64::MIN_POSITIVE);
        let inverse = one / way.length_squared().max(least).sqrt();
        let factor = match self.reference {
            Some(reference) => (inverse * reference) * (inverse * reference),
            None => one,
        };
        (way.times(inverse), factor)
    }

    /// A bound of the factor of its intensity at a distance and beyond.
    pub(crate) fn most_from(&self, distance: f64) -> f64 {
        self.reference.map_or(1.0, |reference| {
            let ratio = reference / distance.max(0.0);
            // An infinite one would make darkness no number.
            (ratio * ratio).min(f64::MAX.sqrt())
        })
    }
}
