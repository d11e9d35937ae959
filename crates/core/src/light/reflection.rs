//! The light that points of surfaces reflect toward the eye, eight points at a time.
//!
//! A point with the normal n, seen in the direction −v, sends
//!
//! ```text
//! albedo · (ambient + Σ intensity · max(0, n·l)^exponent)
//!     + Σ intensity · strength · max(0, n·h)^shininess
//! ```
//!
//! with sums over the lights that reach it and that it faces, the direction l toward a light, and h
//! half-way between l and v. Sampling and the exact integrator both compute it here.

use fearless_simd::Simd;
use glam::DVec3;

use crate::model::color::Color;
use crate::model::material::Material;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::power::Power;
use crate::numeric::vectors::Vectors;

/// A power of a cosine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falloff {
    pub(crate) exponent: f64,
    power: Power,
}

/// A material, prepared.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reflectance {
    pub(crate) albedo: Color,
    pub(crate) diffuse: Falloff,
    /// Its strength and falloff.
    pub(crate) highlight: Option<(f64, Falloff)>,
}

/// Points as the eye sees them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewedPoints<'a, S: Simd> {
    normal: &'a Vectors<S>,
    ray: &'a Vectors<S>,
    /// −1 / |ray|; with it, v = ray · scale.
    scale: f64x8<S>,
    /// n · v.
    view_cosine: f64x8<S>,
    has_highlight: bool,
}

impl Falloff {
    pub(crate) fn new(exponent: f64) -> Self {
        Self {
            exponent,
            power: Power::new(exponent),
        }
    }

    /// The power of cosines, which may be negative, or a little above 1 by rounding.
    #[inline(always)]
    pub(crate) fn of<S: Simd>(&self, cosine: f64x8<S>) -> f64x8<S> {
        let zero = f64x8::splat(cosine.simd(), 0.0);
        let one = f64x8::splat(cosine.simd(), 1.0);
        self.of_clamped(cosine.max(zero).min(one))
    }

    /// The power of cosines, continued to negative ones as the same polynomial where it is one of a low degree:
    /// what is analytic is integrated by few samples, and none of them may step over what is lit.
    #[inline(always)]
    pub(super) fn continued<S: Simd>(&self, cosine: f64x8<S>) -> f64x8<S> {
        const HIGHEST: f64 = 5.0;
        if self.exponent.fract() != 0.0 || self.exponent > HIGHEST {
            return self.of(cosine);
        }
        let mut power = cosine;
        for _ in 1..self.exponent as u32 {
            power *= cosine;
        }
        power
    }

    /// The power of cosines from 0 to 1.
    #[inline(always)]
    pub(crate) fn of_clamped<S: Simd>(&self, cosine: f64x8<S>) -> f64x8<S> {
        self.power.lanes(cosine)
    }
}

impl Reflectance {
    pub(crate) fn new(material: &Material) -> Self {
        let highlight = material.highlight.as_ref();
        Self {
            albedo: material.albedo,
            diffuse: Falloff::new(material.exponent),
            highlight: highlight.map(|of| (of.strength, Falloff::new(of.shininess))),
        }
    }

    /// The exponents of diffuse light and of the highlight, which is 0 without one.
    pub(crate) fn exponents(&self) -> [f64; 2] {
        let shininess = self.highlight.map_or(0.0, |(_, falloff)| falloff.exponent);
        [self.diffuse.exponent, shininess]
    }

    /// The light in the brightest channel where the surface faces a light, and at the top of the highlight.
    pub(crate) fn brightest(&self, intensity: Color) -> [f64; 2] {
        let strength = self.highlight.map_or(0.0, |(strength, _)| strength);
        let diffuse = (self.albedo * intensity).max_element();
        [diffuse, strength * intensity.max_element()]
    }

    /// Adds the diffuse light that points with this n · l reflect of a light where `lit` holds, in as many
    /// channels as `sum` has; `color` is albedo · intensity, or the intensity where the albedo comes later.
    /// Without `lit` it goes on, as smooth as it is, where the surface turns from the light.
    #[inline(always)]
    pub(crate) fn add_diffuse<S: Simd>(
        &self,
        color: Color,
        cosine: f64x8<S>,
        lit: Option<mask64x8<S>>,
        sum: &mut [f64x8<S>],
    ) {
        let diffuse = match lit {
            Some(lit) => lit.select(self.diffuse.of(cosine), f64x8::splat(cosine.simd(), 0.0)),
            None => self.diffuse.continued(cosine),
        };
        for (channel, sum) in sum.iter_mut().enumerate() {
            *sum += diffuse * color[channel];
        }
    }

