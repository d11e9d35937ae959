//! A report with invented measurements, and its output.

use std::num::NonZeroU32;
use std::time::Duration;

use marbles_core::{Method, Summary, Work};

use super::accuracy::Accuracy;
use super::measure::{Measurement, Reference, Setting};
use super::*;
use crate::formats::tests::{Scene, render, view};

/// A setting with invented measurements.
fn setting(method: Method, rmse: f64, seconds: f64) -> Setting {
    Setting {
        method,
        times: vec![Duration::from_secs_f64(seconds)],
        accuracy: Accuracy {
            rmse,
            largest: 10.0 * rmse,
            largest_claimed: 20.0 * rmse,
            median_of_claimed: Some(0.123),
            over: 0,
            missed: 0,
        },
        summary: Summary {
            pixels: 100,
            largest_error: 20.0 * rmse,
            bounds: 93,
            over_tolerance: 0,
        },
        work: Work::default(),
    }
}

/// Settings of both kinds: supersampling takes 2/error seconds.
fn settings() -> Vec<Setting> {
    let samples = |sides| Method::Samples(NonZeroU32::new(sides).unwrap());
    vec![
        setting(Method::Tolerance(1e-1), 1e-2, 2.0),
        setting(Method::Tolerance(1e-2), 1e-4, 4.0),
        setting(samples(1), 1e-1, 20.0),
        setting(samples(2), 1e-3, 2000.0),
    ]
}

/// A report with invented measurements.
pub(super) fn report() -> Report {
    let settings = settings();
    let image = render(Scene::Grey, false);
    let known = image.summary().pixels;
    Report {
        title: "ball, red.ron, 23 x 19 pixels, 2 threads".to_owned(),
        scene: "ball, red.ron".to_owned(),
        threads: 2,
        view: view(),
        rows: Row::all(&settings),
        measurement: Measurement {
            reference: Reference {
                tolerance: 1e-9,
                image,
                time: Duration::from_secs(3),
                known,
            },
            settings,
            runs_planned: 5,
        },
    }
}

#[test]
fn speed_ups_are_at_equal_error() {
    let rows = Row::all(&settings());
    let speed_ups: Vec<(f64, bool)> = rows.iter().filter_map(Row::speed_up).collect();
    let expected = [(100.0, false), (5000.0, true), (1.0, false), (1.0, false)];
    for ((found, beyond), (expected, expected_beyond)) in speed_ups.into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
        assert_eq!(beyond, expected_beyond);
    }
}

#[test]
fn whole_pictures_are_refused_where_they_do_not_fit() {
    let square = |side| Size {
        width: side,
        height: side,
    };
    assert!(check_memory(square(9), Channels::Rgb).is_ok());
    assert!(check_memory(square(1 << 26), Channels::Rgb).is_err());
}

#[test]
fn a_pixel_that_misses_its_tolerance_decides_the_exit_code() {
    let mut report = report();
    assert_eq!(conclusion(&report), status::SUCCESS);
    report.measurement.settings[1].accuracy.missed = 1;
    assert_eq!(conclusion(&report), status::OVER_TOLERANCE);
}
