//! The sRGB transfer curve: codes rounded to the nearest, and back.
//!
//! Source: IEC 61966-2-1. NaN and negative light are black, light above 1 is white.

use std::sync::LazyLock;

/// Mantissa bits, beside the exponent, by which the table of [`Encoder`] is indexed.
///
/// With 7 of them a cell is never wider than the way between two thresholds.
const INDEX_BITS: u32 = 7;
const CELL_SHIFT: u32 = f64::MANTISSA_DIGITS - 1 - INDEX_BITS;

/// The 8 bit code nearest to the sRGB value of linear light.
///
/// # Accuracy
/// The nearest code, except that light within 3 units in the last place of the middle between two
/// codes may go either way; `every_threshold_is_exact_to_a_few_units` settles that in whole
/// numbers.
pub(crate) fn encode_8(linear: f64) -> u8 {
    encoder_8().encode(linear)
}

/// As [`encode_8`], for many numbers.
pub(crate) fn encode_all_8(linear: &[f64], codes: &mut [u8]) {
    let encoder = encoder_8();
    for (code, &linear) in codes.iter_mut().zip(linear) {
        *code = encoder.encode(linear);
    }
}

fn encoder_8() -> &'static Encoder {
    static ENCODER: LazyLock<Encoder> = LazyLock::new(Encoder::new);
    &ENCODER
}

/// The 16 bit code nearest to the sRGB value of linear light.
pub(crate) fn encode_16(linear: f64) -> u16 {
    // The cast saturates, and takes NaN to 0.
    (encode(linear) * f64::from(u16::MAX) + 0.5) as u16
}

/// The sRGB value of linear light, from 0 to 1 both.
fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}

/// The linear light of an sRGB value; the curve goes on above 1.
pub(crate) fn decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// The linear light in the middle between an 8 bit code and the one before.
///
/// The fractions are those of the curve, in whole numbers: every one costs a single rounding.
fn threshold(code: u8) -> f64 {
    // 0.04045, where the straight part ends, lies between codes 10 and 11.
    const LAST_STRAIGHT: u8 = 10;
    let middle = 2.0 * f64::from(code) - 1.0; // over 510
    if code <= LAST_STRAIGHT {
        10.0 * middle / 65892.0 // middle / 510 / 12.92
    } else {
        libm::pow((20.0 * middle + 561.0) / 10761.0, 2.4) // (middle / 510 + 0.055) / 1.055
    }
}

/// From linear light to 8 bit codes with one look into a table and one comparison.
struct Encoder {
    /// The least linear light of every code; code 0 needs none, and nothing reaches code 256.
    thresholds: [f64; 257],
    /// Where the cell of `thresholds[1]` begins.
    least: f64,
    /// The code of the least light in every cell of equal exponent and leading mantissa bits,
    /// from the cell of `thresholds[1]` to that of 1.
    codes: Vec<u8>,
}

impl Encoder {
    fn new() -> Self {
        let mut thresholds = [f64::INFINITY; 257];
        thresholds[0] = f64::NEG_INFINITY;
        for code in 1..=u8::MAX {
            thresholds[usize::from(code)] = threshold(code);
        }
        let first_cell = cell(thresholds[1]);
        let codes = (first_cell..=cell(1.0))
            .map(|cell| {
                let least = f64::from_bits(cell << CELL_SHIFT);
                (thresholds.partition_point(|&threshold| threshold <= least) - 1) as u8
            })
            .collect();
        Self {
            thresholds,
            least: f64::from_bits(first_cell << CELL_SHIFT),
            codes,
        }
    }

    #[inline]
    fn encode(&self, linear: f64) -> u8 {
        // Which takes NaN to the least.
        let linear = linear.max(self.least).min(1.0);
        let code = self.codes[(cell(linear) - cell(self.least)) as usize];
        code + u8::from(linear >= self.thresholds[usize::from(code) + 1])
    }
}

