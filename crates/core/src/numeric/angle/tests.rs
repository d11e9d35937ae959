//! Tests of `angle.rs`.

use super::*;

#[test]
fn quarter_turns_are_exact() {
    for turns in -3..=3 {
        let at = |quarter: i32| Angle::from_degrees(f64::from(360 * turns + 90 * quarter));
        assert_eq!(at(0), Angle::new(0.0, 1.0));
        assert_eq!(at(1), Angle::new(1.0, 0.0));
        assert_eq!(at(2), Angle::new(0.0, -1.0));
        assert_eq!(at(3), Angle::new(-1.0, 0.0));
    }
}

#[test]
fn degrees_come_back() {
    for tenths in -1799..=1799 {
        let degrees = f64::from(tenths) / 10.0;
        assert!((Angle::from_degrees(degrees).degrees() - degrees).abs() < 1e-13);
    }
}

#[test]
fn sides_of_any_size_make_an_angle() {
    for scale in [1e-300, 1.0, 1e300] {
        let angle = Angle::from_sides(3.0 * scale, 4.0 * scale);
        assert!((angle.sin - 0.6).abs() < 1e-15 && (angle.cos - 0.8).abs() < 1e-15);
    }
    assert_eq!(Angle::from_sides(0.0, 0.0), Angle::ZERO);
    assert_eq!(Angle::from_sides(-7.0, 0.0), Angle::new(-1.0, 0.0));
}

/// Sine and cosine to 32 digits, computed with 60.
#[test]
fn degrees_are_known_to_twice_the_precision() {
    for (degrees, sin, cos) in [
        (
            30.0,
            (0.5, 0.0),
            (0.8660254037844386, 5.0175421109034514e-17),
        ),
        (
            -44.9,
            (-0.705871570678681, 3.050714293522418e-17),
            (0.7083398377245289, -4.0407564503538365e-17),
        ),
        (
            0.1,
            (0.001745328365898309, -9.829358964865576e-20),
            (0.9999984769132877, 6.078279724601492e-18),
        ),
        (
            77.7,
            (0.9770455744352636, 4.1113141553554524e-18),
            (0.21303038627497653, -1.5389135341633287e-18),
        ),
        (
            123.456,
            (0.8343094333148066, 7.975725155281954e-19),
            (-0.5512964442855824, -3.573148907403577e-17),
        ),
        (
            200.0,
            (-0.3420201433256687, -2.0136016534644645e-17),
            (-0.9396926207859084, 4.3850932840020416e-17),
        ),
        (
            333.25,
            (-0.450098441037435, 1.149341367215048e-17),
            (0.892978943411137, -2.221887114547766e-17),
        ),
    ] {
        let [precise_sin, precise_cos] = Angle::from_degrees(degrees).precise();
        for (found, (high, low)) in [(precise_sin, sin), (precise_cos, cos)] {
            let off = (found.high - high) + (found.low - low);
            assert!(off.abs() < 1e-31, "{degrees}: off by {off:e}");
        }
    }
}
