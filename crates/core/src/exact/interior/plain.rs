//! Pixels that a plain sphere fills under its only light: the product of their mean normal and its direction, or a ramp
//! where the terminator is in them.

use fearless_simd::Simd;

use super::filled::FilledRow;
use super::mean_normals::{MeanNormals, ROUNDING};
use super::ramps::Ramps;
use super::reached::Analytic;
use crate::exact::context::Context;
use crate::exact::scene::Light;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::numeric::bits::set_bits;
use crate::picture::pixel::{Evidence, Pixel, Status};

/// Pixels of a row that a plain sphere fills, and its only light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plain<'a, S: Simd> {
    pub(super) context: &'a Context<'a>,
    pub(super) row: &'a FilledRow<'a>,
    pub(super) light: &'a Light,
    pub(super) analytic: &'a Analytic<'a, S>,
    ambient: Color,
    /// The light reflected by a surface that faces the light, and the largest of its channels.
    color: Color,
    brightest: f64,
}

impl<'a, S: Simd> Plain<'a, S> {
    /// None where there are more lights, or the surface sends something else than their product.
    pub(super) fn new(
        context: &'a Context<'a>,
        row: &'a FilledRow<'a>,
        analytic: Option<&'a Analytic<'a, S>>,
        finish: &Finish,
    ) -> Option<Self> {
        let (_, light) = context.normals_on(finish)?;
        let reflectance = &finish.reflectance;
        let [brightest, _] = reflectance.brightest(light.intensity);
        Some(Self {
            context,
            row,
            light,
            analytic: analytic?,
            ambient: reflectance.albedo * context.scene.ambient,
            color: reflectance.albedo * light.intensity,
            brightest,
        })
    }

    /// Writes those of some pixels, which the light reaches, for which mean normals are good enough, out of what is known
    /// of the row; returns them, bit by bit, and the samples that were taken.
    #[inline(always)]
    pub(super) fn fill_lit(
        &self,
        simd: S,
        lit: u64,
        known: &mut Vec<MeanNormals>,
        pixels: &mut [Pixel],
    ) -> (u64, u64) {
        let tolerance = self.context.tolerance_of_normals(self.brightest);
        let of_row = (self.row, self.analytic);
        let (means, samples) = MeanNormals::of(simd, self.context, of_row, tolerance, known);
        let bounds = simd.vectorize(
            #[inline(always)]
            || means.bounds(simd, self.analytic, self.light.toward),
        );
        let cosine = |lane| means.dot(lane, self.light.toward);
        (self.fill(lit, &bounds, cosine, pixels), samples)
    }

    /// Writes those of some pixels, in which nothing but the terminator is, that it crosses nearly straight; returns them,
    /// bit by bit.
    #[inline(always)]
    pub(super) fn fill_turning(&self, simd: S, turning: u64, pixels: &mut [Pixel]) -> u64 {
        let ramps = simd.vectorize(
            #[inline(always)]
            || Ramps::new(simd, self.analytic, self.light.toward),
        );
        self.fill(turning, &ramps.bounds, |lane| ramps.averages[lane], pixels)
    }

    /// Writes those of some pixels that meet the tolerance with these averages of n·l; returns them, bit by bit.
    #[inline(always)]
    fn fill(
        &self,
        which: u64,
        bounds: &[f64; 8],
        average: impl Fn(usize) -> f64,
        pixels: &mut [Pixel],
    ) -> u64 {
        let rounding = self.ambient.max_element() * ROUNDING;
        let mut done = 0;
        for lane in set_bits(which) {
            let error = bounds[lane] * self.brightest + rounding;
            if error <= self.context.tolerance {
                let value = self.ambient + self.color * average(lane);
                pixels[lane] = Pixel {
                    value: self.context.scene.spread(value),
                    alpha: 1.0,
                    error,
                    evidence: Evidence::Bound,
                    status: Status::Met,
                };
                done |= 1 << lane;
            }
        }
        done
    }
}
