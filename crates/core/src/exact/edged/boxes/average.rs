//! The average light of eight boxes of a cell.

use fearless_simd::Simd;

use super::contours::{Contours, Visible};
use super::eight_boxes::{Eight, EightBoxes};
use super::half_vectors::Views;
use super::lights::Lit;
use super::normals::Normals;
use super::orders::Orders;
use super::region::{OF_AMBIGUITY, Region, Share};
use super::surroundings::Surroundings;
use crate::edges::cell::Cell;
use crate::exact::classify::contents::Contents;
use crate::exact::classify::reach::Reach;
use crate::exact::part::Part;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The data that the boxes of a cell have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a, 'scene> {
    pub(super) scene: &'a InCamera<'scene>,
    pub(super) cell: &'a Cell,
    pub(super) contents: &'a Contents,
    pub(super) background: Color,
    pub(super) has_alpha: bool,
    pub(super) finishes: &'a [Finish],
    pub(super) orders: &'a Orders,
    /// Whether the silhouettes of the active spheres lie in the cell: others fill it.
    pub(super) has_silhouette: &'a [bool],
}

/// The averages of eight boxes.
#[derive(Clone, Debug, Default)]
pub(super) struct Averages {
    pub(super) value: [Eight; 3],
    pub(super) covered: Eight,
    /// Estimates.
    pub(super) error: Eight,
    /// The points at which light was computed.
    pub(super) samples: u64,
}

impl Averages {
    /// The integral over all boxes, which have this area.
    pub(super) fn total(&self, area: f64) -> Part {
        let sum = |lanes: &Eight| lanes.iter().sum::<f64>() * area;
        let [x, y, z] = &self.value;
        Part {
            value: Color::new(sum(x), sum(y), sum(z)),
            covered: sum(&self.covered),
            error: sum(&self.error),
            rounding: 0.0,
        }
    }

    /// The average of one box.
    pub(super) fn lane(&self, lane: usize) -> Part {
        let [x, y, z] = &self.value;
        Part {
            value: Color::new(x[lane], y[lane], z[lane]),
            covered: self.covered[lane],
            error: self.error[lane],
            rounding: 0.0,
        }
    }
}

/// The light seen in boxes, summed up sphere by sphere.
#[derive(Clone, Copy, Debug)]
struct Sum<S: Simd> {
    channels: usize,
    value: [f64x8<S>; 3],
    /// The shares of boxes that spheres were seen in.
    seen: f64x8<S>,
    error: f64x8<S>,
    /// The least and the most light that parts of boxes send.
    least: [f64x8<S>; 3],
    most: [f64x8<S>; 3],
    /// The sum of how much shares may be off because edges depend on each other, and because they are no lines.
    ambiguity: f64x8<S>,
    doubt: f64x8<S>,
    /// The boxes in which a sphere may be seen, and the points whose light was summed up.
    is_covered: mask64x8<S>,
    samples: u64,
}

