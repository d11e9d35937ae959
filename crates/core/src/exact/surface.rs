//! The light of points of spheres, eight at a time.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::interior::facings::Facings;
use super::points::Points;
use super::relief::Relief;
use super::scene::{InCamera, Light, MOST_LIGHTS};
use crate::model::color::Color;
use crate::model::material::Material;
use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::power::Power;
use crate::numeric::vectors::Vectors;

/// What the light of a sphere's outer side depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish<'scene> {
    material: &'scene Material,
    albedo: Color,
    diffuse: Power,
    specular: Option<(f64, Power)>,
    bumps: Relief,
}

impl<'scene> Finish<'scene> {
    pub(crate) fn new(scene: &InCamera<'scene>, sphere: usize, pixel: PixelKey) -> Self {
        let material = scene.world.material(sphere);
        let bumps = match &material.roughness {
            None => Relief::Smooth,
            Some(roughness) => {
                match roughness.bumps(scene.world.spheres()[sphere].radius(), sphere) {
                    Some(bumps) => Relief::Bumpy(bumps),
                    None => Relief::Factors(roughness.pixel_factors(sphere, pixel)),
                }
            }
        };
        Self {
            material,
            albedo: scene.world.albedo(sphere),
            diffuse: Power::new(material.exponent),
            specular: material
                .highlight
                .map(|highlight| (highlight.strength, Power::new(highlight.shininess))),
            bumps,
        }
    }

    /// Where light may be too sharp for a rule, bit by bit: where normals and half vectors turn by an
    /// angle δ toward each other, a highlight falls to exp(−κ) of its height with
    /// κ = shininess · δ² / 2; too sharp is more than `most`. So it is with diffuse light, its
    /// exponent, and normals that turn toward the light.
    ///
    /// Points at which it is nowhere higher than `negligible` do not count.
    #[inline(always)]
    pub(crate) fn too_sharp<S: Simd>(
        &self,
        simd: S,
        points: &Points<S>,
        light: &Light,
        turn: f64x8<S>,
        most: f64,
        negligible: f64,
    ) -> u64 {
        let one = f64x8::splat(simd, 1.0);
        let turn_sq = turn * turn;
        let is_turning = (turn_sq * self.sharpness()).simd_gt(2.0 * most);
        if is_turning.to_bitmask() == 0 {
            return 0;
        }
        let facing = points.normal.dot_one(light.toward);
        let diffuse = (self.albedo * light.intensity).max_element();
        let height = self.diffuse.lanes(highest_cosine(facing, turn)) * diffuse;
        let is_turning = (turn_sq * self.material.exponent).simd_gt(2.0 * most);
        let mut found = (is_turning & height.simd_gt(negligible)).to_bitmask();
        if let (Some((strength, power)), Some(highlight)) =
            (&self.specular, self.material.highlight)
        {
            let scale = -one / points.ray_sq.sqrt();
            let to_eye = points.normal.dot(&points.ray) * scale;
            let along = points.ray.dot_one(light.toward) * scale;
            let length_sq = (along * 2.0 + 2.0).max(one * f64::MIN_POSITIVE);
            let half = (facing + to_eye) / length_sq.sqrt();
            let height = power.lanes(highest_cosine(half, turn)) * *strength;
            let is_turning = (turn_sq * highlight.shininess).simd_gt(2.0 * most);
            found |= (is_turning & height.simd_gt(negligible)).to_bitmask();
        }
        found
    }

    /// The largest exponent.
    pub(crate) fn sharpness(&self) -> f64 {
        let shininess = self
            .material
            .highlight
            .map_or(0.0, |highlight| highlight.shininess);
        self.material.exponent.max(shininess)
    }

    /// Whether rules want to know how points face the lights.
    pub(crate) fn is_told(&self) -> bool {
        const BLUNT: f64 = 2.0;
        self.is_rough() || self.sharpness() > BLUNT
    }

    /// The exponents of diffuse light and of the highlight.
    pub(crate) fn exponents(&self) -> [f64; 2] {
        let shininess = self
            .material
            .highlight
            .map_or(0.0, |highlight| highlight.shininess);
        [self.material.exponent, shininess]
    }

