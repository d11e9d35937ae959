//! The light of what eight boxes see of a sphere.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::edges::Edges;
use super::falloffs::Faced;
use super::surroundings::Surroundings;
use crate::edges::shadow::Caster;
use crate::exact::scene::Light;
use crate::exact::surface::Finish;
use crate::model::color::Color;

/// The light of a sphere in eight boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit<S: Simd> {
    /// In each channel: the average, and the least and the most that parts of a box may send.
    pub(super) value: [f64x8<S>; 3],
    pub(super) range: [[f64x8<S>; 2]; 3],
    /// The error of taking one point's light for the average of its box.
    pub(super) error: f64x8<S>,
    /// Edges of shadows, weighted by the light that they take away.
    pub(super) edges: Edges<S>,
}

impl<S: Simd> Lit<S> {
    /// Ambient light alone.
    #[inline(always)]
    pub(super) fn ambient(simd: S, color: Color) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let [x, y, z] = [
            f64x8::splat(simd, color.x),
            f64x8::splat(simd, color.y),
            f64x8::splat(simd, color.z),
        ];
        Self {
            value: [x, y, z],
            range: [[x; 2], [y; 2], [z; 2]],
            error: zero,
            edges: Edges::none(simd),
        }
    }

    /// Adds a light, past casters.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        simd: S,
        of: (&Finish, &Light, usize),
        around: &Surroundings<S>,
        casters: &[Caster],
    ) {
        let (finish, light, channels) = of;
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let toward = light.toward;
        let cosine = around.points.normal.dot_one(toward);
        let by_radius = 1.0 / around.radius;
        let across = [
            around.across[0].dot_one(toward) * by_radius,
            around.across[1].dot_one(toward) * by_radius,
        ];
        let highest = cosine + across[0].abs() + across[1].abs();
        if highest.simd_gt(zero).to_bitmask() == 0 {
            return;
        }
        let mut edges = Edges::none(simd);
        let (left, dark) = around.left_by(simd, light, casters, &mut edges);
        // The middle of what is lit.
        let by_left = one / left.max(f64x8::splat(simd, LEAST_LEFT));
        let half = f64x8::splat(simd, 0.5);
        let aside = [
            (dark[0] * by_left).max(-half).min(half),
            (dark[1] * by_left).max(-half).min(half),
        ];
        let faced = Faced {
            cosine: cosine - across[0] * aside[0] - across[1] * aside[1],
            across,
            width: (across[0].abs() + across[1].abs()) * 0.5,
        };
        let diffuse = faced.diffuse(simd, finish, around);
        let viewed = finish.viewed(&around.points, &around.points.normal);
        let [x, y] = &around.across;
        let aside = x
            .times(aside[0] * by_radius)
            .plus(&y.times(aside[1] * by_radius));
        let mut half_cosine = viewed.half_cosine(toward, cosine);
        if finish.reflectance.highlight.is_some() {
            half_cosine -= viewed.change_of_half_cosine(toward, &aside);
        }
        let shine = faced.shine(simd, finish, half_cosine, around);
        let weights = finish.reflectance.brightest(light.intensity);
        self.error += left * (diffuse.doubt * weights[0] + shine.doubt * weights[1]);
        // A terminator in the box is an edge as those of shadows are.
        let ends = diffuse.ambiguity * weights[0] + shine.ambiguity * weights[1];
        let brightness = diffuse.most * weights[0] + shine.most * weights[1];
        self.edges.add(ends, zero);
        self.edges.sum += edges.sum * brightness;
        self.edges.most = self.edges.most.max(edges.most * brightness);
        self.edges.doubt += edges.doubt * brightness;
        let is_open = left.simd_ge(one) & (edges.sum + ends).simd_le(zero);
        let is_dark = left.simd_le(zero) & edges.sum.simd_le(zero);
        let color = finish.reflectance.albedo * light.intensity;
        let highlight = finish.reflectance.highlight.as_ref();
        let strength = light.intensity * highlight.map_or(0.0, |(strength, _)| *strength);
        for channel in 0..channels {
            let whole = diffuse.value * color[channel] + shine.value * strength[channel];
            let highest = diffuse.most * color[channel] + shine.most * strength[channel];
            self.value[channel] += whole * left;
            let [least, most] = &mut self.range[channel];
            *least += is_open.select(whole, zero);
            *most += is_dark.select(zero, highest);
        }
    }
}

/// Less of a light than this has no place of its own.
const LEAST_LEFT: f64 = 1e-6;
