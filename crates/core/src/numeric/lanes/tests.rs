//! Lanes hold the bits of doubles.

use fearless_simd::{Level, dispatch};

use super::*;

/// Every level that this processor has and that kernels are compiled for.
pub(crate) fn levels() -> Vec<Level> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        let best = Level::new();
        let of_x86 = [
            best.as_sse2().map(Level::Sse2),
            best.as_avx2().map(Level::Avx2),
            best.as_avx512().map(Level::Avx512),
        ];
        of_x86.into_iter().flatten().collect()
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    vec![Level::baseline(), Level::new()]
}

/// Calls `check` with each number's lane and double after a function of both.
macro_rules! assert_same_bits {
    ($numbers:expr, $function:expr) => {
        for level in levels() {
            for chunk in $numbers.chunks_exact(8) {
                let eight: [f64; 8] = chunk.try_into().unwrap();
                let lanes: [f64; 8] = dispatch!(level, simd => {
                    let function = $function;
                    function(f64x8::from_array(simd, eight)).into()
                });
                for (number, lane) in eight.into_iter().zip(lanes) {
                    let function = $function;
                    let double: f64 = function(number);
                    assert_eq!(lane.to_bits(), double.to_bits(), "{number:e} at {level:?}");
                }
            }
        }
    };
}

fn numbers() -> Vec<f64> {
    let mut numbers = vec![
        0.0,
        -0.0,
        0.5,
        1.5,
        2.5,
        -0.5,
        -1.5,
        5e-324,
        f64::MIN_POSITIVE,
        1.0,
        1.0 + f64::EPSILON,
        1.0 - f64::EPSILON / 2.0,
        2_f64.powi(50) + 0.25,
        2_f64.powi(51) - 0.5,
        2_f64.powi(52) - 0.5,
        -2_f64.powi(52) + 0.5,
        2_f64.powi(62),
        -1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.5_f64.sqrt(),
        2_f64.sqrt(),
        0.5 - f64::EPSILON / 4.0,
    ];
    let mut bits = 7_u64;
    for _ in 0..4000 {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        // Any sign and mantissa, exponents from −70 to 70.
        let exponent = 1023 - 70 + (bits >> 33) % 141;
        numbers.push(f64::from_bits(
            bits & 0x800f_ffff_ffff_ffff | exponent << 52,
        ));
    }
    numbers
}

#[test]
fn lanes_hold_the_bits_of_doubles() {
    assert_same_bits!(numbers(), |x| Lanes::nearest_whole(x));
    assert_same_bits!(numbers(), |x| Lanes::upper_half(x));
    assert_same_bits!(numbers(), |x| Lanes::reciprocal(x));
    assert_same_bits!(numbers(), |x| Lanes::mantissa_and_exponent(x).0);
    assert_same_bits!(numbers(), |x| Lanes::mantissa_and_exponent(x).1);
    assert_same_bits!(numbers(), |x| polynomial(x, &[1.0, 0.3, -0.7, 1e-3]));
    let not_negative: Vec<f64> = numbers().into_iter().map(f64::abs).collect();
    assert_same_bits!(not_negative, |x| Lanes::sqrt(x));
}

#[test]
fn nearest_whole_rounds_ties_to_even() {
    for number in numbers() {
        if number.abs() <= 2_f64.powi(51) {
            assert_eq!(number.nearest_whole(), number.round_ties_even());
        }
    }
}

#[test]
fn mantissa_and_exponent_make_the_number() {
    for number in numbers() {
        let number = number.abs();
        if (f64::MIN_POSITIVE..=f64::MAX).contains(&number) {
            let (mantissa, exponent) = number.mantissa_and_exponent();
            assert!((0.707..1.415).contains(&mantissa), "{number:e}: {mantissa}");
            assert_eq!(libm::scalbn(mantissa, exponent as i32), number);
        }
    }
}

#[test]
fn powers_of_two_are_exact() {
    for exponent in -1022..=1023 {
        assert_eq!(
            f64::from(exponent).power_of_two(),
            libm::scalbn(1.0, exponent)
        );
    }
}
