//! Bounds of what rules with one, five and nine samples miss of smooth light.
//!
//! Let x, y be the coordinates of a pixel, from −½ to ½. Where light is analytic for all complex |x|, |y| ≤ R and
//! differs there from some number by M at most, |a_jk| ≤ M R^−(j+k) bounds the coefficients of its power series
//! (Cauchy's estimates: L. Hörmander, An Introduction to Complex Analysis in Several Variables, 1990, theorem
//! 2.2.7). A rule is off by Σ a_jk e_jk where e_jk is its error for x^j y^k: 0 for odd j or k, and below the degree
//! 2, 4 or 6. With p = (2R)⁻² all terms of degree 2m are M p^m Σ 2^2m |e_jk| or less; [`Remainder`] has these
//! sums, and the test `rules_miss_no_more_of_monomials` computes them.
//!
//! [`Domain`] finds R, and bounds the change of cosines; of that of n·l itself, only what is no polynomial of
//! degree 3 counts. A power c^e of a cosine changes by
//! (c₀ + Δ)^e − c₀^e or less for whole e, by the binomial theorem, and is at most (c₀ + Δ)^e elsewhere, where it
//! is analytic for |c − c₀| < c₀. Smaller domains have smaller changes: for high powers a part is taken.
//!
//! What is proved rests on [`classify`](crate::exact::classify::row), which finds no other sphere in the
//! pixel, and on [`Reached`](super::reached::Reached): the surface faces the lights that count in all of the
//! pixel, with neither terminator nor shadow in it, and others do not reach it. That the sphere fills the pixel
//! follows once more: Q is not 0 in the domain, which contains the pixel.

use fearless_simd::Simd;

use super::domain::{Change, Domain};
use super::filled::Filled;
use crate::exact::context::NEGLIGIBLE;
use crate::light::reflection::Falloff;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// A rule whose remainder is bounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Remainder {
    /// Half the lowest degree of which it misses something.
    order: i32,
    /// The sum of the terms of this degree, and a bound of those of each higher one.
    first: f64,
    more: f64,
}

pub(super) const MIDDLE: Remainder = Remainder {
    order: 1,
    first: 2.0 / 3.0,
    more: 0.512,
};

pub(super) const STAR: Remainder = Remainder {
    order: 2,
    first: 4.0 / 45.0,
    more: 0.165,
};

pub(super) const GRID: Remainder = Remainder {
    order: 3,
    first: 0.0458,
    more: 0.18,
};

/// The largest p: a pixel lies well within its domain, and 1 / (1 − p) is at most 2.
pub(super) const MOST: f64 = 0.5;

impl Remainder {
    /// Its error, over M, by p: the first term, and a geometric series of others.
    #[inline(always)]
    pub(super) fn of<S: Simd>(&self, p: f64x8<S>) -> f64x8<S> {
        let mut power = p;
        for _ in 1..self.order {
            power *= p;
        }
        power * (p * (2.0 * self.more) + self.first)
    }

    /// Δ over c₀ in the part of a domain in which (c₀ + Δ)^e over the power of R of the lowest degree is least.
    #[inline(always)]
    fn best_part(&self, exponent: f64) -> f64 {
        let degree = f64::from(2 * self.order);
        if exponent > degree {
            degree / (exponent - degree)
        } else {
            f64::INFINITY
        }
    }
}

/// The rules that eight pixels are averaged by.
#[derive(Clone, Copy, Debug)]
pub(super) enum Rules<S: Simd> {
    /// One sample in the middle.
    Middle,
    /// Five samples in these pixels, and nine in the others.
    StarOrGrid(mask64x8<S>),
}

impl<S: Simd> Rules<S> {
    /// Their error, over M, by p.
    #[inline(always)]
    fn remainder(&self, p: f64x8<S>) -> f64x8<S> {
        match self {
            Self::Middle => MIDDLE.of(p),
            Self::StarOrGrid(is_star) => is_star.select(STAR.of(p), GRID.of(p)),
        }
    }

    /// As [`Remainder::best_part`] has it.
    #[inline(always)]
    fn best_part(&self, exponent: f64, one: f64x8<S>) -> f64x8<S> {
        match self {
            Self::Middle => one * MIDDLE.best_part(exponent),
            Self::StarOrGrid(is_star) => is_star.select(
                one * STAR.best_part(exponent),
                one * GRID.best_part(exponent),
            ),
        }
    }

    /// The exponent up to which the whole domain is best.
    #[inline(always)]
    fn least_degree(&self) -> f64 {
        let least = match self {
            Self::Middle => MIDDLE,
            Self::StarOrGrid(_) => STAR,
        };
        f64::from(2 * least.order)
    }
}

