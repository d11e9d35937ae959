//! The light of what eight rays see.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x8, mask64x8};

use super::rays::Place;
use super::shadow::Shadows;
use super::trace::{Group, Groups, Sight};
use crate::model::color::Color;
use crate::model::light::DirectionalLight;
use crate::model::material::{Highlight, Material};
use crate::model::roughness::PixelKey;
use crate::model::world::World;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::LANES;
use crate::numeric::power::Power;
use crate::numeric::vectors::Vectors;

/// Light of eight rays, in one channel or in three.
pub(super) type Light<S, const CHANNELS: usize> = [f64x8<S>; CHANNELS];

/// What shading asks of a world; the same light as [`shade`](crate::shading::shade), but for
/// rounding.
#[derive(Clone, Debug)]
pub(super) struct Shading<'scene> {
    pub(super) world: &'scene World,
    pub(super) frame: i64,
    /// Whether no surface is rough.
    is_smooth: bool,
    /// What the materials say, in the world's order.
    finishes: Vec<Finish>,
}

/// A material, prepared.
#[derive(Clone, Copy, Debug)]
struct Finish {
    albedo: Color,
    diffuse: Power,
    /// Its falloff and strength.
    highlight: Option<(Power, f64)>,
}

impl Finish {
    fn new(material: &Material) -> Self {
        let prepare = |highlight: &Highlight| (Power::new(highlight.shininess), highlight.strength);
        Self {
            albedo: material.albedo,
            diffuse: Power::new(material.exponent),
            highlight: material.highlight.as_ref().map(prepare),
        }
    }
}

/// The same color in all lanes. A loop: closures are not compiled for the processor's level.
#[inline(always)]
pub(super) fn splat<S: Simd, const CHANNELS: usize>(simd: S, color: Color) -> Light<S, CHANNELS> {
    let mut light = [f64x8::splat(simd, 0.0); CHANNELS];
    for channel in 0..CHANNELS {
        light[channel] = f64x8::splat(simd, color[channel]);
    }
    light
}

impl<'scene> Shading<'scene> {
    pub(super) fn new(world: &'scene World, frame: i64) -> Self {
        let is_smooth = !world
            .materials()
            .iter()
            .any(|material| material.roughness.is_some());
        Self {
            world,
            frame,
            is_smooth,
            finishes: world.materials().iter().map(Finish::new).collect(),
        }
    }

    /// The light of rays that see anything; of the others any numbers.
    #[inline(always)]
    pub(super) fn light<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        (sight, groups, looks): (&Sight<S>, &Groups<'_>, &Looks<'_>),
        place: Place,
        shadows: &mut Option<Shadows<'_>>,
    ) -> Light<S, CHANNELS> {
        let world = self.world;
        let zero = f64x8::splat(simd, 0.0);
        let normal = if self.is_smooth {
            sight.normal
        } else {
            self.roughened(*sight, place, groups)
        };
        let outer = mask64x8::from_bitmask(simd, sight.covered & !sight.inner);
        let mut diffuse: Light<S, CHANNELS> = splat(simd, world.ambient);
        let mut mirrored = [zero; CHANNELS];
        for (index, light) in world.lights.iter().enumerate() {
            let facing = normal.dot_one(light.toward());
            let mut lit = facing.simd_gt(zero) & outer;
            if !lit.any_true() {
                continue;
            }
            if let Some(shadows) = shadows {
                let bits = shadows.lit(simd, index, light, sight, groups, lit.to_bitmask());
                lit = mask64x8::from_bitmask(simd, bits);
                if bits == 0 {
                    continue;
                }
            }
            let intensity: Light<S, CHANNELS> = splat(simd, light.intensity());
            let spread = lit.select(looks.spread(simd, facing), zero);
            for channel in 0..CHANNELS {
                diffuse[channel] += spread * intensity[channel];
            }
            if looks.has_highlight {
                let spot = looks.spots(simd, lit, light, normal, sight);
                for channel in 0..CHANNELS {
                    mirrored[channel] += spot * intensity[channel];
                }
            }
        }
        let mut albedo: Light<S, CHANNELS> = looks.albedo(simd);
        if world.has_own_albedos() {
            albedo = self.own_albedos(simd, groups, albedo);
        }
        for channel in 0..CHANNELS {
            diffuse[channel] = albedo[channel] * diffuse[channel] + mirrored[channel];
        }
        diffuse
    }

    /// Takes the albedos from the spheres that have their own.
    #[inline(never)]
    fn own_albedos<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        groups: &Groups<'_>,
        mut albedo: Light<S, CHANNELS>,
    ) -> Light<S, CHANNELS> {
        for Group { ball, lanes } in groups.as_slice() {
            let own = self.world.albedo(ball.index());
            simd.vectorize(
                #[inline(always)]
                || {
                    let mask = mask64x8::from_bitmask(simd, *lanes);
                    for (channel, albedo) in albedo.iter_mut().enumerate() {
                        *albedo = mask.select(f64x8::splat(simd, own[channel]), *albedo);
                    }
                },
            );
        }
        albedo
    }

    /// The normals with the bumps of rough surfaces.
    #[cold]
    #[inline(never)]
    fn roughened<S: Simd>(&self, sight: Sight<S>, place: Place, groups: &Groups<'_>) -> Vectors<S> {
        let mut normal = sight.normal;
        for Group { ball, lanes } in groups.as_slice() {
            let index = ball.index();
            let Some(roughness) = &self.world.material(index).roughness else {
                continue;
            };
            let radius = self.world.spheres()[index].radius();
            for lane in set_bits(lanes & !sight.inner) {
                let key = PixelKey {
                    col: place.col + lane as u32,
                    row: place.row,
                    frame: self.frame,
                };
                let bumpy = roughness.perturb(sight.normal.lane(lane), radius, index, key);
                normal.set_lane(lane, bumpy);
            }
        }
        normal
    }
}

