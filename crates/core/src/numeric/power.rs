//! Powers of numbers from 0 to 1 and a little more: the falloff of diffuse light and highlights.
//!
//! The exponent is prepared once for each material; bases come one at a time or eight at a time,
//! with the same bits.

use fearless_simd::Simd;

use super::lanes::{Lanes, f64x8, polynomial};

/// A function base ↦ base^exponent, for bases from 0 to about 1 and one exponent.
///
/// # Accuracy
/// Whole exponents n up to [`LONGEST_CHAIN`], and such with a half, make products in which n
/// roundings meet: the relative error is below 1.2e-16 n + 2e-16, 6.2e-14 at most. For other
/// exponents it is below 5e-15, and the absolute error below 1e-15 for bases up to 1.
/// `tests::powers_are_accurate` measures all three. Powers below 2⁻¹⁰²⁰ may be 0, which keeps the
/// slow arithmetic of subnormal numbers away, and powers above 2¹⁰²⁰ infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Power {
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Products of the base and, for an exponent with a half, its root.
    Chain { whole: u32, has_half: bool },
    /// Two to the power of exponent · log₂(base).
    Logarithm(Exponent),
}

/// An exponent, whole and in two parts whose first one has 26 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Exponent {
    sum: f64,
    high: f64,
    low: f64,
}

/// The largest exponent of which multiplications are made: 9 squarings at most, which cost less
/// than a logarithm, and errors that stay below 1e-13.
const LONGEST_CHAIN: f64 = 512.0;

impl Power {
    /// Prepares an exponent greater than 0; costs a few comparisons.
    #[inline]
    pub(crate) fn new(exponent: f64) -> Self {
        let kind = if exponent <= LONGEST_CHAIN && (2.0 * exponent).fract() == 0.0 {
            Kind::Chain {
                whole: exponent as u32,
                has_half: exponent.fract() != 0.0,
            }
        } else {
            let high = exponent.upper_half();
            Kind::Logarithm(Exponent {
                sum: exponent,
                high,
                low: exponent - high,
            })
        };
        Self { kind }
    }

    /// The power of each lane, with the bits that one number's has; 0 for numbers below 0.
    #[inline(always)]
    pub(crate) fn lanes<S: Simd>(&self, base: f64x8<S>) -> f64x8<S> {
        match &self.kind {
            Kind::Chain {
                whole: 1,
                has_half: false,
            } => base.select_below(0.0, base.like(0.0), base),
            &Kind::Chain { whole, has_half } => lanes_by_chain(base, whole, has_half),
            Kind::Logarithm(exponent) => lanes_by_logarithm(base, exponent),
        }
    }

    /// The power of one number; 0 for numbers below 0.
    #[cfg(test)]
    pub(crate) fn scalar(&self, base: f64) -> f64 {
        match &self.kind {
            &Kind::Chain { whole, has_half } => chain(base, whole, has_half),
            Kind::Logarithm(exponent) => by_logarithm(base, exponent),
        }
    }
}

/// The power with the exponent `whole`, or half more, from squares of squares.
#[inline(always)]
fn chain<L: Lanes>(base: L, whole: u32, has_half: bool) -> L {
    let base = base.select_below(0.0, base.like(0.0), base);
    let mut square = base;
    let mut rest = whole;
    // The last bit of the exponent, and the half behind it, without a product by 1.
    let mut product = match (has_half, rest & 1 == 1) {
        (true, true) => base.sqrt() * base,
        (true, false) => base.sqrt(),
        (false, true) => base,
        (false, false) => base.like(1.0),
    };
    let mut is_one = !has_half && rest & 1 == 0;
    rest >>= 1;
    while rest > 0 {
        square = square * square;
        if rest & 1 == 1 {
            product = if is_one { square } else { product * square };
            is_one = false;
        }
        rest >>= 1;
    }
    product
}

/// Coefficients of (2/ln 2 · artanh(s)/s − 2/ln 2) / s² in s², for |s| ≤ (√2 − 1)/(√2 + 1).
///
/// The polynomial of least largest error, by Remez's algorithm with 300 bits; the error is
/// 8.2e-21 of the logarithm, and less than what rounding the coefficients adds.
const LOGARITHM: [f64; 8] = [
    0.961_796_693_925_975_6,
    0.577_078_016_355_675_5,
    0.412_198_583_077_355_8,
    0.320_598_904_097_39,
    0.262_307_576_135_684_06,
    0.221_988_783_620_970_5,
    0.191_159_063_307_022_15,
    0.191_173_824_606_627_57,
];

