//! The chart: both methods, the labels of their settings, and how far they are apart.
//!
//! RMSE falls to the right and time rises upward, so that a curve that stays low to the right is
//! fast and accurate.

use marbles_core::Method;

use super::axis::Axis;
use super::drawing::{Anchor, Color, Drawing, Place, Shape, Size, Text};
use super::labels::{Labels, Side};
use crate::base::numbers::factor;
use crate::commands::report::curve::Point;
use crate::commands::report::results::Report;
use crate::commands::report::row::{Row, supersampling};

const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 500.0;
/// The sides of the area between the axes.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 776.0;
const TOP: f64 = 84.0;
const BOTTOM: f64 = 444.0;

const INK: Color = Color([0x22, 0x28, 0x30]);
const SOFT_INK: Color = Color([0x5a, 0x64, 0x70]);
const GRID: Color = Color([0xe3, 0xe7, 0xec]);
/// Blue and vermilion, which people with any color vision tell apart.
const TOLERANCES: Color = Color([0x00, 0x5f, 0xae]);
const SAMPLES: Color = Color([0xc8, 0x4e, 0x00]);

/// Labels along an axis.
const MOST_LABELS: u32 = 9;
/// How many times longer than anything measured an extrapolated time may be and still be shown.
const EXTRAPOLATED_RANGE: f64 = 1e3;
const MARK: f64 = 4.0;

pub(super) fn draw(report: &Report) -> Drawing {
    let mut chart = Chart::of(report);
    chart.axes();
    chart.legend(report);
    chart.extrapolation();
    chart.curves();
    chart.distance();
    chart.labels();
    chart.drawing
}

