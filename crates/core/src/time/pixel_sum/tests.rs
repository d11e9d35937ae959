//! Tests of `pixel_sum.rs`.

use super::*;
use crate::time::panel::MOMENTS;

const TOLERANCE: f64 = 1e-3;

/// A sum with one panel, at all moments of which a pixel claims so much.
fn sum(missed: f64, is_fine: bool, error: f64, status: Status) -> PixelSum {
    let level = 0;
    let first = FirstPanels {
        level,
        missed,
        is_fine,
    };
    let contrast = Contrast {
        ordinary: 1.5,
        most: 7.0,
        of_alpha: 1.0,
    };
    let mut sum = PixelSum::new(first, &contrast);
    let pixel = Pixel {
        value: Color::splat(0.5),
        alpha: 1.0,
        error,
        evidence: Evidence::Estimate,
        status,
    };
    let panel = Panel { level, index: 0 };
    sum.add(Part::new(panel, &[pixel; MOMENTS], 1.0));
    sum
}

#[test]
fn what_is_claimed_is_of_area_and_of_time() {
    for (missed, is_fine, expected) in [
        (2e-4, true, Status::Met),
        (2e-3, false, Status::OutOfBudget),
    ] {
        let mut sum = sum(missed, is_fine, 1e-4, Status::Met);
        sum.halve(TOLERANCE, |panel| panic!("{panel:?} is not needed"));
        let found = sum.pixel(TOLERANCE);
        assert_eq!((found.value.x, found.status), (0.5, expected));
        let claimed = 1e-4 + 1.5 * missed;
        assert!((found.error - claimed).abs() < 1e-15, "{:e}", found.error);
    }
}

/// A pixel whose work was cut off at some moment says so, and costs no more moments.
#[test]
fn what_was_cut_off_at_a_moment_is_over() {
    let mut sum = sum(0.0, true, 0.7, Status::OutOfBudget);
    sum.halve(TOLERANCE, |panel| panic!("{panel:?} would be in vain"));
    let found = sum.pixel(TOLERANCE);
    assert_eq!(found.status, Status::OutOfBudget);
    assert!(found.error >= 0.7);
}

/// If anything may pass between two moments, the claim is all that may be seen.
#[test]
fn what_is_blind_claims_all() {
    let mut sum = sum(1.0, false, 1e-4, Status::Met);
    sum.halve(TOLERANCE, |panel| panic!("{panel:?} would be in vain"));
    let found = sum.pixel(TOLERANCE);
    assert_eq!(found.status, Status::OutOfBudget);
    assert!(found.error >= 7.0);
}
