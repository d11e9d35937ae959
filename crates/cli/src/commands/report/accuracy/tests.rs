//! Tests of `accuracy.rs`.

use super::*;
use crate::formats::tests::{Scene, render};

#[test]
fn medians_are_in_the_middle() {
    assert_eq!(median(&mut []), None);
    assert_eq!(median(&mut [7.0]), Some(7.0));
    assert_eq!(median(&mut [9.0, 1.0, 4.0]), Some(4.0));
    assert_eq!(median(&mut [9.0, 1.0, 4.0, 2.0]), Some(3.0));
    assert_eq!(median(&mut [f64::INFINITY, 1.0, 0.0]), Some(1.0));
}

#[test]
fn a_picture_has_no_error_against_itself() {
    let picture = render(Scene::Color, false);
    let accuracy = Accuracy::of(&picture, &picture, Some(1e-3));
    assert_eq!(
        (accuracy.rmse, accuracy.largest, accuracy.over),
        (0.0, 0.0, 0)
    );
    // Supersampled edges claim too much for a reference; what is left claims nothing.
    assert_eq!(accuracy.median_of_claimed, None);
    assert!(accuracy.largest_claimed <= LARGEST_UNKNOWN);
    let known = places(&picture).filter(|&pixel| is_known(&picture, pixel));
    let known = known.count();
    assert!(known > 0 && known < places(&picture).count());
}