impl<S: Simd> Sum<S> {
    #[inline(always)]
    fn nothing(simd: S, channels: usize) -> Self {
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
    fn add(&mut self, visible: &Visible<S>, light: &Lit<S>) {
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

    /// Makes what is seen fill these shares of boxes: of three spheres that meet in a box the products of shares do not.
    #[inline(always)]
    fn fill(&mut self, simd: S, covered: f64x8<S>) {
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let scale = covered / self.seen.max(tiny);
        let is_seen = self.seen.simd_gt(0.0);
        for value in self.value.iter_mut().take(self.channels) {
            *value = is_seen.select(*value * scale, *value);
        }
    }

    /// The same for the shares of single spheres; what they are changed by counts as their error.
    #[inline(always)]
    fn fill_areas(&self, simd: S, left: &Share<S>, found: &mut [[Eight; 2]]) {
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
    fn add_range(&mut self, light: &Lit<S>, is_seen: mask64x8<S>) {
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
    fn contrast(&self, simd: S) -> f64x8<S> {
        let mut contrast = f64x8::splat(simd, 0.0);
        for (most, least) in self.most.iter().zip(&self.least).take(self.channels) {
            contrast = contrast.max(*most - *least);
        }
        contrast
    }
}

/// The result asked of eight boxes.
enum Wanted<'a> {
    /// Their averages, with noise to work with.
    Light(&'a mut Averages, &'a mut Option<Box<NoiseCells>>),
    /// For each active sphere the shares in which it is seen, and their errors.
    Areas(&'a mut Vec<[Eight; 2]>),
}

impl Setting<'_, '_> {
    /// Writes the averages of eight boxes, with memory to work in.
    #[inline(always)]
    pub(super) fn averages<S: Simd>(
        &self,
        simd: S,
        boxes: [Eight; 2],
        size: [f64; 2],
        (contours, noise): (&mut Contours, &mut Option<Box<NoiseCells>>),
        averages: &mut Averages,
    ) {
        self.find(
            simd,
            (boxes, size),
            contours,
            Wanted::Light(averages, noise),
        );
    }

    /// Writes the shares of eight boxes in which each active sphere is seen, and their errors.
    #[inline(always)]
    pub(super) fn areas<S: Simd>(
        &self,
        simd: S,
        boxes: [Eight; 2],
        size: [f64; 2],
        contours: &mut Contours,
        found: &mut Vec<[Eight; 2]>,
    ) {
        found.clear();
        found.resize(self.contents.active.len(), [[0.0; 8]; 2]);
        self.find(simd, (boxes, size), contours, Wanted::Areas(found));
    }

    /// Light and areas in one kernel: it is long, and what takes its time is the same.
    #[inline(never)]
    fn find<S: Simd>(
        &self,
        simd: S,
        ([x, y], size): ([Eight; 2], [f64; 2]),
        contours: &mut Contours,
        mut wanted: Wanted<'_>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let boxes = EightBoxes {
                    x: f64x8::from_array(simd, x),
                    y: f64x8::from_array(simd, y),
                    size,
                };
                let outside = self.contours(simd, &boxes, contours);
                let mut sum = Sum::nothing(simd, self.scene.channels);
                for contour in &contours.spheres {
                    let Some(visible) = contour.visible(simd, contours, self.orders) else {
                        continue;
                    };
                    match &mut wanted {
                        Wanted::Light(_, noise) => {
                            let light = self.light(simd, &boxes, &visible, noise);
                            sum.add(&visible, &light);
                        }
                        Wanted::Areas(found) => {
                            found[visible.position] = visible.share_and_error();
                            sum.seen += visible.share.area;
                        }
                    }
                }
                let left = outside.share(simd);
                match wanted {
                    Wanted::Light(averages, _) => {
                        let is_open = outside.most.simd_gt(0.0);
                        *averages = self.with_background(simd, &mut sum, &left, is_open);
                    }
                    Wanted::Areas(found) => sum.fill_areas(simd, &left, found),
                }
            },
        );
    }

    /// The averages of what is seen and of what is left of boxes beside it.
    #[inline(always)]
    fn with_background<S: Simd>(
        &self,
        simd: S,
        sum: &mut Sum<S>,
        left: &Share<S>,
        is_open: mask64x8<S>,
    ) -> Averages {
        let one = f64x8::splat(simd, 1.0);
        let open = left.area;
        // What no sphere was found to fill may belong to any of them.
        sum.doubt += (one - open - sum.seen).abs();
        sum.fill(simd, one - open);
        sum.ambiguity += left.ambiguity;
        let background = Lit::ambient(simd, self.background, open);
        for (value, of_light) in sum.value.iter_mut().zip(&background.value) {
            *value += *of_light;
        }
        sum.add_range(&background, is_open);
        let mut contrast = sum.contrast(simd);
        if self.has_alpha {
            contrast = (sum.is_covered & is_open).select(contrast.max(one), contrast);
        }
        let error = sum.error + contrast * (sum.ambiguity * OF_AMBIGUITY + sum.doubt);
        let [x, y, z] = sum.value;
        Averages {
            value: [x.into(), y.into(), z.into()],
            covered: (one - open).into(),
            error: error.into(),
            samples: sum.samples,
        }
    }

    /// Finds the contours of the spheres that boxes may see; what is outside of all of them.
    #[inline(always)]
    fn contours<S: Simd>(
        &self,
        simd: S,
        boxes: &EightBoxes<S>,
        contours: &mut Contours,
    ) -> Region<S> {
        contours.clear();
        let mut outside = Region::whole(simd);
        for (position, active) in self.contents.active.iter().enumerate() {
            let has_depth = self.orders.needs_depth(position);
            let of = (position, active);
            if self.has_silhouette[position] {
                contours.add(simd, boxes, of, has_depth, &mut outside);
            } else {
                outside.darken(simd, f64x8::splat(simd, 1.0).simd_gt(0.0));
                contours.add_filling(simd, boxes, of, has_depth);
            }
        }
        outside
    }

    /// The light of a sphere at these places of the boxes.
    #[inline(always)]
    fn light<S: Simd>(
        &self,
        simd: S,
        boxes: &EightBoxes<S>,
        visible: &Visible<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Lit<S> {
        let position = visible.position;
        let scene = self.scene;
        let active = &self.contents.active[position];
        let finish = &self.finishes[position];
        let mut light = Lit::ambient(
            simd,
            finish.reflectance.albedo * scene.ambient,
            visible.share.area,
        );
        let lights = scene.lights.len();
        let reaches = &self.contents.reach[position * lights..][..lights];
        if reaches.iter().all(|reach| matches!(reach, Reach::Nowhere)) {
            return light;
        }
        let around = Surroundings::new(simd, self.cell, boxes, &active.ball, visible);
        let normals = Normals::new(simd, scene, finish, (&around, visible), noise);
        light.samples = 8 * normals.samples;
        let has_highlight = finish.reflectance.highlight.is_some();
        let views = if has_highlight && active.ball.is_near_eye() {
            Some(Views::new(simd, &around, &normals))
        } else {
            None
        };
        for (of_light, reach) in scene.lights.iter().zip(reaches) {
            if let Reach::Past(casters) = reach {
                let casters = &self.contents.occluders[casters.start..casters.end];
                let of = (finish, of_light, scene.channels);
                light.add(
                    simd,
                    of,
                    (&around, &normals, visible),
                    views.as_ref(),
                    casters,
                );
            }
        }
        light
    }
}
