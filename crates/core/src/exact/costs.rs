//! Estimates of the light that rules miss on a surface where it changes too fast for them.

use fearless_simd::Simd;
use glam::DVec3;

use super::interior::samples::Rule;
use super::points::Points;
use super::scene::{InCamera, Light};
use super::surface::Finish;
use crate::light::lobe::Beyond;
use crate::light::shading_normal::ShadingNormal;
use crate::model::camera::Projection;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::vectors::Vectors;

impl Finish {
    /// The points, bit by bit, at which light may be too sharp for a rule: where normals and half vectors
    /// turn by an angle δ toward each other, a highlight falls to exp(−κ) of its height with
    /// κ = shininess · δ² / 2; too sharp is more than `most`. So it is with diffuse light, its
    /// exponent, and normals that turn toward the light.
    ///
    /// Points at which it is nowhere higher than `negligible` do not count.
    ///
    /// On a rough surface shading normals turn faster than the sphere's, from ones that are tilted already: how
    /// high light may be is told by bounds of both, how fast it falls by [`Self::usual_slope`].
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
        let usual = turn * self.usual_slope();
        let turn_sq = usual * usual;
        let turn = turn * self.shading_normal.slope_bound() + self.shading_normal.most_tilt();
        let is_turning = (turn_sq * self.sharpness()).simd_gt(2.0 * most);
        if is_turning.to_bitmask() == 0 {
            return 0;
        }
        let Self { reflectance, .. } = self;
        let viewed = self.viewed(points, &points.normal);
        // Beside these points a lamp may face more of the surface.
        let light = light.in_all_directions();
        let (cosine, half_cosine, factor) = light.on_points(points, &viewed, Beyond::Nothing);
        let factor = factor.unwrap_or(f64x8::splat(simd, 1.0));
        let falloff = &reflectance.diffuse;
        let [brightest, _] = reflectance.brightest(light.intensity);
        let height = falloff.of_clamped(highest_cosine(simd, cosine, turn)) * brightest * factor;
        let is_turning = (turn_sq * falloff.exponent).simd_gt(2.0 * most);
        let mut found = (is_turning & height.simd_gt(negligible)).to_bitmask();
        if let Some((strength, falloff)) = &reflectance.highlight {
            let highest = highest_cosine(simd, half_cosine, turn);
            let height = falloff.of_clamped(highest) * *strength * factor;
            let is_turning = (turn_sq * falloff.exponent).simd_gt(2.0 * most);
            found |= (is_turning & height.simd_gt(negligible)).to_bitmask();
        }
        found
    }

    /// A bound of the highlight of a light in the brightest channel, where normals and half vectors turn by no
    /// more than `turn` from those of points.
    #[inline(always)]
    pub(crate) fn highest_highlight<S: Simd>(
        &self,
        simd: S,
        points: &Points<S>,
        light: &Light,
        turn: f64,
    ) -> f64x8<S> {
        let Some((_, falloff)) = &self.reflectance.highlight else {
            return f64x8::splat(simd, 0.0);
        };
        let viewed = self.viewed(points, &points.normal);
        let cosine = viewed.cosine(light.toward);
        let half_cosine = viewed.half_cosine(light.toward, cosine);
        let highest = highest_cosine(simd, half_cosine, f64x8::splat(simd, turn));
        let [_, brightest] = self.reflectance.brightest(light.intensity);
        falloff.of_clamped(highest) * brightest
    }

    /// The factor by which the shading normals turn faster than the sphere's, where they turn fast: half of the bound,
    /// and four times the root of the mean square over bumps. Not tuned.
    pub(crate) fn usual_slope(&self) -> f64 {
        let slope = self.shading_normal.slope_bound();
        match self.shading_normal {
            ShadingNormal::Bumpy(_) => (0.5 * slope).max(1.0),
            ShadingNormal::Smooth | ShadingNormal::Factors(_) => slope,
        }
    }

    /// The largest exponent.
    pub(crate) fn sharpness(&self) -> f64 {
        let [exponent, shininess] = self.reflectance.exponents();
        exponent.max(shininess)
    }

    /// Returns whether rules need the cosines of lights: without bumps, and with exponents up to 2, second
    /// differences of light tell enough.
    pub(crate) fn needs_cosines(&self) -> bool {
        const BLUNT: f64 = 2.0;
        self.is_rough() || self.sharpness() > BLUNT
    }

    /// A bound of how fast light of some lights, bit by bit, goes with the shading normal, for exponents from 1 on.
    pub(crate) fn steepest(&self, scene: &InCamera<'_>, lights: u64) -> f64 {
        let [exponent, shininess] = self.reflectance.exponents();
        // At its steepest a power of a cosine goes by less than this with the angle.
        let of_highlight = shininess.sqrt().max(shininess.min(1.0));
        let mut slope = 0.0;
        for index in set_bits(lights) {
            let [diffuse, specular] = self.reflectance.brightest(scene.lights[index].intensity);
            slope += diffuse * exponent.max(1.0) + specular * of_highlight;
        }
        slope
    }

    /// The diffuse light and the highlight of a light in the brightest channel, where the surface faces
    /// it by `cosine`, the highlight's power is `highlight`, and shares of them count.
    #[inline(always)]
    pub(crate) fn lobes<S: Simd>(
        &self,
        light: &Light,
        cosine: f64x8<S>,
        highlight: f64x8<S>,
        shares: [f64x8<S>; 2],
    ) -> f64x8<S> {
        let [diffuse, specular] = self.reflectance.brightest(light.intensity);
        let cosine = cosine.max(cosine * 0.0);
        let falloff = &self.reflectance.diffuse;
        falloff.of_clamped(cosine) * diffuse * shares[0] + highlight * specular * shares[1]
    }

    /// The power of a highlight, of any light, where n·h, at least 0, is this.
    #[inline(always)]
    pub(crate) fn highlight_of<S: Simd>(&self, half_cosine: f64x8<S>) -> f64x8<S> {
        match &self.reflectance.highlight {
            Some((_, falloff)) => falloff.of_clamped(half_cosine),
            None => half_cosine * 0.0,
        }
    }

    /// The cost of what a rule misses where in a pixel the surface turns from a light, as [`cost_of_kink`] has it, when its
    /// cosine changes by `range` there and a highlight that ends there is as high as `highlight`.
    #[inline(always)]
    pub(crate) fn cost_of_turning<S: Simd>(
        &self,
        light: &Light,
        range: f64x8<S>,
        highlight: f64x8<S>,
        rule: Rule,
    ) -> f64x8<S> {
        let falloff = &self.reflectance.diffuse;
        let [diffuse, specular] = self.reflectance.brightest(light.intensity);
        let range = range.min(range * 0.0 + 1.0);
        falloff.of_clamped(range) * (diffuse * cost_of_kink(falloff.exponent, rule))
            + highlight * specular
    }

    /// The cells of this size, with these rays through their middles, in which light jumps, or nearly, by more
    /// than `negligible` at terminators of bumps: a highlight may end there.
    ///
    /// At n·l = 0, n·h is at most the length of what of h is across l: with θ between l and v, to
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
        let mut jumps = mask64x8::splat(simd, self.reflectance.diffuse.exponent < 1.0);
        let Some((strength, falloff)) = &self.reflectance.highlight else {
            return jumps;
        };
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        // Rays have a length of at least 1: so far may one turn from the middle's.
        let mut turn = 0.5 * (size[0] + size[1]);
        let mut scale = -one / middle.length_squared().sqrt();
        let mut direction = *middle;
        if scene.projection == Projection::Parallel {
            direction = Vectors::splat(simd, DVec3::Z);
            (turn, scale) = (0.0, -one);
        }
        for light in &scene.lights {
            if light.near.is_some() {
                // Light comes from anywhere.
                jumps |= mask64x8::splat(simd, strength * light.intensity.max_element() > 0.0);
                continue;
            }
            let along = direction.dot_one(light.toward) * scale;
            let sine_sq = (along * -0.5 + (0.5 + 0.5 * turn)).max(zero).min(one);
            let height = falloff.of_clamped(sine_sq.sqrt());
            let most = strength * light.intensity.max_element();
            jumps |= (height * most).simd_gt(negligible);
        }
        jumps
    }

    /// The same where in a pixel a highlight ends, when n·h changes by `range` there.
    #[inline(always)]
    pub(crate) fn cost_of_highlight_end<S: Simd>(
        &self,
        light: &Light,
        range: f64x8<S>,
        rule: Rule,
    ) -> f64x8<S> {
        let Some((strength, falloff)) = &self.reflectance.highlight else {
            return range * 0.0;
        };
        let intensity = light.intensity.max_element();
        let share = cost_of_kink(falloff.exponent, rule);
        let range = range.min(range * 0.0 + 1.0);
        falloff.of_clamped(range) * (strength * intensity * share)
    }

    /// Returns whether powers of cosines, and of a blunt highlight, are smooth where they begin.
    pub(crate) fn has_whole_exponent(&self) -> bool {
        let [exponent, shininess] = self.reflectance.exponents();
        exponent.fract() == 0.0 && (!self.has_blunt_highlight() || shininess.fract() == 0.0)
    }

    /// Returns whether diffuse light begins with a power that is not whole, and is not smooth there.
    pub(crate) fn has_fractional_exponent(&self) -> bool {
        /// Powers that are smooth enough where they begin: the sixth derivative is bounded.
        const SMOOTH: f64 = 6.0;
        let [exponent, _] = self.reflectance.exponents();
        exponent.fract() != 0.0 && exponent < SMOOTH
    }

    /// Returns whether a highlight's end is seen, as it is where bumps turn from eye and light together.
    pub(crate) fn has_blunt_highlight(&self) -> bool {
        /// Powers that are smooth enough where they begin: x⁶ has five continuous derivatives, as many as
        /// rules of three points use.
        const SMOOTH: f64 = 6.0;
        let [_, shininess] = self.reflectance.exponents();
        self.is_rough() && self.reflectance.highlight.is_some() && shininess < SMOOTH
    }
}