    /// Adds the highlight, if there is one, of a light where `lit` holds, or everywhere without it. Returns
    /// the power of n · h.
    #[inline(always)]
    pub(crate) fn add_highlight<S: Simd>(
        &self,
        intensity: Color,
        half_cosine: f64x8<S>,
        lit: Option<mask64x8<S>>,
        sum: &mut [f64x8<S>],
    ) -> Option<f64x8<S>> {
        let (strength, falloff) = self.highlight.as_ref()?;
        let power = falloff.of(half_cosine);
        let highlight = match lit {
            Some(lit) => lit.select(power, f64x8::splat(power.simd(), 0.0)),
            None => power,
        };
        for (channel, sum) in sum.iter_mut().enumerate() {
            *sum += highlight * (intensity[channel] * strength);
        }
        Some(power)
    }
}

impl<'a, S: Simd> ViewedPoints<'a, S> {
    /// Points with these normals in the directions `ray`, whose squared lengths are `ray_sq`. What only
    /// highlights need is left out without them.
    #[inline(always)]
    pub(crate) fn new(
        normal: &'a Vectors<S>,
        ray: &'a Vectors<S>,
        ray_sq: f64x8<S>,
        has_highlight: bool,
    ) -> Self {
        let mut scale = f64x8::splat(ray_sq.simd(), 0.0);
        let mut view_cosine = scale;
        if has_highlight {
            scale = f64x8::splat(ray_sq.simd(), -1.0) / ray_sq.sqrt();
            view_cosine = normal.dot(ray) * scale;
        }
        Self {
            normal,
            ray,
            scale,
            view_cosine,
            has_highlight,
        }
    }

    /// n · l.
    #[inline(always)]
    pub(crate) fn cosine(&self, toward: DVec3) -> f64x8<S> {
        self.normal.dot_one(toward)
    }

    /// n · h = (n·l + n·v) / |l + v|, with |l + v|² = 2 + 2 l·v, from n · l; 0 without a highlight.
    ///
    /// # Accuracy
    /// The error is some units in the last place over |l + v|²: large where the eye looks along the light,
    /// which only reaches contours there.
    #[inline(always)]
    pub(crate) fn half_cosine(&self, toward: DVec3, cosine: f64x8<S>) -> f64x8<S> {
        if !self.has_highlight {
            return f64x8::splat(cosine.simd(), 0.0);
        }
        let view = self.ray.dot_one(toward) * self.scale;
        (cosine + self.view_cosine) / length_of_sum(view)
    }

    /// [`Self::half_cosine`] for points with unit vectors of their own toward a light.
    #[inline(always)]
    pub(crate) fn half_cosine_of_each(&self, toward: &Vectors<S>, cosine: f64x8<S>) -> f64x8<S> {
        if !self.has_highlight {
            return f64x8::splat(cosine.simd(), 0.0);
        }
        let view = self.ray.dot(toward) * self.scale;
        (cosine + self.view_cosine) / length_of_sum(view)
    }

    /// [`Self::cosine`] for points with unit vectors of their own toward a light.
    #[inline(always)]
    pub(crate) fn cosine_of_each(&self, toward: &Vectors<S>) -> f64x8<S> {
        self.normal.dot(toward)
    }

    /// The change of [`Self::half_cosine`] where the normals change by this, and the view does not.
    #[inline(always)]
    pub(crate) fn change_of_half_cosine(&self, toward: DVec3, change: &Vectors<S>) -> f64x8<S> {
        let view = self.ray.dot_one(toward) * self.scale;
        (change.dot_one(toward) + change.dot(self.ray) * self.scale) / length_of_sum(view)
    }
}

/// |l + v| of unit vectors, from l · v; never 0.
#[inline(always)]
fn length_of_sum<S: Simd>(cosine: f64x8<S>) -> f64x8<S> {
    let least = f64x8::splat(cosine.simd(), f64::MIN_POSITIVE);
    (cosine * 2.0 + 2.0).max(least).sqrt()
}
