//! Tests of `angle.rs`.

use super::*;

#[test]
fn quarter_turns_are_exact() {
    for turns in -3..=3 {
        let at = |quarter: i32| Angle::from_degrees(f64::from(360 * turns + 90 * quarter));
        assert_eq!(at(0), Angle { sin: 0.0, cos: 1.0 });
        assert_eq!(at(1), Angle { sin: 1.0, cos: 0.0 });
        assert_eq!(
            at(2),
            Angle {
                sin: 0.0,
                cos: -1.0
            }
        );
        assert_eq!(
            at(3),
            Angle {
                sin: -1.0,
                cos: 0.0
            }
        );
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
    assert_eq!(
        Angle::from_sides(-7.0, 0.0),
        Angle {
            sin: -1.0,
            cos: 0.0
        }
    );
}
