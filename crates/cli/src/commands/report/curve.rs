//! The time of supersampling at a given error, between and beyond the measured runs.

/// A measured setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) rmse: f64,
    pub(super) seconds: f64,
}

/// The time at an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Time {
    pub(super) seconds: f64,
    /// Whether the error is smaller than all measured errors.
    pub(super) extrapolated: bool,
}

/// Time against RMSE, linear between the points in a log-log plot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// The points from the cheapest on, each more accurate than the one before.
    points: Vec<Point>,
    /// The exponent of RMSE in the time at the end of the curve, below 0.
    slope: Option<f64>,
}

impl Curve {
    /// The curve through all points that are more accurate than every cheaper one.
    pub(super) fn through(points: impl IntoIterator<Item = Point>) -> Self {
        let measured = |point: &Point| point.rmse > 0.0 && point.seconds > 0.0;
        let mut sorted: Vec<Point> = points.into_iter().filter(measured).collect();
        sorted.sort_by(|one, other| one.seconds.total_cmp(&other.seconds));
        let mut points: Vec<Point> = Vec::new();
        for point in sorted {
            if points.last().is_none_or(|last| point.rmse < last.rmse) {
                points.push(point);
            }
        }
        let slope = slope(&points);
        Self { points, slope }
    }

    /// The time at an error. At errors larger than that of the cheapest point it is the time of that point, because
    /// there is no setting with less than one sample.
    pub(super) fn time(&self, rmse: f64) -> Option<Time> {
        let (first, last) = (self.points.first()?, self.points.last()?);
        if rmse.is_nan() || rmse <= 0.0 {
            return None;
        }
        let measured = |seconds| {
            Some(Time {
                seconds,
                extrapolated: false,
            })
        };
        if rmse >= first.rmse {
            return measured(first.seconds);
        }
        if let Some(pair) = self.points.windows(2).find(|pair| rmse >= pair[1].rmse) {
            let slope = exponent(&pair[0], &pair[1]);
            return measured(along(&pair[0], slope, rmse));
        }
        Some(Time {
            seconds: along(last, self.slope?, rmse),
            extrapolated: true,
        })
    }

    /// The exponent of RMSE in the time at the end of the curve, if the curve falls there.
    pub(super) fn slope(&self) -> Option<f64> {
        self.slope
    }

    /// The most accurate point.
    pub(super) fn end(&self) -> Option<Point> {
        self.points.last().copied()
    }
}

/// The time at an error on the line through a point.
fn along(point: &Point, slope: f64, rmse: f64) -> f64 {
    point.seconds * libm::pow(rmse / point.rmse, slope)
}

/// The exponent of RMSE in the time between two points.
fn exponent(one: &Point, other: &Point) -> f64 {
    libm::log(other.seconds / one.seconds) / libm::log(other.rmse / one.rmse)
}

/// The exponent by least squares over the last points, if time rises as the error falls.
fn slope(points: &[Point]) -> Option<f64> {
    /// Enough points to average out fluctuations. If there are more, the cheapest settings are left out, because most
    /// of their time is not spent on samples.
    const POINTS: usize = 6;
    let points = &points[points.len().saturating_sub(POINTS)..];
    let count = points.len() as f64;
    let (x, y): (Vec<f64>, Vec<f64>) = points
        .iter()
        .map(|point| (libm::log(point.rmse), libm::log(point.seconds)))
        .unzip();
    let mean = |numbers: &[f64]| numbers.iter().sum::<f64>() / count;
    let (x_mean, y_mean) = (mean(&x), mean(&y));
    let products = x.iter().zip(&y).map(|(x, y)| (x - x_mean) * (y - y_mean));
    let squares = x.iter().map(|x| (x - x_mean) * (x - x_mean));
    let slope = products.sum::<f64>() / squares.sum::<f64>();
    (slope < 0.0).then_some(slope)
}

#[cfg(test)]
mod tests;
