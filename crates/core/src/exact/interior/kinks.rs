//! Places in pixels where cells of the noise meet: the second derivatives of bumps jump there, and nowhere else.

use fearless_simd::Simd;

use super::filled::Filled;
use super::light_cosines::LightCosines;
use super::samples::Rule;
use crate::exact::costs::highest_cosine;
use crate::exact::points::Points;
use crate::light::reflection::Falloff;
use crate::light::shading_normal::ShadingNormal;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::f64x8;

/// Bumps in eight pixels, or parts of one, as far as rules may miss something of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kinks<S: Simd> {
    /// The jump of second derivatives of shading normals in a pixel, with its sides as units, all jumps together.
    jump: f64x8<S>,
    /// The fourth powers of how many cells the pixels span, times the amplitude.
    span: f64x8<S>,
}

/// The error at a jump of the second derivative by 1 across a line, wherever it lies, with the length of the
/// line's gradient as the unit: half of the largest error for the squares of distances on one side of it. Along
/// diagonals the star sees least. The test `rules_miss_no_more_of_jumps` computes both.
const OF_JUMP_BY_STAR: f64 = 0.003;
const OF_JUMP_BY_GRID: f64 = 0.0008;

impl<S: Simd> Kinks<S> {
    /// The error of a rule for light with this slope by the shading normal.
    #[inline(always)]
    pub(super) fn missed(&self, rule: Rule, slope: &Slope<S>) -> f64x8<S> {
        /// The factor by which jumps are taken to be larger than in the middle of a pixel, with what third derivatives
        /// jump by.
        const CAUTION: f64 = 2.0;
        /// The error of the star for smooth bumps, over the fourth power of cells from the middle to the corners: 1/720
        /// of the mixed fourth derivative, which is taken to be 14 in cells, three times the root of its mean square.
        const OF_SPAN: f64 = 0.08;
        let by_star = self.jump * (CAUTION * OF_JUMP_BY_STAR) + self.span * OF_SPAN;
        let missed = match rule {
            Rule::Star => by_star,
            Rule::Grid => self.jump * (CAUTION * OF_JUMP_BY_GRID),
        };
        slope.change(missed, by_star)
    }

    /// By how much both rules may differ because of jumps.
    #[inline(always)]
    pub(super) fn apart(&self, slope: &Slope<S>) -> f64x8<S> {
        let apart = self.jump * (OF_JUMP_BY_STAR + OF_JUMP_BY_GRID);
        slope.change(apart, apart)
    }
}