impl<'a, S: Simd> Filled<'a, S> {
    /// The domains in which [`Self::bound`] knows the light.
    #[inline(always)]
    pub(super) fn domain(&self, simd: S) -> Domain<'a, S> {
        let [width, height] = self.size;
        Domain::new(simd, self.ball, &self.middle, width.max(height))
    }

    /// Bounds of the errors of the averages by these rules; infinite where nothing is proved.
    ///
    /// # Accuracy
    /// A bound, with rounding. `tests::nothing_is_farther_from_its_average_than_is_proved` holds it against 256-bit
    /// arithmetic.
    #[inline(always)]
    pub(super) fn bound(&self, simd: S, domain: &Domain<'_, S>, rules: Rules<S>) -> f64x8<S> {
        /// More than powers, products and sums of light make wrong, relatively.
        const ROUNDING: f64 = 1024.0 * UNIT_ROUNDOFF;
        /// More than the rounding of domains makes wrong in M.
        const SLACK: f64 = 1.001;
        let zero = f64x8::splat(simd, 0.0);
        let unknown = zero + f64::INFINITY;
        if self.finish.is_rough() {
            return unknown;
        }
        let reflectance = &self.finish.reflectance;
        let pixels = Pixels::new(domain.share, rules);
        let eye = domain.toward_eye();
        let ambient = (reflectance.albedo * self.scene.ambient).max_element();
        let mut sum = zero + ambient * ROUNDING;
        for (index, light) in self.scene.lights.iter().enumerate() {
            if self.lit[index] == 0 {
                continue;
            }
            let [diffuse, specular] = reflectance.brightest(light.intensity);
            let cosine = domain.cosine(light.toward);
            let missed = if reflectance.diffuse.exponent == 1.0 {
                let change = match rules {
                    // It is not exact for polynomials of degree 3.
                    Rules::Middle => cosine.change,
                    Rules::StarOrGrid(_) => domain.bend(light.toward, &eye).min(cosine.change),
                };
                change * pixels.remainder + cosine.rounding * 2.0
            } else {
                pixels.missed(&reflectance.diffuse, &cosine)
            };
            let mut error = (missed + ROUNDING) * diffuse;
            if let Some((_, falloff)) = &reflectance.highlight
                && specular > 0.0
            {
                let half_cosine = domain.half_cosine(light.toward, &cosine, &eye);
                let height = pixels.height(falloff, &half_cosine);
                let is_low = height.simd_lt(NEGLIGIBLE * self.tolerance / specular);
                let mut missed = height;
                if !is_low.to_bitmask() & self.lit[index] != 0 {
                    let found = pixels.missed(falloff, &half_cosine);
                    missed = is_low.select(height, found.min(height));
                }
                error += (missed + ROUNDING) * specular;
            }
            let lit = mask64x8::from_bitmask(simd, self.lit[index]);
            sum += lit.select(error, zero);
        }
        let is_known = domain.is_known & pixels.p.simd_le(MOST);
        is_known.select(sum * SLACK, unknown)
    }
}

/// Pixels in their domains, and the rules that they are averaged by.
struct Pixels<S: Simd> {
    /// Half of the longer side over h.
    share: f64x8<S>,
    /// The square of that, and what the rules miss, over M.
    p: f64x8<S>,
    remainder: f64x8<S>,
    rules: Rules<S>,
}

impl<S: Simd> Pixels<S> {
    #[inline(always)]
    fn new(share: f64x8<S>, rules: Rules<S>) -> Self {
        let p = share * share;
        Self {
            share,
            p,
            remainder: rules.remainder(p),
            rules,
        }
    }

    /// A bound of what rules miss of the power of a cosine, and of its rounding.
    #[inline(always)]
    fn missed(&self, falloff: &Falloff, cosine: &Change<S>) -> f64x8<S> {
        /// The highest power of which it matters that c₀^e is not counted.
        const HIGHEST: f64 = 8.0;
        let exponent = falloff.exponent;
        let rounding = cosine.rounding * 2.0;
        let is_whole = exponent.fract() == 0.0;
        let value = cosine.value;
        let zero = value * 0.0;
        let (change, remainder, is_inside) = self.best_part(exponent, cosine);
        let mut difference = falloff.of_clamped(value + change + cosine.rounding);
        if is_whole && exponent <= HIGHEST {
            difference -= falloff.of_clamped(value);
        }
        let slope = if exponent < 1.0 {
            2.0 / value
        } else {
            zero + exponent
        };
        let missed = difference * remainder + slope * rounding;
        let is_known = is_inside & value.simd_gt(0.0);
        is_known.select(missed, zero + f64::INFINITY)
    }

    /// The change in the part of a domain in which (c₀ + Δ)^e over the powers of R is least, what the rules miss
    /// there, over M, and where the pixel is well within that part.
    #[inline(always)]
    fn best_part(&self, exponent: f64, cosine: &Change<S>) -> (f64x8<S>, f64x8<S>, mask64x8<S>) {
        let change = cosine.change;
        let one = change * 0.0 + 1.0;
        let is_whole = exponent.fract() == 0.0;
        if cosine.limit.is_none() && is_whole && exponent <= self.rules.least_degree() {
            return (change, self.remainder, one.simd_gt(0.0));
        }
        let mut part = one;
        if let Some(limit) = cosine.limit {
            part = part.min(0.5 / limit);
        }
        let mut most = self.rules.best_part(exponent, one);
        if !is_whole {
            most = most.min(one * 0.5);
        }
        part = part.min(cosine.value * most / change);
        let ratio = self.share / part;
        let p = ratio * ratio;
        (change * part, self.rules.remainder(p), p.simd_le(MOST))
    }

    /// A bound of the power of a cosine all over the pixels: neither averages nor rules are higher.
    #[inline(always)]
    fn height(&self, falloff: &Falloff, cosine: &Change<S>) -> f64x8<S> {
        let zero = cosine.value * 0.0;
        let highest = cosine.value + cosine.change * self.share + cosine.rounding * 2.0;
        let height = falloff.of_clamped(highest.max(zero));
        match cosine.limit {
            None => height,
            Some(limit) => {
                let is_inside = (limit * self.share).simd_le(0.5);
                is_inside.select(height, zero + f64::INFINITY)
            }
        }
    }
}

#[cfg(test)]
mod tests;
