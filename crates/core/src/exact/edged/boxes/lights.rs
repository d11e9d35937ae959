//! The light of what eight boxes see of a sphere.

use fearless_simd::Simd;

use super::contours::Visible;
use super::falloffs::{Faced, Power};
use super::half_vectors::{HalfCosines, Views};
use super::normals::Normals;
use super::region::OF_AMBIGUITY;
use super::surroundings::Surroundings;
use crate::edges::shadow::Caster;
use crate::exact::scene::Light;
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The light of a sphere in eight boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit<S: Simd> {
    /// In each channel: the integral over what is seen, and the least and the most that parts of a box may send.
    pub(super) value: [f64x8<S>; 3],
    pub(super) range: [[f64x8<S>; 2]; 3],
    /// The error of taking one point's light for the average of a part, of what shadows and ends of light hide of each
    /// other, and of their edges that are no lines.
    pub(super) error: f64x8<S>,
    /// The points whose normals were computed.
    pub(super) samples: u64,
}

impl<S: Simd> Lit<S> {
    /// Ambient light alone, of these shares of boxes.
    #[inline(always)]
    pub(super) fn ambient(simd: S, color: Color, share: f64x8<S>) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let [x, y, z] = [
            f64x8::splat(simd, color.x),
            f64x8::splat(simd, color.y),
            f64x8::splat(simd, color.z),
        ];
        Self {
            value: [x * share, y * share, z * share],
            range: [[x; 2], [y; 2], [z; 2]],
            error: zero,
            samples: 0,
        }
    }

    /// Adds a light, past casters, to what is seen.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        simd: S,
        of: (&Finish, &Light, usize),
        (around, normals, visible): (&Surroundings<S>, &Normals<S>, &Visible<S>),
        views: Option<&Views<S>>,
        casters: &[Caster],
    ) {
        let (finish, light, _) = of;
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let toward = light.toward;
        let cosine = normals.normal.dot_one(toward);
        let across = [
            normals.across[0].dot_one(toward),
            normals.across[1].dot_one(toward),
        ];
        // Near a silhouette cosines go with a root: they rise above linear functions.
        let mut highest = cosine + across[0].abs() + across[1].abs() + normals.bow;
        if normals.is_rough {
            highest += normals.second;
        }
        if highest.simd_gt(zero).to_bitmask() == 0 {
            return;
        }
        let left = around.left_by(simd, light, casters, &visible.region);
        let is_whole = left.is_free.to_bitmask() == u64::from(u8::MAX);
        let (mut lit, mut middle) = (visible.share, visible.middle);
        if !is_whole {
            lit = left.region.share(simd);
            // Of next to nothing the middle is not known, and what else may be lit is as bright as what is seen.
            let is_known = lit.area.simd_gt(visible.share.area * LEAST_LIT);
            let of_lit = lit.middle(simd);
            for axis in 0..2 {
                middle[axis] = is_known.select(of_lit[axis], middle[axis]);
            }
        }
        // Where a silhouette cuts a box, the root of the discriminant is the average in the point, but what is linear is
        // the average in the middle of what is seen.
        let on_average = cosine - around.turned.dot_one(toward);
        let of_point = (on_average, across);
        let offset = around.offset;
        let of_lit = [offset, middle, visible.inward];
        let (faced, aside) = Faced::new(simd, normals, toward, of_point, of_lit);
        let diffuse = faced.diffuse(simd, finish, normals);
        let halves = match views {
            Some(views) => HalfCosines::of_views(simd, (views, normals), toward, cosine, aside),
            None if finish.reflectance.highlight.is_some() => {
                let viewed = finish.viewed(&around.points, &normals.normal);
                HalfCosines::of_still_views((&viewed, normals), toward, cosine, aside)
            }
            None => HalfCosines::nothing(simd),
        };
        let shine = faced.shine(simd, finish, &halves, normals);
        let weights = finish.reflectance.brightest(light.intensity);
        // Light that ends in a part of the box may end in what is hidden of it.
        let cut = left.region.most.min(one - lit.area);
        let is_cut = cut.simd_gt(zero);
        let ramped = is_cut.select(diffuse.ambiguity * left.region.most, zero);
        let ends = ramped.min(cut * diffuse.most) * weights[0]
            + shine.ambiguity.min(cut * shine.most) * weights[1];
        // Where light and shadow are taken for each other, what is lit is not where its middle was thought to be.
        let most = |power: &Power<S>| power.most.max(power.value + power.spread * OF_SPREAD);
        let brightness = most(&diffuse) * weights[0] + most(&shine) * weights[1];
        // What edges hide of what is seen counts as contrast.
        let more = (lit.ambiguity - visible.share.ambiguity * OF_AMBIGUITY).max(zero);
        let more = left.is_free.select(zero, more);
        let hidden = (more + left.doubt).min(left.region.most);
        self.error += lit.area * (diffuse.doubt * weights[0] + shine.doubt * weights[1])
            + ends
            + hidden * brightness;
        let has_ends = (diffuse.ambiguity + shine.ambiguity).simd_gt(zero);
        let is_open = left.is_free & !has_ends;
        let is_dark = left.region.most.simd_le(zero);
        self.add_channels(simd, of, (&diffuse, &shine), lit.area, (is_open, is_dark));
    }

    /// Adds the light of each channel over these shares of boxes, and its range: all of it where no edge of light or
    /// shadow is, none where it is dark.
    #[inline(always)]
    fn add_channels(
        &mut self,
        simd: S,
        (finish, light, channels): (&Finish, &Light, usize),
        (diffuse, shine): (&Power<S>, &Power<S>),
        share: f64x8<S>,
        (is_open, is_dark): (mask64x8<S>, mask64x8<S>),
    ) {
        let zero = f64x8::splat(simd, 0.0);
        let color = finish.reflectance.albedo * light.intensity;
        let highlight = finish.reflectance.highlight.as_ref();
        let strength = light.intensity * highlight.map_or(0.0, |(strength, _)| *strength);
        for channel in 0..channels {
            let whole = diffuse.value * color[channel] + shine.value * strength[channel];
            let highest = diffuse.most * color[channel] + shine.most * strength[channel];
            self.value[channel] += whole * share;
            // Beside an edge light is not what it is on average.
            let spread = diffuse.spread * color[channel] + shine.spread * strength[channel];
            let spread = spread * OF_SPREAD;
            let [least, most] = &mut self.range[channel];
            *least += is_open.select((whole - spread).max(zero), zero);
            *most += is_dark.select(zero, highest.max(whole + spread));
        }
    }
}

/// The share of what is seen that must be lit for its middle to count.
const LEAST_LIT: f64 = 0.05;

/// The part of how far light goes in a box that counts beside edges, which are not all in its corners.
const OF_SPREAD: f64 = 0.5;