impl<S: Simd> Filled<'_, S> {
    /// The jumps in the pixels; `None` of surfaces whose normals have none.
    ///
    /// # Accuracy
    /// An estimate: the lattice planes are taken to cut the pixel along straight lines, where the plane through the
    /// middle of the surface there has them, and a little beyond; jumps are as large as in the pixel's middle, and
    /// larger by what they change by as a rule. Bumps that are larger than that between the middle and a line could
    /// fool it.
    #[inline(never)]
    pub(super) fn kinks(&self, simd: S, noise: &mut Option<Box<NoiseCells>>) -> Option<Kinks<S>> {
        /// The change of jumps for each cell: as much as the root of their mean square, and twice that.
        const CHANGE: f64 = 6.0;
        let ShadingNormal::Bumpy(bumps) = &self.finish.shading_normal else {
            return None;
        };
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let cells = bumps.cells();
                let frame = &self.scene.world_from_camera;
                let points = Points::new(simd, self.ball, self.middle);
                let normal = points.normal.rotated(frame);
                let ray = points.ray.rotated(frame);
                let scale = match self.ball.is_parallel() {
                    true => zero + 1.0,
                    false => points.t,
                };
                let scale = scale * (cells / self.ball.radius);
                let along = points.normal.dot(&points.ray);
                let (across, down) = (points.normal.x / along, points.normal.y / along);
                let [width, height] = self.size;
                let bent = self.turn * cells * (self.nearness * 0.5 + self.turn);
                let mut crossed = [[0; 2]; 3];
                let mut reach = [zero; 3];
                let mut steps = [zero; 3];
                for axis in 0..3 {
                    // Where the ray moves aside, the point moves along the surface.
                    let right = (ray.along(axis) * across * -1.0 + frame.x_axis[axis]) * scale;
                    let up = (ray.along(axis) * down * -1.0 + frame.y_axis[axis]) * scale;
                    let (right, up) = (right * width, up * height);
                    reach[axis] = (right.abs() + up.abs()) * 0.5 + bent;
                    steps[axis] = right * right + up * up;
                    let offset = bumps.offset(normal.along(axis));
                    crossed[axis][0] = (offset - reach[axis]).simd_lt(-0.5).to_bitmask();
                    crossed[axis][1] = (offset + reach[axis]).simd_gt(0.5).to_bitmask();
                }
                let noise = noise.get_or_insert_with(|| Box::new(NoiseCells::new()));
                let mut jump = [0.0; 8];
                for (axis, sides) in crossed.into_iter().enumerate() {
                    for (lanes, side) in sides.into_iter().zip([-1.0, 1.0]) {
                        for lane in set_bits(lanes & self.which) {
                            let beside = reach[(axis + 1) % 3][lane] + reach[(axis + 2) % 3][lane];
                            let here = bumps.jump(normal.lane(lane), (axis, side), noise).length();
                            let change = bumps.amplitude() * CHANGE * beside;
                            jump[lane] += (here + change) * steps[axis][lane];
                        }
                    }
                }
                let span = self.turn * cells;
                let span_sq = span * span;
                Some(Kinks {
                    jump: f64x8::from_array(simd, jump),
                    span: span_sq * span_sq * bumps.amplitude(),
                })
            },
        )
    }

    /// The largest slope of light by the shading normal, in the brightest channel, by its cosines at samples from which no
    /// point is farther than `from_samples` half diagonals.
    #[inline(always)]
    pub(super) fn slope_of_light(
        &self,
        simd: S,
        cosines: &LightCosines<S>,
        from_samples: f64,
    ) -> Slope<S> {
        /// Cosines below which highlights are as steep as there.
        const LEAST: f64 = 0.5;
        /// A cosine below which powers may be as steep as there: what they change by is known otherwise.
        const STEEPEST: f64 = 1e-100;
        let one = f64x8::splat(simd, 1.0);
        let zero = f64x8::splat(simd, 0.0);
        let [exponent, shininess] = self.finish.reflectance.exponents();
        let falloff = self.finish.reflectance.diffuse;
        let mut slope = Slope {
            linear: zero,
            falloff,
            steep: zero,
            most: 0.0,
        };
        let turn = self.turn * (self.finish.usual_slope() * from_samples);
        for (index, light) in self.scene.lights.iter().enumerate() {
            if self.lit[index] == 0 {
                continue;
            }
            let [diffuse, specular] = self.finish.reflectance.brightest(light.intensity);
            let highest = highest_cosine(simd, cosines.highest[index], turn);
            let steepest = if exponent < 1.0 {
                (cosines.lowest[index] - turn).max(one * STEEPEST)
            } else {
                highest
            };
            let power = falloff.of_clamped(steepest.min(one));
            let of_diffuse = match exponent == 1.0 {
                true => one,
                false => power / steepest.max(one * f64::MIN_POSITIVE) * exponent,
            };
            if exponent < 1.0 {
                // Where all of it is averted from the light it stays dark.
                slope.steep += highest.simd_gt(zero).select(of_diffuse * diffuse, zero);
                slope.most += diffuse;
            } else {
                slope.linear += of_diffuse * diffuse;
            }
            if specular > 0.0 {
                let highest = highest_cosine(simd, cosines.halves.highest[index], turn);
                let highest = highest.max(one * LEAST);
                slope.linear +=
                    self.finish.highlight_of(highest) / highest * (shininess * specular);
            }
        }
        slope
    }
}

/// The largest slope of light by the shading normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope<S: Simd> {
    linear: f64x8<S>,
    falloff: Falloff,
    /// The slope of diffuse light with an exponent below 1, and the most of that light.
    steep: f64x8<S>,
    most: f64,
}

