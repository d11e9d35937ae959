//! The error of rules with five and nine samples for powers of cosines that are not whole, which are singular where the
//! cosine is 0.

use fearless_simd::Simd;

use super::filled::Filled;
use super::light_cosines::{CosineRange, LightCosines};
use super::samples::{Rule, TO_CORNER};
use crate::light::reflection::Falloff;
use crate::numeric::lanes::f64x8;
use crate::numeric::pair::both;

/// From this exponent on a power is smooth enough at 0: its fourth derivative is finite.
const SMOOTH: f64 = 4.0;

impl<S: Simd> Filled<'_, S> {
    /// The error of a rule for the powers of all cosines, in light.
    ///
    /// An estimate, as the cosine is taken to be linear, with the range that parabolas through the samples have in the
    /// corners. A cosine that falls between its samples, and rises again, would fool it: bumps smaller than half a
    /// pixel, which are not integrated by these rules.
    #[inline(always)]
    pub(super) fn of_powers(&self, simd: S, rule: Rule, cosines: &LightCosines<S>) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let powers = both(self.finish.reflectance.exponents(), |exponent| {
            let is_singular = exponent < SMOOTH && exponent.fract() != 0.0;
            is_singular.then_some(Power(exponent))
        });
        let mut sum = zero;
        if powers.iter().all(Option::is_none) {
            return sum;
        }
        for (index, light) in self.scene.lights.iter().enumerate() {
            if self.lit[index] == 0 {
                continue;
            }
            let [diffuse, specular] = self.finish.reflectance.brightest(light.intensity);
            if let Some(power) = &powers[0] {
                sum += power.missed(rule, &cosines.with_corners(index)) * diffuse;
            }
            if let Some(power) = &powers[1] {
                let mut range = cosines.half_range(index);
                let wider = range.width() * (0.5 * (TO_CORNER - 1.0));
                range.lowest -= wider;
                range.highest += wider;
                sum += power.missed(rule, &range) * specular;
            }
        }
        sum
    }
}

/// How near to 0 cosines may come, relatively to the middle of their range. Those that come nearer, or below, are left to
/// other estimates.
const NEAREST: f64 = 0.95;

/// The middle of a range of cosines; of one that comes nearer to 0, that of its part up to there.
#[inline(always)]
fn middle<S: Simd>(range: &CosineRange<S>) -> f64x8<S> {
    let middle = (range.highest + range.lowest) * 0.5;
    middle
        .max(range.highest * (1.0 / (1.0 + NEAREST)))
        .max(middle * 0.0)
}

/// A power with this exponent.
struct Power(f64);

impl Power {
    /// The error of a rule for this power of a cosine, no more than 1.
    #[inline(always)]
    fn missed<S: Simd>(&self, rule: Rule, range: &CosineRange<S>) -> f64x8<S> {
        let middle = middle(range).min(range.highest * 0.0 + 1.0);
        // Powers above 1 are no larger than the cosine.
        let height = match self.0 < 1.0 {
            true => Falloff::new(self.0).of_clamped(middle),
            false => middle,
        };
        self.share(rule, range) * height
    }

    /// The error of a rule for this power of a cosine, as a share of its value in the middle of its range.
    ///
    /// # Source
    /// With the cosine c (1 + z), z = a x + b y, x and y from −1 to 1 and |a| + |b| = ρ in a corner, the terms of the series of
    /// (1 + z)^e are C(e, k) zᵏ. Nine samples miss 0.0229 C(e, 6) ρ⁶ at most, where a or b is 0. Five samples miss
    /// C(e, 4) ρ⁴ / 30 and 0.0243 C(e, 6) ρ⁶ at most, where a = b. Each further term is about ρ² times the one before.
    #[inline(always)]
    fn share<S: Simd>(&self, rule: Rule, range: &CosineRange<S>) -> f64x8<S> {
        const OF_FOURTH: f64 = 0.0334;
        const OF_SIXTH: f64 = 0.025;
        let least = range.highest * 0.0 + f64::MIN_POSITIVE;
        let twice_middle = (range.highest + range.lowest).max(least);
        let reach = (range.width() / twice_middle).min(least + NEAREST);
        let square = reach * reach;
        let rest = square * -1.0 + 1.0;
        let mut share = square * square * square / rest * (OF_SIXTH * binomial(self.0, 6).abs());
        if rule == Rule::Star {
            share += square * square * (OF_FOURTH * binomial(self.0, 4).abs());
        }
        share
    }
}

/// The coefficient of zᵏ in the series of (1 + z)^e.
fn binomial(exponent: f64, degree: u32) -> f64 {
    (0..degree).fold(1.0, |product, index| {
        let index = f64::from(index);
        product * (exponent - index) / (index + 1.0)
    })
}

#[cfg(test)]
mod tests;
