//! The chart: both methods, the labels of their settings, and the distance between the curves.
//!
//! RMSE decreases to the right and time increases upward, so a curve that stays low to the right is fast and accurate.

use marbles_core::Method;

use super::axis::Axis;
use super::labels::{Labels, Side};
use crate::base::numbers::factor;
use crate::commands::report::curve::Point;
use crate::commands::report::results::Report;
use crate::commands::report::row::{Row, supersampling};
use crate::commands::svg::{Anchor, Place, Style, Svg};

const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 500.0;
/// The sides of the area between the axes.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 776.0;
const TOP: f64 = 84.0;
const BOTTOM: f64 = 444.0;

const INK: &str = "#222830";
const SOFT_INK: &str = "#5a6470";
const GRID: &str = "#e3e7ec";
/// Blue and vermilion, which people with any kind of color vision can distinguish.
const TOLERANCES: &str = "#005fae";
const SAMPLES: &str = "#c84e00";

const NORMAL: Style = Style {
    anchor: Anchor::Start,
    size: 14.0,
    is_bold: false,
    color: INK,
};
const TITLE: Style = Style {
    size: 16.0,
    is_bold: true,
    ..NORMAL
};
const SMALL: Style = Style {
    size: 12.0,
    ..NORMAL
};

/// Labels along an axis.
const MOST_LABELS: u32 = 9;
/// The ratio of the longest extrapolated time that is still shown to the longest measured one.
const EXTRAPOLATED_RANGE: f64 = 1e3;
const MARK: f64 = 4.0;

/// The chart as an SVG.
pub(in crate::commands::report) fn draw(report: &Report) -> String {
    let mut chart = Chart::of(report);
    chart.axes();
    chart.legend(report);
    chart.extrapolation();
    chart.curves();
    chart.distance();
    chart.labels();
    chart.svg.finish()
}

struct Chart<'a> {
    svg: Svg,
    /// The positions of labels, and of what they must not hide.
    room: Labels,
    x: Axis,
    y: Axis,
    samples: Series<'a>,
    tolerances: Series<'a>,
    /// The end of the supersampling curve, and its extrapolation to the smallest error of the tolerances.
    extrapolation: Option<[Point; 2]>,
}

/// The settings of a method.
struct Series<'a> {
    rows: Vec<&'a Row>,
    color: &'static str,
    /// Whether its marks are disks instead of squares.
    is_round: bool,
    /// The sides of points for labels, the best first: sides on which curves usually leave room.
    sides: [Side; 5],
}

impl<'a> Chart<'a> {
    fn of(report: &'a Report) -> Self {
        let drawable = |row: &&Row| row.point().rmse > 0.0 && row.point().seconds > 0.0;
        let (tolerances, samples): (Vec<&Row>, Vec<&Row>) = report
            .rows
            .iter()
            .filter(drawable)
            .partition(|row| matches!(row.setting.method, Method::Tolerance(_)));
        let points = || tolerances.iter().chain(&samples).map(|row| row.point());
        let smallest = points()
            .map(|point| point.rmse)
            .fold(f64::INFINITY, f64::min);
        let longest = points().map(|point| point.seconds).fold(0.0, f64::max);
        let extrapolation = extrapolation(report, smallest);
        let shown = |&point: &Point| point.seconds <= longest * EXTRAPOLATED_RANGE;
        let beyond = extrapolation.map(|[_, to]| to).filter(shown);
        let times = points().chain(beyond).map(|point| point.seconds);
        Self {
            svg: Svg::new(WIDTH, HEIGHT, &report.title),
            // Labels may reach a little beyond the axes on the right.
            room: Labels::within((LEFT + 2.0, TOP - 8.0), (WIDTH - 4.0, BOTTOM - 2.0)),
            x: Axis::around(points().map(|point| point.rmse), (LEFT, RIGHT), true),
            y: Axis::around(times, (BOTTOM, TOP), false),
            samples: Series {
                rows: samples,
                color: SAMPLES,
                is_round: false,
                sides: [
                    Side::AboveLeft,
                    Side::Above,
                    Side::Left,
                    Side::Right,
                    Side::BelowRight,
                ],
            },
            tolerances: Series {
                rows: tolerances,
                color: TOLERANCES,
                is_round: true,
                sides: [
                    Side::BelowRight,
                    Side::Below,
                    Side::Right,
                    Side::Left,
                    Side::Above,
                ],
            },
            extrapolation,
        }
    }