    /// What a light's diffuse light and its highlight contribute in the brightest channel, where the
    /// surface faces the light by `facing`, the highlight's power is `spot`, and shares of them
    /// count.
    #[inline(always)]
    pub(crate) fn lobes<S: Simd>(
        &self,
        light: &Light,
        facing: f64x8<S>,
        spot: f64x8<S>,
        shares: [f64x8<S>; 2],
    ) -> f64x8<S> {
        let diffuse = (self.albedo * light.intensity).max_element();
        let strength = self.specular.map_or(0.0, |(strength, _)| strength);
        let specular = strength * light.intensity.max_element();
        let facing = facing.max(facing * 0.0);
        self.diffuse.lanes(facing) * diffuse * shares[0] + spot * specular * shares[1]
    }

    /// Whether the surface may avert itself from a light that its sphere faces.
    pub(crate) fn is_rough(&self) -> bool {
        !matches!(self.bumps, Relief::Smooth)
    }

    /// How many times as fast as the sphere's the normals turn, at most.
    pub(crate) fn slope_bound(&self) -> f64 {
        match &self.bumps {
            Relief::Smooth => 1.0,
            Relief::Factors(factors) => factors.max_element() / factors.min_element(),
            Relief::Bumpy(bumps) => bumps.slope_bound(),
        }
    }

    /// Cells of the noise that a radius spans.
    pub(crate) fn grain(&self) -> f64 {
        match &self.bumps {
            Relief::Smooth | Relief::Factors(_) => 0.0,
            Relief::Bumpy(bumps) => bumps.cells(),
        }
    }

    /// What it may cost a rule of three points a side that in a pixel the surface turns from a light,
    /// when its facing of the light changes by `range` there and a highlight that ends there is as
    /// high as `spot`.
    #[inline(always)]
    pub(crate) fn cost_of_turning<S: Simd>(
        &self,
        scene: &InCamera<'_>,
        light: usize,
        range: f64x8<S>,
        spot: f64x8<S>,
    ) -> f64x8<S> {
        let exponent = self.material.exponent;
        let intensity = scene.lights[light].intensity;
        let diffuse = (self.albedo * intensity).max_element();
        let specular = self.specular.map_or(0.0, |(strength, _)| strength);
        self.diffuse.lanes(range.min(range * 0.0 + 1.0)) * (diffuse * cost_of_kink(exponent))
            + spot * (specular * intensity.max_element())
    }