struct Chart<'a> {
    drawing: Drawing,
    /// Where there is room for labels.
    room: Labels,
    x: Axis,
    y: Axis,
    tolerances: Vec<&'a Row>,
    samples: Vec<&'a Row>,
    /// Where supersampling ends, and where it would be at the smallest error of the tolerances.
    extrapolation: Option<[Point; 2]>,
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
            drawing: Drawing {
                width: WIDTH,
                height: HEIGHT,
                title: report.title.clone(),
                shapes: Vec::new(),
            },
            // Labels may reach a little beyond the axes on the right.
            room: Labels::within((LEFT + 2.0, TOP - 8.0), (WIDTH - 4.0, BOTTOM - 2.0)),
            x: Axis::around(points().map(|point| point.rmse), (LEFT, RIGHT), true),
            y: Axis::around(times, (BOTTOM, TOP), false),
            tolerances,
            samples,
            extrapolation,
        }
    }

    fn place(&self, point: Point) -> Place {
        (self.x.place(point.rmse), self.y.place(point.seconds))
    }

    fn axes(&mut self) {
        for tick in self.x.ticks(MOST_LABELS) {
            if tick.is_decade {
                let (top, bottom) = ((tick.at, TOP), (tick.at, BOTTOM));
                self.drawing.line(top, bottom, 1.0, GRID);
            } else {
                let (top, bottom) = ((tick.at, BOTTOM), (tick.at, BOTTOM + 4.0));
                self.drawing.line(top, bottom, 1.0, SOFT_INK);
            }
            if let Some(exponent) = tick.label {
                self.power((tick.at, BOTTOM + 22.0), Anchor::Middle, exponent);
            }
        }
        for tick in self.y.ticks(MOST_LABELS) {
            if tick.is_decade {
                self.drawing
                    .line((LEFT, tick.at), (RIGHT, tick.at), 1.0, GRID);
            } else {
                let (left, right) = ((LEFT - 4.0, tick.at), (LEFT, tick.at));
                self.drawing.line(left, right, 1.0, SOFT_INK);
            }
            if let Some(exponent) = tick.label {
                let place = (LEFT - 10.0, tick.at + 4.5);
                match time(exponent) {
                    Some(text) => self
                        .drawing
                        .text(place, Anchor::End, Size::Normal, INK, text),
                    None => self.power(place, Anchor::End, exponent),
                }
            }
        }
        self.drawing
            .line((LEFT, BOTTOM), (RIGHT, BOTTOM), 1.25, SOFT_INK);
        self.drawing
            .line((LEFT, TOP), (LEFT, BOTTOM), 1.25, SOFT_INK);
        let y = BOTTOM + 44.0;
        let middle = (LEFT + RIGHT) / 2.0;
        let title = "RMSE of the picture, more accurate to the right";
        self.drawing
            .text((middle, y), Anchor::Middle, Size::Normal, INK, title);
    }

    /// The label of a power of ten.
    fn power(&mut self, place: Place, anchor: Anchor, exponent: i32) {
        self.drawing.shapes.push(Shape::Text(Text {
            place,
            anchor,
            size: Size::Normal,
            color: INK,
            text: "10".to_owned(),
            exponent: exponent.to_string(),
        }));
    }

    /// The title, and what the marks mean.
    fn legend(&mut self, report: &Report) {
        let y = 58.0;
        let (start, size) = (Anchor::Start, Size::Normal);
        let place = (12.0, 28.0);
        let title = format!("Time to an error: {}", report.title);
        self.drawing.text(place, start, Size::Title, INK, &title);
        self.drawing.text((12.0, y), start, size, INK, "time");
        self.mark((LEFT + 10.0, y - 4.5), TOLERANCES, true);
        let place = (LEFT + 22.0, y);
        self.drawing
            .text(place, start, size, TOLERANCES, "marbles, by tolerance");
        self.mark((LEFT + 232.0, y - 4.5), SAMPLES, false);
        let place = (LEFT + 244.0, y);
        self.drawing
            .text(place, start, size, SAMPLES, "supersampling, points a pixel");
        if self.extrapolation.is_some() {
            let (from, to) = ((LEFT + 512.0, y - 4.5), (LEFT + 552.0, y - 4.5));
            self.dashes(from, to);
            let place = (LEFT + 560.0, y);
            self.drawing
                .text(place, start, size, SAMPLES, "extrapolated");
        }
    }

    fn mark(&mut self, center: Place, color: Color, round: bool) {
        self.drawing.shapes.push(if round {
            Shape::Disk {
                center,
                radius: MARK + 0.5,
                color,
            }
        } else {
            Shape::Square {
                center,
                side: 2.0 * MARK,
                color,
            }
        });
    }

    fn dashes(&mut self, from: Place, to: Place) {
        self.drawing.shapes.push(Shape::Line {
            places: vec![from, to],
            width: 2.0,
            color: SAMPLES,
            dashed: true,
        });
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
        self.dashes(from, end);
        self.room.avoid_line(from, end);
    }

    fn curves(&mut self) {
        for (rows, color, round) in [
            (self.samples.clone(), SAMPLES, false),
            (self.tolerances.clone(), TOLERANCES, true),
        ] {
            let places = rows.iter().map(|row| self.place(row.point())).collect();
            self.drawing.shapes.push(Shape::Line {
                places,
                width: 2.0,
                color,
                dashed: false,
            });
            for row in rows {
                self.mark(self.place(row.point()), color, round);
            }
        }
    }

    /// The settings beside their points: where the curves leave room as a rule, and on another side
    /// where points are close; none where there is no room at all.
    fn labels(&mut self) {
        const OF_SAMPLES: [Side; 5] = [
            Side::AboveLeft,
            Side::Above,
            Side::Left,
            Side::Right,
            Side::BelowRight,
        ];
        const OF_TOLERANCES: [Side; 5] = [
            Side::BelowRight,
            Side::Below,
            Side::Right,
            Side::Left,
            Side::Above,
        ];
        for rows in [&self.samples, &self.tolerances] {
            let places: Vec<Place> = rows.iter().map(|row| self.place(row.point())).collect();
            for &place in &places {
                self.room.avoid(place, MARK);
            }
            for pair in places.windows(2) {
                self.room.avoid_line(pair[0], pair[1]);
            }
        }
        let series: [(&[&Row], Color, &[Side]); 2] = [
            (&self.samples, SAMPLES, &OF_SAMPLES),
            (&self.tolerances, TOLERANCES, &OF_TOLERANCES),
        ];
        for (rows, color, sides) in series {
            for row in rows {
                let text = label(row.setting.method);
                let place = self.room.place(self.place(row.point()), &text, sides);
                if let Some((place, anchor)) = place {
                    self.drawing.text(place, anchor, Size::Small, color, &text);
                }
            }
        }
    }

    /// How far the curves are apart where that was measured and is most, or else where it is
    /// extrapolated and can be shown.
    fn distance(&mut self) {
        /// A smaller one needs no words.
        const LEAST: f64 = 1.5;
        let top = self.y.range().1;
        let candidates = self.tolerances.iter().filter_map(|row| {
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
        self.drawing.line(low, high, 1.25, SOFT_INK);
        for (tip, direction) in [(low, -1.0), (high, 1.0)] {
            for side in [-4.0, 4.0] {
                let end = (tip.0 + side, tip.1 + 6.0 * direction);
                self.drawing.line(tip, end, 1.25, SOFT_INK);
            }
        }
        let middle = (low.1 + high.1) / 2.0;
        let text = format!("{} times faster", factor(ratio));
        let (start, size) = (Anchor::Start, Size::Normal);
        self.drawing
            .text((low.0 + 10.0, middle), start, size, INK, &text);
        let place = (low.0 + 10.0, middle + 17.0);
        self.drawing
            .text(place, start, Size::Small, SOFT_INK, "at the same RMSE");
        self.room.avoid_line(low, high);
        let (left, right) = (low.0 + 10.0, low.0 + 10.0 + 8.5 * text.len() as f64);
        let (top, bottom) = (middle - 12.0, middle + 20.0);
        self.room.avoid_box((left, top), (right, bottom));
    }
}

/// Where supersampling ends, and where it would reach the smallest error.
fn extrapolation(report: &Report, smallest: f64) -> Option<[Point; 2]> {
    let curve = supersampling(&report.measurement.settings);
    let time = curve.time(smallest)?;
    let end = Point {
        rmse: smallest,
        seconds: time.seconds,
    };
    time.extrapolated.then_some([curve.end()?, end])
}

/// A power of ten in seconds, where it has a name.
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
