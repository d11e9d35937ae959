//! The average light of eight boxes of a cell.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::lights::{Lit, Surroundings};
use super::outlines::{Edges, Eight, Orders, Outline, Visible};
use crate::edges::cell::Cell;
use crate::exact::classify::contents::{Contents, Reach};
use crate::exact::part::Part;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::color::Color;

/// Eight boxes of one size, in the coordinates of their cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct EightBoxes<S: Simd> {
    /// Their middles.
    pub(super) x: f64x8<S>,
    pub(super) y: f64x8<S>,
    pub(super) size: [f64; 2],
}

/// What the boxes of a cell have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a, 'scene> {
    pub(super) scene: &'a InCamera<'scene>,
    pub(super) cell: &'a Cell,
    pub(super) contents: &'a Contents,
    pub(super) background: Color,
    pub(super) finishes: &'a [Finish],
    pub(super) orders: &'a Orders,
    /// Whether the silhouettes of the active spheres lie in the cell: others fill it.
    pub(super) has_silhouette: &'a [bool],
}

/// The averages of eight boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Averages {
    pub(super) value: [Eight; 3],
    pub(super) covered: Eight,
    /// Estimates.
    pub(super) error: Eight,
    /// The spheres of which light was computed.
    pub(super) lit: u64,
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

/// The least and the most light that parts of boxes send.
#[derive(Clone, Copy, Debug)]
struct Range<S: Simd> {
    least: [f64x8<S>; 3],
    most: [f64x8<S>; 3],
}

impl<S: Simd> Range<S> {
    #[inline(always)]
    fn add(&mut self, channel: usize, [least, most]: [f64x8<S>; 2], is_seen: mask64x8<S>) {
        let low = &mut self.least[channel];
        *low = is_seen.select(low.min(least), *low);
        let high = &mut self.most[channel];
        *high = is_seen.select(high.max(most), *high);
    }

    /// The largest contrast of a channel.
    #[inline(always)]
    fn contrast(&self, simd: S, channels: usize) -> f64x8<S> {
        let mut contrast = f64x8::splat(simd, 0.0);
        for channel in 0..channels {
            contrast = contrast.max(self.most[channel] - self.least[channel]);
        }
        contrast
    }
}

impl Setting<'_, '_> {
    /// The averages, with memory to work in.
    #[inline(never)]
    pub(super) fn averages<S: Simd>(
        &self,
        simd: S,
        boxes: [Eight; 2],
        size: [f64; 2],
        outlines: &mut Vec<Outline>,
    ) -> Averages {
        simd.vectorize(
            #[inline(always)]
            || self.averages_of(simd, boxes, size, outlines),
        )
    }

    #[inline(always)]
    fn averages_of<S: Simd>(
        &self,
        simd: S,
        [x, y]: [Eight; 2],
        size: [f64; 2],
        outlines: &mut Vec<Outline>,
    ) -> Averages {
        let boxes = EightBoxes {
            x: x.simd_into(simd),
            y: y.simd_into(simd),
            size,
        };
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let infinity = f64x8::splat(simd, f64::INFINITY);
        let channels = self.scene.channels;
        outlines.clear();
        let mut open = one;
        for (position, active) in self.contents.active.iter().enumerate() {
            let has_depth = self.orders.needs_depth(position);
            let of = (position, active);
            if !self.has_silhouette[position] {
                open = zero;
                outlines.push(Outline::filling(simd, &boxes, of, has_depth));
            } else if let Some(outline) = Outline::new(simd, &boxes, of, has_depth) {
                open = open * outline.outside(simd);
                outlines.push(outline);
            }
        }

        let mut edges = Edges::none(simd);
        let mut shadows = Edges::none(simd);
        let mut value = [zero; 3];
        let mut error = zero;
        let mut range = Range {
            least: [infinity; 3],
            most: [-infinity; 3],
        };
        let mut lit = 0;
        for index in 0..outlines.len() {
            let visible = outlines[index].visible(simd, outlines, self.orders, &mut edges);
            if visible.is_possible.to_bitmask() == 0 {
                continue;
            }
            lit += 1;
            let light = self.light(simd, &boxes, &visible);
            error += light.error * visible.share;
            // However little is seen of it, edges may all lie in that.
            let is_seen = visible.is_possible;
            shadows.sum += is_seen.select(light.edges.sum, zero);
            shadows.most = shadows.most.max(is_seen.select(light.edges.most, zero));
            shadows.doubt += light.edges.doubt * visible.share;
            for channel in 0..channels {
                value[channel] += light.value[channel] * visible.share;
                range.add(channel, light.range[channel], visible.is_possible);
            }
        }
        let is_open = (open + edges.doubt).simd_gt(zero);
        for channel in 0..channels {
            let background = f64x8::splat(simd, self.background[channel]);
            value[channel] += background * open;
            range.add(channel, [background; 2], is_open);
        }
        let contrast = range.contrast(simd, channels);
        let most = (contrast * edges.most).max(shadows.most);
        let ambiguous = contrast * edges.sum + shadows.sum - most;
        error += ambiguous + contrast * edges.doubt + shadows.doubt;
        Averages {
            value: [value[0].into(), value[1].into(), value[2].into()],
            covered: (one - open).into(),
            error: error.into(),
            lit,
        }
    }

    /// The light of a sphere at these places of the boxes.
    #[inline(always)]
    fn light<S: Simd>(&self, simd: S, boxes: &EightBoxes<S>, visible: &Visible<S>) -> Lit<S> {
        let position = visible.position;
        let scene = self.scene;
        let active = &self.contents.active[position];
        let finish = &self.finishes[position];
        let mut light = Lit::ambient(simd, finish.reflectance.albedo * scene.ambient);
        let lights = scene.lights.len();
        let reaches = &self.contents.reach[position * lights..][..lights];
        if reaches.iter().all(|reach| matches!(reach, Reach::Nowhere)) {
            return light;
        }
        let around = Surroundings::new(simd, self.cell, boxes, &active.ball, visible);
        for (of_light, reach) in scene.lights.iter().zip(reaches) {
            if let Reach::Past(casters) = reach {
                let casters = &self.contents.occluders[casters.start..casters.end];
                light.add(simd, (finish, of_light, scene.channels), &around, casters);
            }
        }
        light
    }
}
