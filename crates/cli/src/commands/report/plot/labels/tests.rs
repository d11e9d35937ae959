//! Tests of `labels.rs`.

use super::*;

fn labels() -> Labels {
    Labels::within((0.0, 0.0), (200.0, 300.0))
}

#[test]
fn labels_take_the_first_free_side() {
    let mut labels = labels();
    let sides = [Side::Below, Side::Right];
    let below = labels.place((100.0, 100.0), "1e-2", &sides);
    assert_eq!(below, Some(((100.0, 118.0), Anchor::Middle)));
    let right = labels.place((101.0, 100.0), "1e-3", &sides);
    assert_eq!(right, Some(((110.0, 104.5), Anchor::Start)));
    assert_eq!(labels.place((102.0, 101.0), "1e-4", &sides), None);
    assert!(labels.place((100.0, 200.0), "1e-5", &sides).is_some());
}

#[test]
fn labels_keep_off_points() {
    let mut labels = labels();
    labels.avoid((100.0, 114.0), 4.0);
    let sides = [Side::Below, Side::Left];
    let found = labels.place((100.0, 100.0), "1", &sides);
    assert_eq!(found, Some(((91.0, 104.5), Anchor::End)));
}

#[test]
fn labels_keep_off_lines_and_borders() {
    let mut labels = labels();
    labels.avoid_line((0.0, 130.0), (200.0, 90.0));
    let sides = [Side::Below, Side::Right, Side::Above];
    // The line passes 10 units below the point.
    let found = labels.place((100.0, 100.0), "8×8", &sides);
    assert_eq!(found, Some(((100.0, 91.0), Anchor::Middle)));
    let sides = [Side::Right, Side::Left];
    let found = labels.place((190.0, 200.0), "8×8", &sides);
    assert_eq!(found, Some(((181.0, 204.5), Anchor::End)));
}