/// The error of a rule for max(0, a x + b y − c) to a power, at most, where the line cuts a pixel across which a x + b y
/// changes by 1: as a test finds it, not proved. From 1 on it is that of Gauss's rule with three points a side; five samples
/// are off by 0.03 for a line, of which other estimates know.
///
/// # Source
/// Below 1 the errors fall nearly like powers whose exponent is that of the cosine, from those of a step: 0.222 and 0.36.
fn cost_of_kink(power: f64, rule: Rule) -> f64 {
    /// Above the largest error for a line.
    const OF_LINE: f64 = 0.02;
    let (of_step, of_line) = match rule {
        Rule::Star => (0.363, 0.0818),
        Rule::Grid => (0.226, 0.0787),
    };
    if power < 1.0 {
        of_step * libm::pow(of_line, power)
    } else {
        OF_LINE * power
    }
}

/// The largest cosine of an angle that is `turn` less at most than one with this cosine:
/// cos(θ − δ) ≤ cos θ + δ sin θ where δ ≤ θ, and ≤ cos θ + δ anywhere. Not negative.
#[inline(always)]
pub(crate) fn highest_cosine<S: Simd>(simd: S, cosine: f64x8<S>, turn: f64x8<S>) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let cosine = cosine.min(one);
    let sine = (one - cosine * cosine).max(zero).sqrt();
    let nearer = (cosine + turn * sine).min(one).max(zero);
    let farther = (cosine + turn).min(one).max(zero);
    turn.simd_ge(sine).select(farther, nearer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::interior::samples::POINTS;

    /// The mean of max(0, a x + b y + t)^p over −½ ≤ x, y ≤ ½.
    fn mean(power: f64, [a, b]: [f64; 2], t: f64) -> f64 {
        let raised = |value: f64, power: f64| libm::pow(value.max(0.0), power);
        let (first, second) = (power + 1.0, power + 2.0);
        if b == 0.0 {
            return (raised(0.5 * a + t, first) - raised(t - 0.5 * a, first)) / (a * first);
        }
        let corners: [(f64, f64); 4] = [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)];
        let corners = corners.map(|(x, y)| (x * y).signum() * raised(a * x + b * y + t, second));
        corners.iter().sum::<f64>() / (a * b * first * second)
    }

    #[test]
    fn kinks_cost_no_more_than_they_are_said_to() {
        for power in [
            0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0, 1.4, 2.0, 3.7, 20.0,
        ] {
            for rule in [Rule::Star, Rule::Grid] {
                if rule == Rule::Star && power >= 1.0 {
                    // Other estimates are added.
                    continue;
                }
                let mut worst = 0.0_f64;
                for direction in 0..=10 {
                    let b = 0.05 * f64::from(direction);
                    let slopes = [1.0 - b, b];
                    for place in 0..=400 {
                        let t = f64::from(place) / 400.0 - 0.5;
                        let value = |u: f64, v: f64| {
                            libm::pow((slopes[0] * u + slopes[1] * v + t).max(0.0), power)
                        };
                        let sum: f64 = POINTS[..rule.samples()]
                            .iter()
                            .map(|point| {
                                let weight = match rule {
                                    Rule::Star => point.star,
                                    Rule::Grid => point.gauss,
                                };
                                weight * value(point.u, point.v)
                            })
                            .sum();
                        worst = worst.max((sum - mean(power, slopes, t)).abs());
                    }
                }
                let cost = cost_of_kink(power, rule);
                assert!(worst <= cost, "{power} {rule:?}: {worst} {cost}");
                let is_near = power > 1.0 || worst > 0.8 * cost;
                assert!(is_near, "{power} {rule:?}: {worst} {cost}");
            }
        }
    }
}
