//! Eight pixels that one sphere fills, and the light at their samples.

use fearless_simd::Simd;

use super::light_cosines::LightCosines;
use super::samples::{POINTS, STAR_SAMPLES, Sample};
use crate::edges::cell::Ball;
use crate::exact::budget::Allowance;
use crate::exact::classify::row::Coverage;
use crate::exact::points::Points;
use crate::exact::scene::{InCamera, MOST_LIGHTS};
use crate::exact::surface::Finish;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;
use crate::picture::tile::Tile;

/// Light in up to three channels, eight samples at a time.
pub(super) type Radiance<S> = [f64x8<S>; 3];

/// Up to eight pixels of a row that one sphere fills.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FilledRow<'a> {
    /// The first of the eight pixels.
    pub(crate) start: Tile,
    /// Those that count, bit by bit.
    pub(crate) which: u64,
    pub(crate) coverage: &'a Coverage,
}

/// The angle by which normals turn from the middle of a part to its corners, over that in its pixel:
/// parts are a half by a quarter, quarters where the surface recedes; and a little more, as it does
/// not recede evenly.
pub(super) const SIZE_OF_PARTS: f64 = 0.45;

/// Eight pixels, or parts of one, that one sphere fills.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filled<'a, S: Simd> {
    pub(super) scene: &'a InCamera<'a>,
    pub(super) ball: &'a Ball,
    pub(super) finish: &'a Finish,
    /// The rays through the middles, and the pixels' sides on the retina at distance 1.
    pub(super) middle: Vectors<S>,
    pub(super) size: [f64; 2],
    /// The pixels that each light reaches, bit by bit.
    pub(super) lit: &'a [u64; MOST_LIGHTS],
    /// A bound of how far normals turn from the middles to the corners.
    pub(super) turn: f64x8<S>,
    /// A bound of how far directions toward the eye do.
    pub(super) view_turn: f64x8<S>,
    /// The extent of the pixels over the distance to the nearest singularity of the light: to the
    /// silhouette, or to a terminator where the exponent is not whole.
    pub(super) nearness: f64x8<S>,
    /// The pixels that count, bit by bit, and the error that is allowed in them.
    pub(super) which: u64,
    pub(super) tolerance: f64,
    pub(super) allowance: Allowance,
    /// Whether bounds of the errors are asked for.
    pub(super) is_proved: bool,
}

impl<S: Simd> Filled<'_, S> {
    /// Writes the light at some samples of each pixel, the first of them with the number `first`: no more
    /// than [`STAR_SAMPLES`]. Takes in their cosines where these are asked for.
    #[inline(never)]
    pub(super) fn light(
        &self,
        simd: S,
        first: usize,
        cosines: &mut Option<LightCosines<S>>,
        noise: &mut Option<Box<NoiseCells>>,
        lights: &mut [Radiance<S>],
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let samples = &POINTS[first..];
                if self.finish.is_rough() {
                    self.light_of_bumps(simd, samples, cosines, noise, lights);
                    return;
                }
                for (light, sample) in lights.iter_mut().zip(samples) {
                    let points = self.points(simd, sample);
                    *light = self.light_at(simd, &points, &points.normal, cosines);
                }
            },
        );
    }

    /// The points at a sample of each pixel.
    #[inline(always)]
    fn points(&self, simd: S, sample: &Sample) -> Points<S> {
        let mut ray = self.middle;
        ray.x += sample.u * self.size[0];
        ray.y += sample.v * self.size[1];
        Points::new(simd, self.ball, ray)
    }

    /// The light of points with these shading normals, whose cosines are taken in where they are asked for.
    #[inline(always)]
    fn light_at(
        &self,
        simd: S,
        points: &Points<S>,
        normal: &Vectors<S>,
        cosines: &mut Option<LightCosines<S>>,
    ) -> Radiance<S> {
        let mut halves = None;
        if let Some(cosines) = cosines {
            cosines.add_sample(&self.scene.lights, normal);
            halves = Some(&mut cosines.halves);
        }
        self.finish
            .radiance(simd, self.scene, points, normal, self.lit, halves)
    }

    /// The same of a surface whose normals are perturbed, those of all samples together.
    #[inline(never)]
    fn light_of_bumps(
        &self,
        simd: S,
        samples: &[Sample],
        cosines: &mut Option<LightCosines<S>>,
        noise: &mut Option<Box<NoiseCells>>,
        lights: &mut [Radiance<S>],
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut points = [Points::nowhere(simd); STAR_SAMPLES];
                let mut normals = [points[0].normal; STAR_SAMPLES];
                let count = lights.len();
                let samples = samples.iter().take(count);
                for ((points, normal), sample) in points.iter_mut().zip(&mut normals).zip(samples) {
                    *points = self.points(simd, sample);
                    *normal = points.normal;
                }
                let normals = &mut normals[..count];
                self.finish.perturb(simd, self.scene, normals, noise);
                for ((light, points), normal) in lights.iter_mut().zip(&points).zip(&*normals) {
                    *light = self.light_at(simd, points, normal, cosines);
                }
            },
        );
    }
}
