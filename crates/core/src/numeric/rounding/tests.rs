//! Tests of `rounding.rs`.

use super::*;

#[test]
fn errors_are_what_rounding_lost() {
    assert_eq!(two_sum(1.0, 1e-30), (1.0, 1e-30));
    assert_eq!(two_difference(1e-30, 1.0), (-1.0, 1e-30));
    assert_eq!(fast_two_sum(1.0, 1e-30), (1.0, 1e-30));
    let third = 1.0 + f64::EPSILON;
    // (1 + ε)² = 1 + 2ε + ε².
    let expected = (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON);
    assert_eq!(two_product::<true, f64>(third, third), expected);
}

#[test]
fn split_products_equal_fused_ones() {
    let mut bits = 1_u64;
    let mut next = || {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        // Any sign and mantissa, exponents from −400 to 400.
        let exponent = 1023 - 400 + (bits >> 33) % 801;
        f64::from_bits(bits & 0x800f_ffff_ffff_ffff | exponent << 52)
    };
    for _ in 0..100_000 {
        let (a, b) = (next(), next());
        assert_eq!(
            two_product::<false, f64>(a, b),
            two_product::<true, f64>(a, b),
            "{a:e} · {b:e}"
        );
    }
}
