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

/// Each operation on eight, and the same one on doubles.
macro_rules! assert_same_operations {
    ($level:expr, $a:expr, $b:expr; $($eight:expr => $one:expr;)*) => {
        $(
            let found: [f64; 8] = dispatch!($level, simd => {
                let (a, b) = (f64x8::from_array(simd, $a), f64x8::from_array(simd, $b));
                let function: fn(f64x8<_>, f64x8<_>) -> f64x8<_> = $eight;
                function(a, b).into()
            });
            for lane in 0..LANES {
                let function: fn(f64, f64) -> f64 = $one;
                let expected = function($a[lane], $b[lane]);
                let is_same = found[lane].to_bits() == expected.to_bits()
                    || found[lane].is_nan() && expected.is_nan();
                let name = stringify!($eight);
                assert!(is_same, "{name} of {:e}, {:e} at {:?}", $a[lane], $b[lane], $level);
            }
        )*
    };
}

#[test]
fn operations_are_those_of_doubles() {
    let numbers = numbers();
    for level in levels() {
        for (a, b) in numbers.chunks_exact(8).zip(numbers[3..].chunks_exact(8)) {
            let (a, b): ([f64; 8], [f64; 8]) = (a.try_into().unwrap(), b.try_into().unwrap());
            assert_same_operations!(level, a, b;
                |a, b| a + b => |a, b| a + b;
                |a, b| a - b => |a, b| a - b;
                |a, b| a * b => |a, b| a * b;
                |a, b| a / b => |a, b| a / b;
                |a, _| a + 0.3 => |a, _| a + 0.3;
                |a, _| a / 0.3 => |a, _| a / 0.3;
                |a, _| 0.3 - a => |a, _| 0.3 - a;
                |a, _| 0.3 / a => |a, _| 0.3 / a;
                |a, _| -a => |a, _| -a;
                |a, _| a.abs() => |a, _| a.abs();
                |a, _| a.floor() => |a, _| a.floor();
                |a, _| a.ceil() => |a, _| a.ceil();
                |a, b| a.mul_add_precise(b, a) => |a, b| a.mul_add(b, a);
                |a, b| a.max(b + 0.1) => |a, b| a.max(b + 0.1);
                |a, b| a.min(b + 0.1) => |a, b| a.min(b + 0.1);
                |a, b| a.simd_lt(b).select(a, b) => |a, b| if a < b { a } else { b };
                |a, b| a.simd_ge(b).select(a, b) => |a, b| if a >= b { a } else { b };
                |a, b| (a.simd_gt(b) | a.simd_eq(b)).select(a, b) => |a, b| if a >= b { a } else { b };
                |a, b| (a.simd_le(b) & a.simd_ne(b)).select(a, b) => |a, b| if a < b { a } else { b };
                |a, b| (!(a.simd_gt(b) ^ a.simd_gt(0.0))).select(a, b)
                    => |a, b| if (a > b) == (a > 0.0) { a } else { b };
            );
        }
    }
}

#[test]
fn masks_are_their_bits_and_lanes_slide() {
    for level in levels() {
        for bits in 0..256 {
            let (found, any, all) = dispatch!(level, simd => {
                let mask = mask64x8::from_bitmask(simd, bits);
                (mask.to_bitmask(), mask.any_true(), mask.all_true())
            });
            assert_eq!((found, any, all), (bits, bits != 0, bits == 255));
        }
        let slid: [f64; 8] = dispatch!(level, simd => {
            let lanes = f64x8::from_array(simd, LANE_NUMBERS);
            lanes.slide::<3>(lanes + 10.0).into()
        });
        assert_eq!(slid, [3.0, 4.0, 5.0, 6.0, 7.0, 10.0, 11.0, 12.0]);
    }
}