impl<S: Simd> Slope<S> {
    /// The error of light where a rule misses so much of the cosine, whose distance from a cubic, which rules know, is less
    /// than `apart`.
    ///
    /// A power e below 1 changes by no more than a change of the cosine to the power of e, in the samples and in the mean.
    #[inline(always)]
    fn change(&self, missed: f64x8<S>, apart: f64x8<S>) -> f64x8<S> {
        let linear = missed * self.linear;
        if self.falloff.exponent >= 1.0 {
            return linear;
        }
        let one = missed * 0.0 + 1.0;
        let most = self.falloff.of_clamped(apart.min(one)) * (2.0 * self.most);
        (missed * self.steep).min(most) + linear
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::exact::interior::samples::{GAUSS_SAMPLES, POINTS, STAR_SAMPLES};

    /// The error of a rule for a power of the cosine c + j/2 max(0, u − a)², and what it is said to miss.
    fn error_of_power(exponent: f64, (lowest, jump, a): (f64, f64, f64), rule: Rule) -> [f64; 2] {
        const STEPS: u32 = 4000;
        let light = |u: f64| {
            let beyond = (u - a).max(0.0);
            libm::pow(lowest + 0.5 * jump * beyond * beyond, exponent)
        };
        let step = |index: u32| light((f64::from(index) + 0.5) / f64::from(STEPS) - 0.5);
        let mean = (0..STEPS).map(step).sum::<f64>() / f64::from(STEPS);
        let samples = POINTS[..rule.samples()].iter();
        let sum: f64 = samples
            .map(|sample| {
                let weight = match rule {
                    Rule::Star => sample.star,
                    Rule::Grid => sample.gauss,
                };
                weight * light(sample.u)
            })
            .sum();
        let missed = dispatch!(Level::new(), simd => {
            let falloff = Falloff::new(exponent);
            let steepest = f64x8::splat(simd, lowest.max(1e-100));
            let slope = Slope {
                linear: f64x8::splat(simd, 0.0),
                falloff,
                steep: falloff.of_clamped(steepest) / steepest * exponent,
                most: 1.0,
            };
            let kinks = Kinks {
                jump: f64x8::splat(simd, jump),
                span: f64x8::splat(simd, 0.0),
            };
            kinks.missed(rule, &slope)[3]
        });
        [(sum - mean).abs(), missed]
    }

    #[test]
    fn steep_powers_miss_no_more_at_kinks_than_they_are_said_to() {
        for exponent in [0.2, 0.4, 0.8] {
            for (lowest, jump) in [
                (0.0, 0.01),
                (0.0, 0.5),
                (1e-4, 0.1),
                (0.01, 0.1),
                (0.3, 0.1),
            ] {
                for rule in [Rule::Star, Rule::Grid] {
                    let places = (0..=100).map(|place| f64::from(place) / 100.0 - 0.5);
                    let (mut worst, mut most) = (0.0_f64, 0.0);
                    for a in places {
                        let [error, missed] = error_of_power(exponent, (lowest, jump, a), rule);
                        assert!(error <= missed, "{exponent} {lowest} {jump} {a} {rule:?}");
                        (worst, most) = (worst.max(error), missed);
                    }
                    assert!(most < 100.0 * worst, "{exponent} {lowest} {jump} {rule:?}");
                }
            }
        }
    }

    /// Rules for the squares of distances on one side of lines, whose integrals are third powers of those at the upper and
    /// lower sides.
    #[test]
    fn rules_miss_no_more_of_jumps() {
        const ROWS: u32 = 400;
        let mut worst = [0.0_f64; 2];
        for angle in 0..=8 {
            let (y, x) = libm::sincos(0.001 + f64::from(angle) * std::f64::consts::FRAC_PI_4 / 8.0);
            for place in 0..70 {
                let start = f64::from(place) * 0.01;
                let square = |distance: f64| distance.max(0.0) * distance.max(0.0);
                let cube = |distance: f64| square(distance) * distance;
                let row = |row: u32| {
                    let middle = y * ((f64::from(row) + 0.5) / f64::from(ROWS) - 0.5) + start;
                    (cube(middle + 0.5 * x) - cube(middle - 0.5 * x)) / (3.0 * x)
                };
                let exact = (0..ROWS).map(row).sum::<f64>() / f64::from(ROWS);
                let (mut star, mut grid) = (0.0, 0.0);
                for (index, sample) in POINTS[..GAUSS_SAMPLES].iter().enumerate() {
                    let light = square(x * sample.u + y * sample.v + start);
                    grid += sample.gauss * light;
                    if index < STAR_SAMPLES {
                        star += sample.star * light;
                    }
                }
                for (worst, sum) in worst.iter_mut().zip([star, grid]) {
                    *worst = worst.max(0.5 * (sum - exact).abs());
                }
            }
        }
        for (worst, most) in worst.into_iter().zip([OF_JUMP_BY_STAR, OF_JUMP_BY_GRID]) {
            assert!(worst <= most && worst > 0.9 * most, "{worst} {most}");
        }
    }
}
