//! The light of points of spheres, eight at a time.

use fearless_simd::Simd;

use super::points::Points;
use super::scene::{InCamera, Light, MOST_LIGHTS};
use crate::light::lobe::Beyond;
use crate::light::reflection::{Reflectance, ViewedPoints};
use crate::light::shading_normal::ShadingNormal;
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::vectors::Vectors;

/// The surface of a sphere's outer side, prepared for the light of many points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish {
    pub(super) reflectance: Reflectance,
    pub(super) shading_normal: ShadingNormal,
}

/// The cosines n · h of points so far, of each light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfCosines<S: Simd> {
    /// The highest powers, on either side of terminators.
    pub(super) powers: [f64x8<S>; MOST_LIGHTS],
    pub(super) lowest: [f64x8<S>; MOST_LIGHTS],
    pub(super) highest: [f64x8<S>; MOST_LIGHTS],
}

impl<S: Simd> HalfCosines<S> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        Self {
            powers: [f64x8::splat(simd, 0.0); MOST_LIGHTS],
            lowest: [f64x8::splat(simd, f64::INFINITY); MOST_LIGHTS],
            highest: [f64x8::splat(simd, f64::NEG_INFINITY); MOST_LIGHTS],
        }
    }

    #[inline(always)]
    fn add(&mut self, light: usize, power: f64x8<S>, half_cosine: f64x8<S>) {
        self.powers[light] = self.powers[light].max(power);
        self.lowest[light] = self.lowest[light].min(half_cosine);
        self.highest[light] = self.highest[light].max(half_cosine);
    }
}

impl Light {
    /// n · l and n · h of points as the eye sees them, and the factors of a point light's intensity.
    #[inline(always)]
    pub(super) fn on_points<S: Simd>(
        &self,
        points: &Points<S>,
        viewed: &ViewedPoints<'_, S>,
        beyond: Beyond,
    ) -> (f64x8<S>, f64x8<S>, Option<f64x8<S>>) {
        match &self.near {
            None => {
                let cosine = viewed.cosine(self.toward);
                (cosine, viewed.half_cosine(self.toward, cosine), None)
            }
            Some(near) => {
                let (toward, factor) = near.seen_from(&points.place(), beyond);
                let cosine = viewed.cosine_of_each(&toward);
                (
                    cosine,
                    viewed.half_cosine_of_each(&toward, cosine),
                    Some(factor),
                )
            }
        }
    }
}

impl Finish {
    pub(crate) fn new(scene: &InCamera<'_>, sphere: usize, pixel: PixelKey) -> Self {
        let albedo = if scene.is_of_normals {
            Color::ONE
        } else {
            scene.world.albedo(sphere)
        };
        Self {
            reflectance: Reflectance {
                albedo,
                ..Reflectance::new(scene.world.material(sphere))
            },
            // Without lights no bumps are seen.
            shading_normal: match scene.lights.is_empty() {
                true => ShadingNormal::Smooth,
                false => ShadingNormal::new(scene.world, sphere, pixel),
            },
        }
    }

    /// Returns whether the surface may avert itself from a light that its sphere faces.
    pub(crate) fn is_rough(&self) -> bool {
        !self.shading_normal.is_smooth()
    }

    /// Returns whether the surface has bumps of its own.
    pub(crate) fn is_bumpy(&self) -> bool {
        matches!(self.shading_normal, ShadingNormal::Bumpy(_))
    }

    /// Returns whether light is the cosine of the angle to it, and nothing else.
    pub(crate) fn is_plain(&self) -> bool {
        self.reflectance.diffuse.exponent == 1.0
            && self.reflectance.highlight.is_none()
            && !self.is_rough()
    }

    /// More diffuse light than some lights, bit by bit, make in any channel.
    pub(crate) fn brightest(&self, scene: &InCamera<'_>, lights: u64) -> f64 {
        let mut sum = 0.0;
        for (index, light) in scene.lights.iter().enumerate() {
            if lights >> index & 1 == 1 {
                let [diffuse, _] = self.reflectance.brightest(light.intensity);
                sum += diffuse;
            }
        }
        sum
    }

