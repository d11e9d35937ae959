//! The rows of a report: what was measured, beside the yardstick.

use marbles_core::Method;

use super::curve::{Curve, Point, Time};
use super::measure::Setting;

/// A setting, beside supersampling at the same error.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) setting: Setting,
    pub(super) seconds: f64,
    /// The time that supersampling takes to the same RMSE.
    pub(super) supersampling: Option<Time>,
}

impl Row {
    /// The rows of all settings.
    pub(super) fn all(settings: &[Setting]) -> Vec<Self> {
        let curve = supersampling(settings);
        let row = |setting: &Setting| Self {
            setting: setting.clone(),
            seconds: setting.seconds(),
            supersampling: match setting.method {
                Method::Tolerance(_) => curve.time(setting.accuracy.rmse),
                Method::Samples(_) => None,
            },
        };
        settings.iter().map(row).collect()
    }

    /// The speed in multiples of supersampling's, and whether that is extrapolated. Supersampling
    /// itself is as fast as itself.
    pub(super) fn speed_up(&self) -> Option<(f64, bool)> {
        match self.setting.method {
            Method::Samples(_) => Some((1.0, false)),
            Method::Tolerance(_) => {
                let time = self.supersampling?;
                let ratio = time.seconds / self.seconds;
                ratio.is_finite().then_some((ratio, time.extrapolated))
            }
        }
    }

    pub(super) fn point(&self) -> Point {
        Point {
            rmse: self.setting.accuracy.rmse,
            seconds: self.seconds,
        }
    }
}

/// Time against RMSE of those settings that are supersampling.
pub(super) fn supersampling(settings: &[Setting]) -> Curve {
    let samples = settings
        .iter()
        .filter(|setting| matches!(setting.method, Method::Samples(_)));
    Curve::through(samples.map(|setting| Point {
        rmse: setting.accuracy.rmse,
        seconds: setting.seconds(),
    }))
}

#[cfg(test)]
pub(super) mod tests {
    use std::num::NonZeroU32;
    use std::time::Duration;

    use marbles_core::{Evidence, Summary, Work};

    use super::*;
    use crate::commands::report::accuracy::Accuracy;

    /// A setting as if it had been measured.
    pub(in crate::commands::report) fn setting(method: Method, rmse: f64, seconds: f64) -> Setting {
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
                evidence: Evidence::Estimate,
                over_tolerance: 0,
            },
            work: Work::default(),
        }
    }

    /// Settings of both kinds: supersampling takes 2/error seconds.
    pub(in crate::commands::report) fn settings() -> Vec<Setting> {
        let samples = |sides| Method::Samples(NonZeroU32::new(sides).unwrap());
        vec![
            setting(Method::Tolerance(1e-1), 1e-2, 2.0),
            setting(Method::Tolerance(1e-2), 1e-4, 4.0),
            setting(samples(1), 1e-1, 20.0),
            setting(samples(2), 1e-3, 2000.0),
        ]
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
}
