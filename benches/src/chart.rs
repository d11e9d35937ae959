//! A drawing of the times of a few settings as SVG: panels next to each other, with logarithmic scales.

use std::fmt::Write;

const HEIGHT: f64 = 440.0;
const TOP: f64 = 84.0;
const BOTTOM: f64 = 384.0;
/// The distance from the left edge of a panel to its scale.
const MARGIN: f64 = 66.0;
/// The approximate width of a letter.
const LETTER: f64 = 7.0;
const INK: &str = "#222830";
const GRID: &str = "#e3e7ec";
const DASHED: &str = "#98a2ae";
/// Colors that people with any kind of color vision can distinguish: the darker ones of Okabe and Ito.
const COLORS: [&str; 5] = ["#5a6470", "#0072b2", "#56b4e9", "#d55e00", "#e69f00"];

type Place = (f64, f64);

/// A scale on which a quantity grows by the same factor from step to step, and the times for it.
pub struct Panel {
    /// The title above the scale.
    pub title: String,
    /// The names of the steps.
    pub steps: Vec<String>,
    /// The factor from one step to the next.
    pub factor: f64,
    /// The width of the scale, in pixels.
    pub width: f64,
    /// The seconds at each step, for each name in the drawing; empty if there is no such line.
    pub times: Vec<Vec<f64>>,
}

/// The text of the file. A dashed line shows proportional growth.
pub fn svg(names: &[&str], panels: &[Panel]) -> String {
    let width: f64 = panels.iter().map(|panel| MARGIN + panel.width + 30.0).sum();
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{HEIGHT}\" \
         viewBox=\"0 0 {width} {HEIGHT}\" font-family=\"system-ui, Arial, sans-serif\" \
         font-size=\"13\" role=\"img\">\n\
         <rect width=\"{width}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n"
    );
    let decades = decades(panels);
    let mut left = 0.0;
    for panel in panels {
        svg.push_str(&panel.draw(left + MARGIN, decades));
        left += MARGIN + panel.width + 30.0;
    }
    let mut x = 12.0;
    let dashed = ("in proportion", DASHED);
    let named = names.iter().copied().zip(COLORS);
    for (name, color) in named.chain([dashed]) {
        line(&mut svg, &[(x, 424.0), (x + 22.0, 424.0)], color);
        text(&mut svg, (x + 28.0, 428.0), "start", name);
        x += 50.0 + LETTER * name.chars().count() as f64;
    }
    svg + "</svg>\n"
}

/// The powers of ten that enclose all times.
fn decades(panels: &[Panel]) -> (i32, i32) {
    let all = || panels.iter().flat_map(|panel| panel.times.iter().flatten());
    let least = all().copied().fold(f64::INFINITY, f64::min);
    let most = all().copied().fold(0.0, f64::max);
    (least.log10().floor() as i32, most.log10().ceil() as i32)
}

impl Panel {
    fn draw(&self, left: f64, (low, high): (i32, i32)) -> String {
        let height = |seconds: f64| {
            let share = (seconds.log10() - f64::from(low)) / f64::from(high - low);
            BOTTOM + share * (TOP - BOTTOM)
        };
        let inset = 24.0;
        let gaps = (self.steps.len() - 1) as f64;
        let across = |step: f64| left + inset + step * (self.width - 2.0 * inset) / gaps;
        let mut svg = String::new();
        text(&mut svg, (left, 40.0), "start", &self.title);
        for decade in low..=high {
            let y = height(10_f64.powi(decade));
            line(&mut svg, &[(left, y), (left + self.width, y)], GRID);
            text(&mut svg, (left - 8.0, y + 4.5), "end", &time(decade));
        }
        for (index, step) in self.steps.iter().enumerate() {
            text(
                &mut svg,
                (across(index as f64), BOTTOM + 20.0),
                "middle",
                step,
            );
        }
        // What is a little above the lowest time at the first step, until it leaves the panel.
        let first = 10_f64.powf(f64::from(low) + 0.3);
        let last = ((f64::from(high - low) - 0.3) / self.factor.log10()).min(gaps);
        let ends = [0.0, last].map(|at| (across(at), height(first * self.factor.powf(at))));
        line(&mut svg, &ends, DASHED);
        for (times, color) in self.times.iter().zip(COLORS) {
            let place = |(step, &seconds): (usize, &f64)| (across(step as f64), height(seconds));
            let places: Vec<Place> = times.iter().enumerate().map(place).collect();
            line(&mut svg, &places, color);
            for (x, y) in places {
                let circle =
                    format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{color}\"/>\n");
                svg.push_str(&circle);
            }
        }
        svg
    }
}

fn line(svg: &mut String, places: &[Place], color: &str) {
    let dashes = if color == DASHED {
        " stroke-dasharray=\"5 4\""
    } else {
        ""
    };
    let point = |(x, y): &Place| format!("{x:.1},{y:.1}");
    let points: Vec<String> = places.iter().map(point).collect();
    // Writing into a string cannot fail.
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"{dashes}/>",
        points.join(" ")
    );
}

fn text(svg: &mut String, (x, y): Place, anchor: &str, text: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{INK}\">{text}</text>"
    );
}

/// A power of ten in seconds.
fn time(decade: i32) -> String {
    if decade < 0 {
        format!("{} ms", 10_f64.powi(decade + 3))
    } else {
        format!("{} s", 10_f64.powi(decade))
    }
}