    fn place(&self, point: Point) -> Place {
        (self.x.place(point.rmse), self.y.place(point.seconds))
    }

    fn places(&self, series: &Series<'_>) -> Vec<Place> {
        let rows = series.rows.iter();
        rows.map(|row| self.place(row.point())).collect()
    }

    fn axes(&mut self) {
        let svg = &mut self.svg;
        let middle = Style {
            anchor: Anchor::Middle,
            ..NORMAL
        };
        for tick in self.x.ticks(MOST_LABELS) {
            if tick.is_decade {
                svg.line(&[(tick.at, TOP), (tick.at, BOTTOM)], 1.0, GRID);
            } else {
                svg.line(&[(tick.at, BOTTOM), (tick.at, BOTTOM + 4.0)], 1.0, SOFT_INK);
            }
            if let Some(exponent) = tick.label {
                svg.power((tick.at, BOTTOM + 22.0), middle, exponent);
            }
        }
        for tick in self.y.ticks(MOST_LABELS) {
            if tick.is_decade {
                svg.line(&[(LEFT, tick.at), (RIGHT, tick.at)], 1.0, GRID);
            } else {
                svg.line(&[(LEFT - 4.0, tick.at), (LEFT, tick.at)], 1.0, SOFT_INK);
            }
            if let Some(exponent) = tick.label {
                let place = (LEFT - 10.0, tick.at + 4.5);
                let style = Style {
                    anchor: Anchor::End,
                    ..NORMAL
                };
                match time(exponent) {
                    Some(text) => svg.text(place, style, text),
                    None => svg.power(place, style, exponent),
                }
            }
        }
        svg.line(&[(LEFT, BOTTOM), (RIGHT, BOTTOM)], 1.25, SOFT_INK);
        svg.line(&[(LEFT, TOP), (LEFT, BOTTOM)], 1.25, SOFT_INK);
        let place = ((LEFT + RIGHT) / 2.0, BOTTOM + 44.0);
        let title = "RMSE of the picture, more accurate to the right";
        svg.text(place, middle, title);
    }

    /// The title, and the legend.
    fn legend(&mut self, report: &Report) {
        let y = 58.0;
        let title = format!("Time against error: {}", report.title);
        self.svg.text((12.0, 28.0), TITLE, &title);
        self.svg.text((12.0, y), NORMAL, "time");
        for (x, series, name) in [
            (10.0, &self.tolerances, "marbles, with a tolerance"),
            (232.0, &self.samples, "supersampling, samples per pixel"),
        ] {
            let color = series.color;
            series.mark(&mut self.svg, (LEFT + x, y - 4.5));
            let place = (LEFT + x + 12.0, y);
            self.svg.text(place, Style { color, ..NORMAL }, name);
        }
        if self.extrapolation.is_some() {
            let color = SAMPLES;
            let line = [(LEFT + 512.0, y - 4.5), (LEFT + 552.0, y - 4.5)];
            self.svg.dashes(&line, 2.0, color);
            let place = (LEFT + 560.0, y);
            self.svg
                .text(place, Style { color, ..NORMAL }, "extrapolated");
        }
    }

    /// The line beyond the measured samples, as far as there is room.
    fn extrapolation(&mut self) {
        let Some([from, to]) = self.extrapolation else {
            return;
        };
        let (from, to) = (self.place(from), self.place(to));
        // The line is straight on the drawing, and leaves it at the top if anywhere.
        let along = if to.1 < TOP {
            (from.1 - TOP) / (from.1 - to.1)
        } else {
            1.0
        };
        let end = (
            from.0 + along * (to.0 - from.0),
            from.1 + along * (to.1 - from.1),
        );
        self.svg.dashes(&[from, end], 2.0, SAMPLES);
        self.room.avoid_line(from, end);
    }

