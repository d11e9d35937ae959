//! Tests of `outcome.rs`.

use super::*;

#[test]
fn a_sequence_is_as_good_as_its_worst_frame() {
    let summary = |largest_error, bounds, over_tolerance| Summary {
        pixels: 100,
        largest_error,
        bounds,
        over_tolerance,
    };
    let mut outcome = Outcome::default();
    assert!(!outcome.is_over_tolerance());
    let time = Duration::from_millis(5);
    outcome.add(summary(1e-4, 100, 0), 5, time);
    assert_eq!(outcome.total, Some(summary(1e-4, 100, 0)));
    assert!(!outcome.is_over_tolerance());
    outcome.add(summary(3e-4, 20, 2), 0, time);
    outcome.add(summary(2e-4, 100, 1), 4, time);
    let total = Summary {
        pixels: 300,
        ..summary(3e-4, 220, 3)
    };
    assert_eq!(outcome.total, Some(total));
    assert_eq!((outcome.written, outcome.time), (3, 3 * time));
    assert_eq!(outcome.clipped, 9);
    assert!(outcome.is_over_tolerance());
}
