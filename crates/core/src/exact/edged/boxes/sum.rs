//! What eight boxes see, summed up sphere by sphere.

use fearless_simd::Simd;

use super::contours::Visible;
use super::eight_boxes::Eight;
use super::lights::Lit;
use super::region::Share;
use crate::model::color::Color;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The light seen in boxes, summed up sphere by sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sum<S: Simd> {
    pub(super) channels: usize,
    pub(super) value: [f64x8<S>; 3],
    /// The shares of boxes that spheres were seen in.
    pub(super) seen: f64x8<S>,
    pub(super) error: f64x8<S>,
    /// The least and the most light that parts of boxes send.
    least: [f64x8<S>; 3],
    most: [f64x8<S>; 3],
    /// The sum of how much shares may be off because edges depend on each other, and because they are no lines.
    pub(super) ambiguity: f64x8<S>,
    pub(super) doubt: f64x8<S>,
    /// The boxes in which a sphere may be seen, and the points whose light was summed up.
    pub(super) is_covered: mask64x8<S>,
    pub(super) samples: u64,
}

impl<S: Simd> Sum<S> {
    #[inline(always)]
    pub(super) fn nothing(simd: S, channels: usize) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let infinity = f64x8::splat(simd, f64::INFINITY);
        Self {
            channels,
            value: [zero; 3],
            seen: zero,
            error: zero,
            least: [infinity; 3],
            most: [-infinity; 3],
            ambiguity: zero,
            doubt: zero,
            is_covered: mask64x8::splat(simd, false),
            samples: 0,
        }
    }

    /// Adds what is seen of a sphere.
    #[inline(always)]
    pub(super) fn add(&mut self, visible: &Visible<S>, light: &Lit<S>) {
        self.samples += light.samples;
        self.is_covered |= visible.is_possible;
        self.error += light.error;
        self.seen += visible.share.area;
        self.doubt += visible.doubt;
        self.ambiguity += visible.share.ambiguity;
        for (value, of_light) in self.value.iter_mut().zip(&light.value).take(self.channels) {
            *value += *of_light;
        }
        self.add_range(light, visible.is_possible);
    }

    /// Takes a face, which was added, away from the outline around it: that is what is left of this share of all of the
    /// sphere.
    #[inline(always)]
    pub(super) fn take_from_outline(&mut self, face: &Visible<S>, whole: f64x8<S>, color: Color) {
        let area = face.share.area;
        let taken = area.min(whole);
        for (channel, value) in self.value.iter_mut().enumerate().take(self.channels) {
            *value -= taken * color[channel];
        }
        self.seen -= taken;
        self.doubt += area - taken;
        // What the face gains the outline loses.
        self.ambiguity += face.share.ambiguity;
    }

    /// Makes what is seen fill these shares of boxes: of three spheres that meet in a box the products of shares do not.
    #[inline(always)]
    pub(super) fn fill(&mut self, simd: S, covered: f64x8<S>) {
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let scale = covered / self.seen.max(tiny);
        let is_seen = self.seen.simd_gt(0.0);
        for value in self.value.iter_mut().take(self.channels) {
            *value = is_seen.select(*value * scale, *value);
        }
    }

    /// The same for the shares of single spheres; what they are changed by counts as their error.
    #[inline(always)]
    pub(super) fn fill_areas(&self, simd: S, left: &Share<S>, found: &mut [[Eight; 2]]) {
        let covered = f64x8::splat(simd, 1.0) - left.area;
        let scale = covered / self.seen.max(f64x8::splat(simd, f64::MIN_POSITIVE));
        for [share, error] in found {
            let known = f64x8::from_array(simd, *share);
            let scaled = known * scale;
            let error_of = f64x8::from_array(simd, *error);
            *error = error_of.max((scaled - known).abs()).into();
            *share = scaled.into();
        }
    }

    /// Adds a range of light where it is seen.
    #[inline(always)]
    pub(super) fn add_range(&mut self, light: &Lit<S>, is_seen: mask64x8<S>) {
        for channel in 0..self.channels {
            let [least, most] = light.range[channel];
            let low = self.least[channel];
            self.least[channel] = is_seen.select(low.min(least), low);
            let high = self.most[channel];
            self.most[channel] = is_seen.select(high.max(most), high);
        }
    }

    /// The largest contrast of a channel.
    #[inline(always)]
    pub(super) fn contrast(&self, simd: S) -> f64x8<S> {
        let mut contrast = f64x8::splat(simd, 0.0);
        for (most, least) in self.most.iter().zip(&self.least).take(self.channels) {
            contrast = contrast.max(*most - *least);
        }
        contrast
    }
}