/// The materials that eight rays see, each once.
pub(super) struct Looks<'scene> {
    list: [Look<'scene>; LANES],
    count: usize,
    has_highlight: bool,
}

/// A material, and the rays that see it as bits.
#[derive(Clone, Copy)]
struct Look<'scene> {
    finish: &'scene Finish,
    number: u32,
    lanes: u64,
}

impl<'scene> Looks<'scene> {
    /// One look: that of the world's only material, or any, where there is a sphere.
    pub(super) fn new(shading: &'scene Shading<'_>) -> Self {
        let finish = &shading.finishes[0];
        let look = Look {
            finish,
            number: 0,
            lanes: 0,
        };
        Self {
            list: [look; LANES],
            count: 1,
            has_highlight: finish.highlight.is_some(),
        }
    }

    /// Takes in what is seen.
    #[inline(always)]
    pub(super) fn see(&mut self, shading: &'scene Shading<'_>, groups: &Groups<'_>) {
        if shading.finishes.len() > 1 {
            self.see_any(shading, groups);
        }
    }

    fn see_any(&mut self, shading: &'scene Shading<'_>, groups: &Groups<'_>) {
        self.count = 0;
        self.has_highlight = false;
        for group in groups.as_slice() {
            let number = shading.world.material_index(group.ball.index());
            let known = &mut self.list[..self.count];
            if let Some(look) = known.iter_mut().find(|look| look.number == number) {
                look.lanes |= group.lanes;
                continue;
            }
            let finish = &shading.finishes[number as usize];
            self.list[self.count] = Look {
                finish,
                number,
                lanes: group.lanes,
            };
            self.count += 1;
            self.has_highlight |= finish.highlight.is_some();
        }
    }

    /// What the first material says, or what the others say where they are seen.
    #[inline(always)]
    fn albedo<S: Simd, const CHANNELS: usize>(&self, simd: S) -> Light<S, CHANNELS> {
        let mut albedo: Light<S, CHANNELS> = splat(simd, self.list[0].finish.albedo);
        for look in &self.list[1..self.count] {
            let mask = mask64x8::from_bitmask(simd, look.lanes);
            let other: Light<S, CHANNELS> = splat(simd, look.finish.albedo);
            for channel in 0..CHANNELS {
                albedo[channel] = mask.select(other[channel], albedo[channel]);
            }
        }
        albedo
    }

    /// The powers of n·l.
    #[inline(always)]
    fn spread<S: Simd>(&self, simd: S, facing: f64x8<S>) -> f64x8<S> {
        let mut spread = self.list[0].finish.diffuse.lanes(facing);
        for look in &self.list[1..self.count] {
            let mask = mask64x8::from_bitmask(simd, look.lanes);
            spread = mask.select(look.finish.diffuse.lanes(facing), spread);
        }
        spread
    }

    /// The highlights of a light of intensity 1, where `lit` holds; else 0.
    #[inline(always)]
    fn spots<S: Simd>(
        &self,
        simd: S,
        lit: mask64x8<S>,
        light: &DirectionalLight,
        normal: Vectors<S>,
        sight: &Sight<S>,
    ) -> f64x8<S> {
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        let toward = Vectors::splat(simd, light.toward());
        let view = sight.direction.times(one / sight.length_sq.sqrt());
        let half = toward.minus(&view);
        let half_sq = half.length_squared();
        // Zero where the viewer looks along the light.
        let inverse = half_sq.simd_gt(zero).select(one / half_sq.sqrt(), zero);
        let facing = normal.dot(&half) * inverse;
        let facing = facing.simd_gt(zero).select(facing, zero);
        let mut spots = self.list[0].finish.spot(simd, facing);
        for look in &self.list[1..self.count] {
            let mask = mask64x8::from_bitmask(simd, look.lanes);
            spots = mask.select(look.finish.spot(simd, facing), spots);
        }
        lit.select(spots, zero)
    }
}

impl Finish {
    /// The highlight where the half vector has this cosine.
    #[inline(always)]
    fn spot<S: Simd>(&self, simd: S, facing: f64x8<S>) -> f64x8<S> {
        match &self.highlight {
            Some((falloff, strength)) => falloff.lanes(facing) * *strength,
            None => f64x8::splat(simd, 0.0),
        }
    }
}