    /// Where light jumps, or nearly, by more than `negligible` at terminators of bumps, in cells of
    /// this size with these rays through their middles: a highlight may end there.
    ///
    /// Where n·l = 0, n·h is at most the length of what of h is across l: with θ between l and v, to
    /// which h is halfway, sin(θ/2).
    #[inline(always)]
    pub(crate) fn jumps<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        middle: &Vectors<S>,
        size: [f64; 2],
        negligible: f64,
    ) -> mask64x8<S> {
        let mut jumps = mask64x8::splat(simd, self.material.exponent < 1.0);
        let Some((strength, power)) = &self.specular else {
            return jumps;
        };
        let one = f64x8::splat(simd, 1.0);
        // Rays have a length of at least 1: so far may one turn from the middle's.
        let turn = 0.5 * (size[0] + size[1]);
        let scale = -one / middle.length_squared().sqrt();
        for light in &scene.lights {
            let along = middle.dot_one(light.toward) * scale;
            let sine_sq = (along * -0.5 + (0.5 + 0.5 * turn)).max(one * 0.0).min(one);
            let height = power.lanes(sine_sq.sqrt());
            let most = strength * light.intensity.max_element();
            jumps |= (height * most).simd_gt(negligible);
        }
        jumps
    }

    /// What light may be missed where lines that come near a terminator of bumps do not show it: as
    /// much as a rule is off by where their facing of the light, which differs by `range`, turns.
    #[inline(always)]
    pub(crate) fn cost_of_any_turn<S: Simd>(
        &self,
        simd: S,
        light: &Light,
        range: f64,
        jumps: bool,
    ) -> f64 {
        /// Of a piece, what is beyond its outermost lines.
        const BEYOND: f64 = 0.04;
        let range = f64x8::splat(simd, range.min(1.0));
        let diffuse = (self.albedo * light.intensity).max_element();
        let specular = match self.specular {
            Some((strength, _)) if jumps => strength,
            _ => 0.0,
        };
        (self.diffuse.lanes(range) * (diffuse * cost_of_kink(self.material.exponent)))[0]
            + specular * light.intensity.max_element() * BEYOND
    }

    /// What it may cost that in a pixel a highlight ends, when its half vector is faced by `range` more
    /// here than there.
    #[inline(always)]
    pub(crate) fn cost_of_spot<S: Simd>(
        &self,
        scene: &InCamera<'_>,
        light: usize,
        range: f64x8<S>,
    ) -> f64x8<S> {
        let Some((strength, power)) = &self.specular else {
            return range * 0.0;
        };
        let intensity = scene.lights[light].intensity.max_element();
        let share = cost_of_kink(self.exponents()[1]);
        power.lanes(range.min(range * 0.0 + 1.0)) * (strength * intensity * share)
    }

    /// The normals that light is computed with.
    #[inline(always)]
    pub(crate) fn normal<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        points: &Points<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Vectors<S> {
        let [normal] = self.normals(simd, scene, &[*points], noise);
        normal
    }

    /// The normals that light is computed with, of several points in each lane: side by side they wait
    /// less for each other's roots and quotients.
    #[inline(always)]
    pub(crate) fn normals<S: Simd, const COUNT: usize>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        points: &[Points<S>; COUNT],
        noise: &mut Option<Box<NoiseCells>>,
    ) -> [Vectors<S>; COUNT] {
        let mut normals = [points[0].normal; COUNT];
        for (normal, points) in normals.iter_mut().zip(points) {
            *normal = points.normal;
        }
        if !matches!(self.bumps, Relief::Smooth) {
            self.bumps.turn(simd, scene, &mut normals, noise);
        }
        normals
    }

    /// Whether powers of what faces a light, and of a blunt highlight, are smooth where they begin.
    pub(crate) fn has_whole_exponent(&self) -> bool {
        let [exponent, shininess] = self.exponents();
        exponent.fract() == 0.0 && (!self.has_blunt_spot() || shininess.fract() == 0.0)
    }

    /// Whether a highlight's end is seen, as it is where bumps turn from eye and light together.
    pub(crate) fn has_blunt_spot(&self) -> bool {
        /// Powers that are as smooth as need be where they begin.
        const SMOOTH: f64 = 6.0;
        self.is_rough() && self.specular.is_some() && self.exponents()[1] < SMOOTH
    }

    /// Whether light is the cosine of the angle to it, and nothing else.
    pub(crate) fn is_plain(&self) -> bool {
        self.material.exponent == 1.0 && self.specular.is_none() && !self.is_rough()
    }

    /// More diffuse light than some lights, bit by bit, make in any channel.
    pub(crate) fn brightest(&self, scene: &InCamera<'_>, lights: u64) -> f64 {
        let mut sum = 0.0;
        for (index, light) in scene.lights.iter().enumerate() {
            if lights >> index & 1 == 1 {
                sum += (self.albedo * light.intensity).max_element();
            }
        }
        sum
    }

    /// The light of some lights, bit by bit, that points without bumps send to the eye, without what they
    /// send where none of them reaches; on where the surface turns from them, as smooth as it is.
    #[inline(always)]
    pub(crate) fn unclamped<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        points: &Points<S>,
        lights: u64,
    ) -> [f64x8<S>; 3] {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let mut sum = [zero; 3];
        let (mut scale, mut to_eye) = (zero, zero);
        if self.specular.is_some() {
            scale = -one / points.ray_sq.sqrt();
            to_eye = points.normal.dot(&points.ray) * scale;
        }
        for (index, light) in scene.lights.iter().enumerate() {
            if lights >> index & 1 == 0 {
                continue;
            }
            let facing = points.normal.dot_one(light.toward);
            let diffuse = if self.material.exponent == 1.0 {
                facing
            } else {
                self.diffuse.lanes(facing.max(zero).min(one))
            };
            let color = self.albedo * light.intensity;
            for channel in 0..scene.channels {
                sum[channel] += diffuse * color[channel];
            }
            if let Some((strength, power)) = &self.specular {
                let along = points.ray.dot_one(light.toward) * scale;
                let length_sq = (along * 2.0 + 2.0).max(one * f64::MIN_POSITIVE);
                let half = (facing + to_eye) / length_sq.sqrt();
                let spot = power.lanes(half.max(zero).min(one));
                for (channel, sum) in sum.iter_mut().enumerate().take(scene.channels) {
                    *sum += spot * (light.intensity[channel] * strength);
                }
            }
        }
        sum
    }

    /// The light that points with these normals, of [`Self::normals`], send to the eye, in the channels
    /// that `C` counts; `lit` tells for each light, bit by bit, which of the points it reaches.
    #[inline(always)]
    pub(crate) fn radiance<S: Simd>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        points: &Points<S>,
        normal: &Vectors<S>,
        lit: &[u64; MOST_LIGHTS],
        mut facings: Option<&mut Facings<S>>,
    ) -> [f64x8<S>; 3] {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let constant = self.albedo * scene.ambient;
        let mut sum = [one * constant.x, one * constant.y, one * constant.z];
        // With v = −d / |d|: n·h = (n·l + n·v) / |l + v|, and |l + v|² = 2 + 2 l·v.
        let (mut scale, mut to_eye) = (zero, zero);
        if self.specular.is_some() {
            scale = -one / points.ray_sq.sqrt();
            to_eye = normal.dot(&points.ray) * scale;
        }
        if let Some(facings) = &mut facings {
            for (index, light) in scene.lights.iter().enumerate() {
                let facing = normal.dot_one(light.toward);
                facings.note(index, facing);
            }
            facings.taken += 1;
        }
        for (index, light) in scene.lights.iter().enumerate() {
            if lit[index] == 0 {
                continue;
            }
            let intensity = light.intensity;
            let facing = normal.dot_one(light.toward);
            let faces = facing.simd_gt(0.0) & mask64x8::from_bitmask(simd, lit[index]);
            // Rounding may make it a little more than 1.
            let diffuse = self.diffuse.lanes(facing.max(zero).min(one));
            let diffuse = faces.select(diffuse, zero);
            let color = self.albedo * intensity;
            for channel in 0..scene.channels {
                sum[channel] += diffuse * color[channel];
            }
            if let Some((strength, power)) = &self.specular {
                let along = points.ray.dot_one(light.toward) * scale;
                let length_sq = (along * 2.0 + 2.0).max(one * f64::MIN_POSITIVE);
                let half = (facing + to_eye) / length_sq.sqrt();
                let spot = power.lanes(half.max(zero).min(one));
                if let Some(facings) = &mut facings {
                    facings.note_spot(index, spot, half);
                }
                let spot = faces.select(spot, zero);
                for channel in 0..scene.channels {
                    sum[channel] += spot * (intensity[channel] * strength);
                }
            }
        }
        sum
    }
}