    /// Makes normals of points those that light is computed with.
    #[inline(always)]
    pub(crate) fn perturb<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        normals: &mut [Vectors<S>],
        noise: &mut Option<Box<NoiseCells>>,
    ) {
        if self.is_rough() {
            let frame = &scene.world_from_camera;
            self.shading_normal.perturb(simd, frame, normals, noise);
        }
    }

    /// The light of some lights, bit by bit, that points without bumps send to the eye, without what they
    /// send where none of them reaches; on where the surface turns from them, as smooth as it is. Diffuse
    /// light counts of those lights alone that come second.
    #[inline(always)]
    pub(crate) fn unclamped<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        points: &Points<S>,
        [lights, diffuse]: [u64; 2],
    ) -> [f64x8<S>; 3] {
        let reflectance = &self.reflectance;
        let mut sum = [f64x8::splat(simd, 0.0); 3];
        let viewed = self.viewed(points, &points.normal);
        for (index, light) in scene.lights.iter().enumerate() {
            if lights >> index & 1 == 1 {
                let sum = &mut sum[..scene.channels];
                let intensity = light.intensity;
                let (cosine, half_cosine, factor) =
                    light.on_points(points, &viewed, Beyond::Continued);
                if let Some(factor) = factor {
                    let mut own = [f64x8::splat(simd, 0.0); 3];
                    let own = &mut own[..scene.channels];
                    if diffuse >> index & 1 == 1 {
                        reflectance.add_diffuse(reflectance.albedo * intensity, cosine, None, own);
                    }
                    reflectance.add_highlight(intensity, half_cosine, None, own);
                    for (sum, own) in sum.iter_mut().zip(own) {
                        *sum += *own * factor;
                    }
                    continue;
                }
                if diffuse >> index & 1 == 1 {
                    reflectance.add_diffuse(reflectance.albedo * intensity, cosine, None, sum);
                }
                reflectance.add_highlight(intensity, half_cosine, None, sum);
            }
        }
        sum
    }

    /// The light that points with these normals, of [`Self::perturb`], send to the eye, in the channels
    /// that the scene counts; `lit` tells for each light, bit by bit, which of the points it reaches. What
    /// highlights depend on is added to `halves`.
    #[inline(always)]
    pub(crate) fn radiance<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        points: &Points<S>,
        normal: &Vectors<S>,
        lit: &[u64; MOST_LIGHTS],
        mut halves: Option<&mut HalfCosines<S>>,
    ) -> [f64x8<S>; 3] {
        let reflectance = &self.reflectance;
        let constant = reflectance.albedo * scene.ambient;
        let mut sum = [
            f64x8::splat(simd, constant.x),
            f64x8::splat(simd, constant.y),
            f64x8::splat(simd, constant.z),
        ];
        let viewed = self.viewed(points, normal);
        for (index, light) in scene.lights.iter().enumerate() {
            if lit[index] == 0 {
                continue;
            }
            let intensity = light.intensity;
            let (cosine, half_cosine, factor) = light.on_points(points, &viewed, Beyond::Continued);
            let lit = Some(cosine.simd_gt(0.0) & mask64x8::from_bitmask(simd, lit[index]));
            let sum = &mut sum[..scene.channels];
            if let Some(factor) = factor {
                let mut own = [f64x8::splat(simd, 0.0); 3];
                let own = &mut own[..scene.channels];
                reflectance.add_diffuse(reflectance.albedo * intensity, cosine, lit, own);
                reflectance.add_highlight(intensity, half_cosine, lit, own);
                for (sum, own) in sum.iter_mut().zip(own) {
                    *sum += *own * factor;
                }
                continue;
            }
            reflectance.add_diffuse(reflectance.albedo * intensity, cosine, lit, sum);
            let power = reflectance.add_highlight(intensity, half_cosine, lit, sum);
            if let (Some(halves), Some(power)) = (&mut halves, power) {
                halves.add(index, power, half_cosine);
            }
        }
        sum
    }

    /// Points with these normals, as the eye sees them.
    #[inline(always)]
    pub(super) fn viewed<'a, S: Simd>(
        &self,
        points: &'a Points<S>,
        normal: &'a Vectors<S>,
    ) -> ViewedPoints<'a, S> {
        let has_highlight = self.reflectance.highlight.is_some();
        ViewedPoints::new(normal, &points.ray, points.ray_sq, has_highlight)
    }
}