    fn curves(&mut self) {
        for series in [&self.samples, &self.tolerances] {
            let places = self.places(series);
            self.svg.line(&places, 2.0, series.color);
            for &place in &places {
                series.mark(&mut self.svg, place);
                self.room.avoid(place, MARK);
            }
            for pair in places.windows(2) {
                self.room.avoid_line(pair[0], pair[1]);
            }
        }
    }

    /// The labels of the settings next to their points; a label is left out if there is no room.
    fn labels(&mut self) {
        for series in [&self.samples, &self.tolerances] {
            for (row, point) in series.rows.iter().zip(self.places(series)) {
                let text = label(row.setting.method);
                if let Some((place, anchor)) = self.room.place(point, &text, &series.sides) {
                    let style = Style {
                        anchor,
                        color: series.color,
                        ..SMALL
                    };
                    self.svg.text(place, style, &text);
                }
            }
        }
    }

    /// The distance of the curves at the place where it is largest among the measured ones, or else where it is
    /// extrapolated and visible.
    fn distance(&mut self) {
        /// A smaller distance gets no label.
        const LEAST: f64 = 1.5;
        let top = self.y.range().1;
        let candidates = self.tolerances.rows.iter().filter_map(|row| {
            let (ratio, extrapolated) = row.speed_up()?;
            let time = row.supersampling?.seconds;
            (ratio >= LEAST && time <= top).then_some((!extrapolated, ratio, *row, time))
        });
        let order = |one: &(bool, f64, &Row, f64), other: &(bool, f64, &Row, f64)| {
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        };
        let Some((_, ratio, row, seconds)) = candidates.max_by(order) else {
            return;
        };
        let point = row.point();
        let low = self.place(point);
        let high = self.place(Point { seconds, ..point });
        let gap = MARK + 5.0;
        let (low, high) = ((low.0, low.1 - gap), (high.0, high.1 + gap));
        if low.1 - high.1 < 2.0 * gap {
            return;
        }
        self.svg.line(&[low, high], 1.25, SOFT_INK);
        for (tip, direction) in [(low, -1.0), (high, 1.0)] {
            for side in [-4.0, 4.0] {
                let end = (tip.0 + side, tip.1 + 6.0 * direction);
                self.svg.line(&[tip, end], 1.25, SOFT_INK);
            }
        }
        let (left, middle) = (low.0 + 10.0, (low.1 + high.1) / 2.0);
        let text = format!("{} times faster", factor(ratio));
        self.svg.text((left, middle), NORMAL, &text);
        let style = Style {
            color: SOFT_INK,
            ..SMALL
        };
        self.svg
            .text((left, middle + 17.0), style, "at the same RMSE");
        self.room.avoid_line(low, high);
        let right = left + 8.5 * text.len() as f64;
        let (top, bottom) = (middle - 12.0, middle + 20.0);
        self.room.avoid_box((left, top), (right, bottom));
    }
}

impl Series<'_> {
    /// Draws the mark of a point.
    fn mark(&self, svg: &mut Svg, center: Place) {
        if self.is_round {
            svg.disk(center, MARK + 0.5, self.color);
        } else {
            svg.square(center, 2.0 * MARK, self.color);
        }
    }
}

/// The end of supersampling, and its extrapolation to the smallest error.
fn extrapolation(report: &Report, smallest: f64) -> Option<[Point; 2]> {
    let curve = supersampling(&report.measurement.settings);
    let time = curve.time(smallest)?;
    let end = Point {
        rmse: smallest,
        seconds: time.seconds,
    };
    time.extrapolated.then_some([curve.end()?, end])
}

/// A power of ten in seconds, if it has a name.
fn time(exponent: i32) -> Option<&'static str> {
    const NAMES: [&str; 10] = [
        "1 µs", "10 µs", "100 µs", "1 ms", "10 ms", "100 ms", "1 s", "10 s", "100 s", "1000 s",
    ];
    const FIRST: i32 = -6;
    usize::try_from(exponent - FIRST)
        .ok()
        .and_then(|index| NAMES.get(index).copied())
}

fn label(method: Method) -> String {
    match method {
        Method::Tolerance(tolerance) => format!("{tolerance:e}"),
        Method::Samples(sides) if sides.get() == 1 => "1".to_owned(),
        Method::Samples(sides) => format!("{sides}×{sides}"),
    }
}

#[cfg(test)]
mod tests;