/// The number of a positive value's cell; cells are numbered in the order of their values.
fn cell(value: f64) -> u64 {
    value.to_bits() >> CELL_SHIFT
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direct(linear: f64) -> u8 {
        (encode(linear) * 255.0 + 0.5) as u8
    }

    #[test]
    fn codes_come_back() {
        for code in 0..=u8::MAX {
            assert_eq!(encode_8(decode(f64::from(code) / 255.0)), code);
        }
        for code in 0..=u16::MAX {
            assert_eq!(encode_16(decode(f64::from(code) / 65535.0)), code);
        }
    }

    #[test]
    fn out_of_range_is_black_or_white() {
        for black in [
            f64::NAN,
            f64::NEG_INFINITY,
            -1.0,
            -0.0,
            0.0,
            f64::MIN_POSITIVE,
        ] {
            assert_eq!((encode_8(black), encode_16(black)), (0, 0));
        }
        for white in [1.0, 1.0 + f64::EPSILON, 2.0, f64::MAX, f64::INFINITY] {
            assert_eq!((encode_8(white), encode_16(white)), (255, 65535));
        }
        assert_eq!(encode_8(1.0_f64.next_down()), 255);
    }

    #[test]
    fn a_cell_holds_at_most_one_threshold() {
        let encoder = Encoder::new();
        for pair in encoder.thresholds[1..256].windows(2) {
            assert!(cell(pair[0]) < cell(pair[1]));
        }
    }

    #[test]
    fn the_table_agrees_with_the_formula() {
        // Equally spaced bit patterns visit all magnitudes.
        let mut bits = 1e-5_f64.to_bits();
        while f64::from_bits(bits) < 1.01 {
            let linear = f64::from_bits(bits);
            assert_eq!(encode_8(linear), direct(linear), "{linear:e}");
            bits += 0x0000_003f_1234_5678;
        }
        for &threshold in &Encoder::new().thresholds[1..256] {
            // The formula itself is rounded, by a few units in the last place.
            for factor in [1.0 - 1e-14, 1.0 + 1e-14] {
                let linear = threshold * factor;
                assert_eq!(encode_8(linear), direct(linear), "{linear:e}");
            }
        }
    }

    /// In the last place, how far thresholds may be off.
    const UNITS: u32 = 3;

    /// With x = p / q the middle between two codes after the offset and the factor of the curve,
    /// light v is at or above it when v⁵ ≥ x¹², and 12.92 v ≥ the middle on the straight part:
    /// questions about whole numbers.
    #[test]
    fn every_threshold_is_exact_to_a_few_units() {
        let encoder = Encoder::new();
        for code in 1..=255_u32 {
            let threshold = encoder.thresholds[code as usize];
            let (mut above, mut below) = (threshold, threshold);
            for _ in 0..UNITS {
                (above, below) = (above.next_up(), below.next_down());
            }
            assert!(is_at_or_above(above, code), "code {code}");
            assert!(!is_at_or_above(below, code), "code {code}");
            assert_eq!(encode_8(threshold), code as u8);
            assert_eq!(encode_8(threshold.next_down()), code as u8 - 1);
        }
    }

    /// Whether `linear` is not below the middle of the codes `code − 1` and `code`, exactly.
    fn is_at_or_above(linear: f64, code: u32) -> bool {
        let middle = 2 * code - 1; // over 510
        let exponent = (linear.to_bits() >> 52) as u32; // positive and normal
        let mantissa = linear.to_bits() & ((1 << 52) - 1) | 1 << 52;
        let shift = 1075 - exponent; // linear = mantissa / 2^shift
        // 0.04045 · 510 = 20.6295
        let (left, right) = if middle <= 20 {
            // 12.92 · 510 · mantissa against middle · 2^shift, both times 100
            (
                Whole::one().times(mantissa).times(1292 * 510),
                Whole::one().times(u64::from(middle) * 100).doubled(shift),
            )
        } else {
            // (middle / 510 + 55/1000) / (1055/1000) = (20 · middle + 561) / 10761
            let (p, q) = (u64::from(20 * middle + 561), 10761);
            let power = |base: u64, exponent: u32| {
                (0..exponent).fold(Whole::one(), |product, _| product.times(base))
            };
            let v5 = (0..5).fold(power(q, 12), |product, _| product.times(mantissa));
            (v5, power(p, 12).doubled(5 * shift))
        };
        left >= right
    }

    /// A whole number of any size, the leading limb first, for the comparison that is derived.
    #[derive(Eq, PartialEq, PartialOrd)]
    struct Whole([u32; 32]);

    impl Whole {
        fn one() -> Self {
            let mut limbs = [0; 32];
            limbs[31] = 1;
            Self(limbs)
        }

        fn times(mut self, factor: u64) -> Self {
            let mut carry = 0_u128;
            for limb in self.0.iter_mut().rev() {
                let product = u128::from(*limb) * u128::from(factor) + carry;
                *limb = product as u32;
                carry = product >> 32;
            }
            assert_eq!(carry, 0, "too large");
            self
        }

        fn doubled(self, times: u32) -> Self {
            (0..times).fold(self, |number, _| number.times(2))
        }
    }
}