/// More than the error of Gauss's rule with three points for max(0, x − a) to a power, wherever a is;
/// below 1, that of a step.
fn cost_of_kink(power: f64) -> f64 {
    const OF_LINE: f64 = 0.02;
    const OF_ROOT: f64 = 0.23;
    if power < 1.0 {
        OF_ROOT
    } else {
        OF_LINE * power
    }
}

/// The largest cosine of an angle that is `turn` less at most than one with this cosine:
/// cos(θ − δ) ≤ cos θ + δ sin θ where δ ≤ θ. Not negative.
#[inline(always)]
fn highest_cosine<S: Simd>(cosine: f64x8<S>, turn: f64x8<S>) -> f64x8<S> {
    let zero = cosine * 0.0;
    let one = zero + 1.0;
    let cosine = cosine.min(one);
    let sine = (one - cosine * cosine).max(zero).sqrt();
    let nearer = (cosine + turn * sine).min(one).max(zero);
    turn.simd_ge(sine).select(one, nearer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::interior::samples::{GRID, POINTS, WEIGHTS};

    #[test]
    fn kinks_cost_no_more_than_they_are_said_to() {
        let places = GRID[1].map(|number| POINTS[number].u);
        for power in [0.1, 0.5, 0.9, 1.0, 1.4, 2.0, 3.7, 20.0] {
            let error = |a: f64| {
                let value = |x: f64| libm::pow((x - a).max(0.0), power);
                let exact = value(0.5) * (0.5 - a) / (power + 1.0);
                let sum = |(x, weight): (&f64, &f64)| weight * value(*x);
                (places.iter().zip(&WEIGHTS).map(sum).sum::<f64>() - exact).abs()
            };
            let worst = (0..1000).map(|index| error(f64::from(index) / 1000.0 - 0.5));
            let worst = worst.fold(0.0, f64::max);
            assert!(worst <= cost_of_kink(power), "{power}: {worst}");
            assert!(
                power > 1.0 || worst > 0.05 * cost_of_kink(power),
                "{power}: {worst}"
            );
        }
    }
}
