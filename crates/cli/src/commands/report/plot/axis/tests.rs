//! Tests of `axis.rs`.

use super::*;

fn labels(axis: &Axis, most: u32) -> Vec<i32> {
    axis.ticks(most)
        .iter()
        .filter_map(|tick| tick.label)
        .collect()
}

#[test]
fn axes_end_at_powers_of_ten() {
    let axis = Axis::around([2e-3, 0.5, 0.0], (100.0, 400.0), false);
    assert_eq!(axis.range(), (1e-3, 1.0));
    assert_eq!(labels(&axis, 10), [-3, -2, -1, 0]);
    assert!((axis.place(1e-2) - 200.0).abs() < 1e-9);
    assert_eq!(axis.ticks(10).len(), 4 + 3 * 8);
}

#[test]
fn axes_may_fall() {
    let axis = Axis::around([1e-6, 1e-1], (0.0, 500.0), true);
    assert_eq!((axis.place(1e-1), axis.place(1e-6)), (0.0, 500.0));
    assert!((axis.place(1e-4) - 300.0).abs() < 1e-9);
    assert_eq!(labels(&axis, 10), [-6, -5, -4, -3, -2, -1]);
}

#[test]
fn a_single_value_has_a_decade() {
    assert_eq!(Axis::around([1.0], (0.0, 1.0), false).range(), (1.0, 10.0));
    assert_eq!(Axis::around([], (0.0, 1.0), false).range(), (1.0, 10.0));
}

#[test]
fn long_axes_have_fewer_labels() {
    let axis = Axis::around([1e-12, 1e8], (0.0, 1.0), false);
    for most in [1, 2, 5, 8, 20, 21] {
        assert!(labels(&axis, most).len() <= most as usize, "{most}");
    }
    assert_eq!(labels(&axis, 11), [-12, -10, -8, -6, -4, -2, 0, 2, 4, 6, 8]);
}
