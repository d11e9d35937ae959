//! The rule on polynomials, on smooth light, and on jumps.

use super::*;
use crate::picture::pixel::Evidence;

fn part(panel: Panel, light: impl Fn(f64) -> f64) -> Part {
    let pixels = panel.times().map(|time| Pixel {
        value: Color::splat(light(time)),
        alpha: 1.0,
        error: 1e-4,
        evidence: Evidence::Bound,
        status: Status::Met,
    });
    Part::new(panel, &pixels, 1.0)
}

const WHOLE: Panel = Panel { level: 0, index: 0 };

#[test]
fn polynomials_are_averaged_and_low_ones_claim_nothing() {
    for degree in 0..=11 {
        let found = part(WHOLE, |time| libm::pow(time + 0.5, f64::from(degree)));
        let expected = 1.0 / f64::from(degree + 1);
        assert!((found.value.x - expected).abs() < 1e-15, "degree {degree}");
        assert_eq!(found.time_error < 1e-14, degree < 5, "degree {degree}");
        assert!((found.area_error - 1e-4).abs() < 1e-18);
    }
}

#[test]
fn what_never_changes_is_itself() {
    let found = part(WHOLE, |_| 0.1);
    assert_eq!((found.value.x, found.time_error), (0.1, 0.0));
}

#[test]
fn halves_are_the_whole() {
    let light = |time: f64| libm::exp(3.0 * time);
    let whole = part(WHOLE, light);
    let [first, second] = WHOLE.halves().unwrap().map(|half| part(half, light));
    let halves = 0.5 * (first.value.x + second.value.x);
    let exact = 2.0 / 3.0 * libm::sinh(1.5);
    assert!((halves - exact).abs() < 1e-13);
    assert!((whole.value.x - exact).abs() < whole.time_error);
    assert!(first.time_error + second.time_error < 0.1 * whole.time_error);
    assert_eq!(
        [0, 1, 2],
        [WHOLE.number(), first.panel.number(), second.panel.number()]
    );
}

/// But for one before the first moment or after the last.
#[test]
fn a_jump_claims_about_what_it_costs() {
    let outside = 0.5 - 0.5 * ABSCISSAS[MOMENTS - 1];
    for place in 0..1000 {
        let jump = f64::from(place) / 1000.0 - 0.5;
        let found = part(WHOLE, |time| f64::from(u8::from(time > jump)));
        let off = (found.value.x - (0.5 - jump)).abs();
        let claimed = found.time_error;
        assert!(off <= 2.0 * claimed + outside, "{place}: {off}, {claimed}");
    }
}
