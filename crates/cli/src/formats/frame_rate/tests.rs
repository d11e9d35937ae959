//! Tests of `frame_rate.rs`.

use super::*;

#[test]
fn whole_and_simple_rates_are_exact() {
    assert_eq!(nearest(24.0), Some((24, 1)));
    assert_eq!(nearest(12.5), Some((25, 2)));
    assert_eq!(nearest(0.1), Some((1, 10)));
    assert_eq!(nearest(1.0 / 3.0), Some((1, 3)));
    assert_eq!(nearest(1000.0), Some((1000, 1)));
    assert_eq!(nearest(15.36), Some((384, 25)));
}

#[test]
fn television_rates_are_recognized() {
    for rate in [23.976, 23.98, 24000.0 / 1001.0] {
        assert_eq!(nearest(rate), Some((24000, 1001)));
    }
    assert_eq!(nearest(29.97), Some((30000, 1001)));
    assert_eq!(nearest(59.94), Some((60000, 1001)));
    assert_eq!(nearest(119.88), Some((120_000, 1001)));
}

#[test]
fn rates_out_of_range_have_none() {
    for rate in [0.0, -24.0, 1e-9, 1e10, f64::MAX, f64::INFINITY, f64::NAN] {
        assert_eq!(nearest(rate), None, "{rate}");
    }
}

#[test]
fn odd_rates_are_close() {
    for rate in [std::f64::consts::PI, 1_234.567_891, 0.017_453] {
        let (numerator, denominator) = nearest(rate).unwrap();
        let fraction = f64::from(numerator) / f64::from(denominator);
        assert!((fraction / rate - 1.0).abs() < 1e-9, "{rate}");
    }
}
