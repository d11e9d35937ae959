//! The light of what eight rays see.

use fearless_simd::Simd;
use glam::{DMat3, DVec3};

use super::groups::{Group, Groups};
use super::rays::Place;
use super::shadow::Shadows;
use super::trace::Sight;
use crate::light::lobe::{Beyond, Lobe};
use crate::light::near_light::NearLight;
use crate::light::reflection::{Reflectance, ViewedPoints};
use crate::model::color::Color;
use crate::model::light::{Light as WorldLight, PointLight};
use crate::model::outline::OutlineView;
use crate::model::roughness::noise::NoiseCells;
use crate::model::roughness::{PixelKey, unit};
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f64x8, mask64x8};
use crate::numeric::vectors::Vectors;
use crate::search::view_index::ViewIndex;

/// A point light, and the rays, as bits, that see what it may reach.
struct PointLit<'world> {
    index: usize,
    light: &'world PointLight,
    asked: u64,
}

/// Light of eight rays, in one channel or in three.
pub(super) type Light<S, const CHANNELS: usize> = [f64x8<S>; CHANNELS];

/// The materials and lights of a world, prepared.
#[derive(Clone, Debug)]
pub(super) struct Shading<'scene> {
    pub(super) world: &'scene World,
    lights: Vec<WorldLight>,
    pub(super) viewpoint: DVec3,
    /// The balls' unit of length, in those of the world.
    length: f64,
    pub(super) frame: i64,
    /// True if no surface is rough.
    pub(super) is_smooth: bool,
    /// The view, and the camera's directions, where spheres have outlines.
    pub(super) outlines: Option<(OutlineView, DMat3)>,
    /// Those of the materials, in the world's order.
    reflectances: Vec<Reflectance>,
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
    pub(super) fn new(world: &'scene World, view: &View, index: &ViewIndex<'_>) -> Self {
        let materials = world.materials();
        Self {
            world,
            lights: index.visibility.lights().to_vec(),
            viewpoint: view.camera.position,
            length: libm::scalbn(1.0, index.length_exponent()),
            frame: view.frame,
            is_smooth: materials
                .iter()
                .all(|material| material.roughness.is_none()),
            outlines: world.has_outlines().then(|| {
                (
                    view.outline_view(),
                    view.camera.world_from_camera.transpose(),
                )
            }),
            reflectances: materials.iter().map(Reflectance::new).collect(),
        }
    }

    /// The light of rays that see anything; of the others any numbers.
    #[inline(always)]
    pub(super) fn light<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        (sight, groups, looks): (&Sight<S>, &Groups<'_>, &mut Looks<'_>),
        place: Place,
        shadows: &mut Option<Shadows<'_>>,
    ) -> Light<S, CHANNELS> {
        let world = self.world;
        let normal = if self.is_smooth {
            sight.normal
        } else {
            self.shading_normals(simd, sight, groups, place, &mut looks.noise)
        };
        let outer = mask64x8::from_bitmask(simd, sight.covered & !sight.inner);
        let mut albedo: Light<S, CHANNELS> = looks.albedo(simd);
        if world.has_own_albedos() {
            albedo = self.own_albedos(simd, groups, albedo);
        }
        let has_highlight = looks.has_highlight;
        let points = ViewedPoints::new(&normal, &sight.direction, sight.length_sq, has_highlight);
        let mut diffuse: Light<S, CHANNELS> = splat(simd, world.ambient);
        let mut mirrored: Light<S, CHANNELS> = splat(simd, Color::ZERO);
        for (index, light) in self.lights.iter().enumerate() {
            let light = match light {
                WorldLight::Directional(light) => light,
                WorldLight::Point(light) => {
                    let lit = PointLit {
                        index,
                        light,
                        asked: outer.to_bitmask(),
                    };
                    let seen = (sight, groups, &*looks);
                    let sums = (&mut diffuse, &mut mirrored);
                    self.add_point_light(simd, lit, &points, seen, shadows, sums);
                    continue;
                }
            };
            let cosine = points.cosine(light.toward());
            let mut lit = cosine.simd_gt(0.0) & outer;
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
            let intensity = light.intensity();
            let half_cosine = points.half_cosine(light.toward(), cosine);
            for look in &looks.list[..looks.count] {
                let lit = Some(lit & mask64x8::from_bitmask(simd, look.lanes));
                let reflectance = look.reflectance;
                reflectance.add_diffuse(intensity, cosine, lit, &mut diffuse);
                reflectance.add_highlight(intensity, half_cosine, lit, &mut mirrored);
            }
        }
        for channel in 0..CHANNELS {
            diffuse[channel] = albedo[channel] * diffuse[channel] + mirrored[channel];
        }
        if self.outlines.is_some() {
            diffuse = self.add_outlines(simd, sight, groups, diffuse);
        }
        diffuse
    }

    /// Adds the light of a point light.
    #[inline(never)]
    fn add_point_light<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        PointLit {
            index,
            light,
            asked,
        }: PointLit<'_>,
        points: &ViewedPoints<'_, S>,
        (sight, groups, looks): (&Sight<S>, &Groups<'_>, &Looks<'_>),
        shadows: &mut Option<Shadows<'_>>,
        (diffuse, mirrored): (&mut Light<S, CHANNELS>, &mut Light<S, CHANNELS>),
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let from_eye = sight.point.times(f64x8::splat(simd, self.length));
                let from_eye_to_light = light.position() - self.viewpoint;
                let lobe = light.emission().map(Lobe::in_world);
                let near = NearLight::new(light, from_eye_to_light, lobe);
                let (toward, factor) = near.seen_from(&from_eye, Beyond::Nothing);
                let cosine = points.cosine_of_each(&toward);
                let mut lit = cosine.simd_gt(0.0).to_bitmask() & asked;
                for group in groups.as_slice() {
                    let sphere = &self.world.spheres()[group.ball.index()];
                    if sphere.outside(light.position()) <= 0.0 {
                        lit &= !group.lanes;
                    }
                }
                if lit == 0 {
                    return;
                }
                if let Some(shadows) = shadows {
                    lit = shadows.lit_by_point(simd, index, sight, groups, lit);
                }
                let lit = mask64x8::from_bitmask(simd, lit);
                let half_cosine = points.half_cosine_of_each(&toward, cosine);
                let mut own_diffuse: Light<S, CHANNELS> = splat(simd, Color::ZERO);
                let mut own_mirrored: Light<S, CHANNELS> = splat(simd, Color::ZERO);
                for look in &looks.list[..looks.count] {
                    let lit = Some(lit & mask64x8::from_bitmask(simd, look.lanes));
                    let reflectance = look.reflectance;
                    let intensity = light.intensity();
                    reflectance.add_diffuse(intensity, cosine, lit, &mut own_diffuse);
                    reflectance.add_highlight(intensity, half_cosine, lit, &mut own_mirrored);
                }
                for channel in 0..CHANNELS {
                    // Where nothing is lit the factor may be anything.
                    let zero = f64x8::splat(simd, 0.0);
                    let factor = lit.select(factor, zero);
                    diffuse[channel] += own_diffuse[channel] * factor;
                    mirrored[channel] += own_mirrored[channel] * factor;
                }
            },
        )
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

    /// The shading normals.
    #[cold]
    #[inline(never)]
    pub(super) fn shading_normals<S: Simd>(
        &self,
        simd: S,
        sight: &Sight<S>,
        groups: &Groups<'_>,
        place: Place,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Vectors<S> {
        let mut normal = sight.normal;
        for Group { ball, lanes } in groups.as_slice() {
            let (sphere, lanes) = (ball.index(), lanes & !sight.inner);
            if let (Some(roughness), 1..) = (&self.world.material(sphere).roughness, lanes) {
                simd.vectorize(
                    #[inline(always)]
                    || {
                        let mask = mask64x8::from_bitmask(simd, lanes);
                        let first = sight.normal.lane(lanes.trailing_zeros() as usize);
                        // The lanes of other spheres repeat one: so they cost no cells of noise.
                        let own = sight.normal.or(mask, &Vectors::splat(simd, first));
                        let radius = self.world.spheres()[sphere].radius();
                        let mut rough = [own.x, own.y, own.z];
                        if let Some(bumps) = roughness.bumps(radius, sphere) {
                            let noise = noise.get_or_insert_with(|| Box::new(NoiseCells::new()));
                            rough = bumps.tilt_lanes(simd, rough, noise);
                        } else {
                            let mut factors = Vectors::splat(simd, DVec3::ONE);
                            for lane in set_bits(lanes) {
                                let key = PixelKey {
                                    col: place.col_of(lane),
                                    row: place.row,
                                    frame: self.frame,
                                };
                                factors.set_lane(lane, roughness.pixel_factors(sphere, key));
                            }
                            rough[0] *= factors.x;
                            rough[1] *= factors.y;
                            rough[2] *= factors.z;
                        }
                        let [x, y, z] = unit(rough);
                        normal = Vectors { x, y, z }.or(mask, &normal);
                    },
                );
            }
        }
        normal
    }
}