/// Coefficients of (2ʳ − 1)/r for |r| ≤ 0.5001.
///
/// The polynomial of least largest error of 2ʳ, relative, by Remez's algorithm with 300 bits; the
/// error is 2.2e-16.
const EXPONENTIAL: [f64; 10] = [
    0.693_147_180_559_949_2,
    0.240_226_506_959_091,
    0.055_504_108_664_481_28,
    0.009_618_129_107_983_686,
    0.001_333_355_822_589_522_6,
    0.000_154_035_299_937_906_36,
    1.525_265_936_825_402_3e-5,
    1.321_565_371_520_933_6e-6,
    1.020_833_509_619_133_8e-7,
    7.038_175_366_696_291e-9,
];

/// The power as 2^(exponent · log₂(base)), with a logarithm and a product of about 58 bits.
///
/// The logarithm needs the bits beyond a double's because a power of 10⁻³⁰⁰ has an exponent near
/// −1000 whose error stands before the result undivided.
///
/// # Source
/// The plan of `e_pow.c` in the FreeBSD mathematical library (Sun Microsystems, 1993), which
/// splits quotient and products in the same way; the reduction of the base to one interval and the
/// polynomials are different.
#[inline(always)]
fn by_logarithm<L: Lanes>(base: L, exponent: &Exponent) -> L {
    /// A factor that makes every subnormal number normal.
    const LIFT_EXPONENT: f64 = 54.0;
    const LIFT: f64 = (1_u64 << 54) as f64;
    /// Beyond this a power counts as 0, or as infinite.
    const LARGEST_EXPONENT: f64 = 1020.0;

    let lifted = base.select_below(f64::MIN_POSITIVE, base * LIFT, base);
    let (mantissa, whole) = lifted.mantissa_and_exponent();
    let whole = base.select_below(f64::MIN_POSITIVE, whole - LIFT_EXPONENT, whole);
    let (log_high, log_low) = add_logarithm(whole, mantissa);

    // The first product is exact, so that the whole number next to it leaves an exact fraction.
    let high = log_high * exponent.high;
    let low = log_high * exponent.low + log_low * exponent.sum;
    let whole = high.nearest_whole();
    let fraction = (high - whole) + low;
    let power = (fraction * polynomial(fraction, &EXPONENTIAL) + 1.0) * whole.power_of_two();

    let power = high.select_below(LARGEST_EXPONENT, power, power.like(f64::INFINITY));
    let power = high.select_below(-LARGEST_EXPONENT, power.like(0.0), power);
    const LEAST: f64 = f64::from_bits(1);
    base.select_below(LEAST, power.like(0.0), power)
}

/// [`chain`] of each lane, once for each level.
#[inline(never)]
fn lanes_by_chain<S: Simd>(base: f64x8<S>, whole: u32, has_half: bool) -> f64x8<S> {
    base.simd().vectorize(
        #[inline(always)]
        || chain(base, whole, has_half),
    )
}

/// [`by_logarithm`] of each lane, once for each level: it is long, and wanted at many places.
#[inline(never)]
fn lanes_by_logarithm<S: Simd>(base: f64x8<S>, exponent: &Exponent) -> f64x8<S> {
    base.simd().vectorize(
        #[inline(always)]
        || by_logarithm(base, exponent),
    )
}

/// `whole` + log₂(mantissa) as a number of 26 bits and the rest.
///
/// With s = (m − 1)/(m + 1), log₂ m = 2/ln 2 · artanh(s), and the first term of its series is 99 %
/// of it: that one is computed with s in two parts and 2/ln 2 in two parts, the others plainly.
#[inline(always)]
fn add_logarithm<L: Lanes>(whole: L, mantissa: L) -> (L, L) {
    /// 2/ln 2: rounded, its first 26 bits, and what they leave.
    const FACTOR: f64 = 2.0 * std::f64::consts::LOG2_E;
    const FACTOR_HIGH: f64 = f64::from_bits(FACTOR.to_bits() & !((1 << 27) - 1));
    const FACTOR_LOW: f64 = FACTOR - FACTOR_HIGH + 4.071_054_748_186_206_6e-17;

    let numerator = mantissa - 1.0;
    let denominator = mantissa + 1.0;
    let reciprocal = denominator.reciprocal();
    let quotient = numerator * reciprocal;
    let quotient_high = quotient.upper_half();
    let denominator_high = denominator.upper_half();
    // From the mantissa, as the sum above was rounded.
    let denominator_low = mantissa - (denominator_high - 1.0);
    let remainder =
        (numerator - quotient_high * denominator_high) - quotient_high * denominator_low;
    let quotient_low = remainder * reciprocal;

    let square = quotient * quotient;
    let first = quotient_high * FACTOR_HIGH;
    let rest = (quotient_high * FACTOR_LOW + quotient_low * FACTOR)
        + quotient * square * polynomial(square, &LOGARITHM);
    let high = (whole + (first + rest)).upper_half();
    let low = ((whole - high) + first) + rest;
    (high, low)
}

#[cfg(test)]
mod tests;
