//! Tests of `curve.rs`.

use super::*;

fn point(rmse: f64, seconds: f64) -> Point {
    Point { rmse, seconds }
}

fn assert_near(found: Option<Time>, seconds: f64, extrapolated: bool) {
    let found = found.unwrap();
    assert!((found.seconds / seconds - 1.0).abs() < 1e-12, "{found:?}");
    assert_eq!(found.extrapolated, extrapolated);
}

#[test]
fn a_power_law_is_kept_everywhere() {
    let law = |rmse: f64| 2e-3 * libm::pow(rmse, -4.0 / 3.0);
    let errors = [1e-1, 3e-2, 1e-2, 2e-3, 1e-3, 5e-4];
    let curve = Curve::through(errors.map(|rmse| point(rmse, law(rmse))));
    assert!((curve.slope().unwrap() + 4.0 / 3.0).abs() < 1e-12);
    for rmse in [1e-1, 5e-2, 1e-2, 7e-3, 5e-4] {
        assert_near(curve.time(rmse), law(rmse), false);
    }
    for rmse in [4e-4, 1e-6] {
        assert_near(curve.time(rmse), law(rmse), true);
    }
}

#[test]
fn less_than_the_cheapest_cannot_be_had() {
    let curve = Curve::through([point(1e-2, 4.0), point(1e-1, 1.0)]);
    assert_near(curve.time(0.5), 1.0, false);
}

#[test]
fn points_that_others_outdo_do_not_count() {
    let good = [point(1e-1, 1.0), point(1e-2, 4.0), point(1e-3, 16.0)];
    let curve = Curve::through(good);
    let bad = [point(2e-1, 1.5), point(5e-2, 9.0), point(0.0, 2.0)];
    assert_eq!(Curve::through(good.into_iter().chain(bad)), curve);
}

#[test]
fn without_a_slope_nothing_is_extrapolated() {
    assert_eq!(Curve::through([]).time(1e-3), None);
    let curve = Curve::through([point(1e-2, 1.0)]);
    assert_eq!(curve.slope(), None);
    assert_eq!(curve.time(1e-3), None);
    assert_near(curve.time(1e-2), 1.0, false);
    assert_eq!(curve.time(0.0), None);
    assert_eq!(curve.time(f64::NAN), None);
}
