//! Tests of `dips.rs`.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::numeric::lanes::f64x8;

/// The intervals between 0, 1, ... 7 in which a function may dip.
fn dips_of(function: impl Fn(f64) -> f64) -> u64 {
    let values: [f64; 8] = std::array::from_fn(|place| function(place as f64));
    dispatch!(Level::new(), simd => {
        let values: f64x8<_> = f64x8::from_array(simd, values);
        dips(values)
    })
}

/// Hyperbolas, from ones that turn within a hundredth of a step to nearly parabolas, are below zero around a place
/// between two others. So are they with the other sign.
#[test]
fn sharp_turns_below_zero_are_found() {
    let mut found = 0;
    for interval in 1..6 {
        for share in 1..20 {
            let lowest = f64::from(interval) + f64::from(share) / 20.0;
            for sharpness in [0.01, 0.1, 0.5, 2.0, 10.0] {
                let hyperbola = |at: f64| libm::hypot(sharpness, at - lowest);
                let sides = [lowest.floor(), lowest.ceil()].map(hyperbola);
                let depth = 0.5 * (sides[0].min(sides[1]) - sharpness);
                for sign in [1.0, -1.0] {
                    let function = |at: f64| sign * (hyperbola(at) - sharpness - depth);
                    let dips = dips_of(function);
                    assert!(
                        dips >> interval & 1 == 1,
                        "{lowest} {sharpness} {sign}: {dips:b}"
                    );
                    found += 1;
                }
            }
        }
    }
    assert_eq!(found, 5 * 19 * 5 * 2);
}

/// In the first and the last interval parabolas are found.
#[test]
fn parabolas_below_zero_at_the_ends_are_found() {
    for share in 1..10 {
        let lowest = f64::from(share) / 10.0;
        let depth = 0.5 * (lowest * lowest).min((1.0 - lowest) * (1.0 - lowest));
        let first = dips_of(|at| (at - lowest) * (at - lowest) - depth);
        assert_eq!(first & 1, 1, "{lowest}");
        let last = dips_of(|at| (7.0 - at - lowest) * (7.0 - at - lowest) - depth);
        assert_eq!(last >> 6, 1, "{lowest}");
    }
}

/// Functions that change their sign, go by, or stay far from zero are not looked at closer.
#[test]
fn nothing_else_is() {
    assert_eq!(dips_of(|at| at - 3.4), 0);
    assert_eq!(dips_of(|at| 1.0 + at), 0);
    assert_eq!(dips_of(|at| (at - 3.4) * (at - 3.4) + 3.0), 0);
    assert_eq!(dips_of(|_| 0.0), 0);
    assert_eq!(dips_of(|_| f64::NAN), 0);
}

#[test]
fn values_around_an_interval_go_on_as_parabolas() {
    let square = |at: f64| (at - 2.5) * (at - 2.5);
    let values: [f64; 8] = std::array::from_fn(|place| square(place as f64));
    for interval in 0..7 {
        let expected = [-1.0, 0.0, 1.0, 2.0].map(|step| square(interval as f64 + step));
        assert_eq!(around(&values, interval), expected);
    }
}
