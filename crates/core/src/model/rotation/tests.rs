//! Tests of `rotation.rs`.

use super::*;
use crate::model::camera::Camera;
use crate::numeric::angle::Angle;

/// Rotations by many angles about all axes.
fn rotations() -> impl Iterator<Item = DMat3> {
    (0..500).map(|index| {
        // Steps that no turn is a multiple of.
        let angle = |step: f64| Angle::from_degrees(step * f64::from(index));
        Camera::free(DVec3::ZERO, angle(37.7), angle(-71.3), angle(111.1)).world_from_camera
    })
}

fn rounded(matrix: DMat3, decimals: i32) -> DMat3 {
    let unit = 10.0_f64.powi(decimals);
    DMat3::from_cols_array(
        &matrix
            .to_cols_array()
            .map(|entry| (entry * unit).round() / unit),
    )
}

#[test]
fn rotations_come_back_to_the_bit() {
    for rotation in rotations() {
        assert_eq!(nearest_rotation(rotation), Ok(rotation));
    }
}

#[test]
fn rounded_rotations_are_made_orthonormal_and_stay_close() {
    for rotation in rotations() {
        for decimals in [7, 9, 12] {
            let written = rounded(rotation, decimals);
            let nearest = nearest_rotation(written).unwrap();
            assert!(deviation(nearest) <= 1e-14, "{nearest}");
            assert!((nearest.determinant() - 1.0).abs() < 1e-14);
            // Nearest: no farther from what was written than the rotation that was meant.
            let distance = |other: DMat3| {
                let difference = (other - written).to_cols_array();
                difference
                    .iter()
                    .map(|entry| entry * entry)
                    .sum::<f64>()
                    .sqrt()
            };
            assert!(distance(nearest) <= distance(rotation) + 1e-15, "{nearest}");
        }
    }
}

#[test]
fn what_is_no_rotation_is_refused() {
    let skewed = |matrix: DMat3| match nearest_rotation(matrix) {
        Err(RotationError::Skewed(deviation)) => deviation,
        other => panic!("{other:?}"),
    };
    let scaled = skewed(DMat3::IDENTITY * 1.01);
    assert!((scaled - 0.0201).abs() < 1e-15, "{scaled}");
    assert_eq!(skewed(DMat3::ZERO), 1.0);
    assert_eq!(skewed(DMat3::from_cols_array(&[1e200; 9])), f64::INFINITY);
    let opposed = [1e200, 1e200, 0.0, 1e200, -1e200, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(skewed(DMat3::from_cols_array(&opposed)), f64::INFINITY);
    assert_eq!(skewed(DMat3::NAN), f64::INFINITY);
    // Twice the error of an entry on the diagonal.
    let off_by = |error: f64| DMat3::from_diagonal(DVec3::new(1.0 + 0.5 * error, 1.0, 1.0));
    assert!(nearest_rotation(off_by(0.99e-6)).is_ok());
    assert!(skewed(off_by(1.01e-6)) > 1e-6);
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    assert_eq!(nearest_rotation(mirror), Err(RotationError::Mirrors(-1.0)));
}