/// The materials that eight rays see, each once, and memory of their noise.
pub(super) struct Looks<'scene> {
    list: [Look<'scene>; LANES],
    count: usize,
    has_highlight: bool,
    /// Cells of the noise of rough surfaces.
    pub(super) noise: Option<Box<NoiseCells>>,
}

/// A material, and the rays that see it as bits.
#[derive(Clone, Copy)]
struct Look<'scene> {
    reflectance: &'scene Reflectance,
    number: u32,
    lanes: u64,
}

impl<'scene> Looks<'scene> {
    /// One look: that of the world's only material, or any, where there is a sphere.
    pub(super) fn new(shading: &'scene Shading<'_>) -> Self {
        let reflectance = &shading.reflectances[0];
        let look = Look {
            reflectance,
            number: 0,
            lanes: 0xff,
        };
        Self {
            list: [look; LANES],
            count: 1,
            has_highlight: reflectance.highlight.is_some(),
            noise: None,
        }
    }

    /// Takes in what is seen.
    #[inline(always)]
    pub(super) fn see(&mut self, shading: &'scene Shading<'_>, groups: &Groups<'_>) {
        if shading.reflectances.len() > 1 {
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
            let reflectance = &shading.reflectances[number as usize];
            self.list[self.count] = Look {
                reflectance,
                number,
                lanes: group.lanes,
            };
            self.count += 1;
            self.has_highlight |= reflectance.highlight.is_some();
        }
    }

    /// The albedo of the first material, or those of others where they are seen.
    #[inline(always)]
    fn albedo<S: Simd, const CHANNELS: usize>(&self, simd: S) -> Light<S, CHANNELS> {
        let mut albedo: Light<S, CHANNELS> = splat(simd, self.list[0].reflectance.albedo);
        for look in &self.list[1..self.count] {
            let mask = mask64x8::from_bitmask(simd, look.lanes);
            let other: Light<S, CHANNELS> = splat(simd, look.reflectance.albedo);
            for channel in 0..CHANNELS {
                albedo[channel] = mask.select(other[channel], albedo[channel]);
            }
        }
        albedo
    }
}
