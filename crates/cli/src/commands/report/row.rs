//! The rows of a report: measurements, and the comparison with supersampling.

use marbles_core::Method;

use super::curve::{Curve, Point, Time};
use super::measure::Setting;

/// A setting, and supersampling at the same error.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) setting: Setting,
    pub(super) seconds: f64,
    /// The time of supersampling at the same RMSE.
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

    /// The speed as a multiple of the speed of supersampling, and whether this is extrapolated. For supersampling it is
    /// 1.
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

/// Time against RMSE for the supersampling settings.
pub(super) fn supersampling(settings: &[Setting]) -> Curve {
    let samples = settings
        .iter()
        .filter(|setting| matches!(setting.method, Method::Samples(_)));
    Curve::through(samples.map(|setting| Point {
        rmse: setting.accuracy.rmse,
        seconds: setting.seconds(),
    }))
}
