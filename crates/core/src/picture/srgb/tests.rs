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

/// The error that thresholds may have, in units of the last place.
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

/// Returns whether `linear` is not below the middle of the codes `code − 1` and `code`, exactly.
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
