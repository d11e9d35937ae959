//! `--legend`: a drawing that explains the colors of a picture.

use std::path::Path;

use glam::DVec3;
use marbles_core::Color;
use marbles_scene::{
    CloudDescription, ColorDescription, ColorMeaning, ScaleKind, Scene, written_time,
};

use super::svg::{Anchor, Style, Svg};
use crate::base::failure::Failure;
use crate::base::numbers::short;
use crate::base::shown::Shown;
use marbles_core::srgb;

/// The width of the drawing, and its margin, in pixels.
const WIDTH: f64 = 340.0;
const MARGIN: f64 = 16.0;
/// The size of a color scale, with one pixel for each color of a colormap.
const SCALE: (f64, f64) = (256.0, 18.0);
const LINE: f64 = 20.0;
/// The space between the parts of different tables.
const GAP: f64 = 14.0;
/// The largest number of listed categories.
const MOST_CATEGORIES: usize = 40;
/// The approximate width of a digit in labels.
const DIGIT: f64 = 7.0;

const PLAIN: Style = Style {
    anchor: Anchor::Start,
    size: 13.0,
    is_bold: false,
    color: "#000000",
};

/// Draws the legend of a scene.
///
/// # Errors
/// Refuses scenes whose colors have no meaning.
pub(super) fn draw(scene: &Scene, path: &Path) -> Result<String, Failure> {
    let colors = |cloud: &CloudDescription| Some((cloud.file.shown(), cloud.colors.clone()?));
    let all: Vec<(String, ColorDescription)> = scene.clouds().iter().filter_map(colors).collect();
    if all.is_empty() {
        let why = "--legend: no cloud is colored by a column: choose one with `value: …`";
        return Err(Failure::unusable(path, why));
    }
    let whole: f64 = all
        .iter()
        .map(|(_, colors)| height(&colors.meaning) + GAP)
        .sum();
    let mut svg = Svg::new(WIDTH, whole - GAP + 2.0 * MARGIN, "Legend");
    let mut top = MARGIN;
    for (file, colors) in &all {
        let bold = Style {
            is_bold: true,
            ..PLAIN
        };
        svg.text((MARGIN, top + 13.0), bold, &title(colors, file));
        match &colors.meaning {
            ColorMeaning::Scale {
                low,
                high,
                kind,
                colors,
                are_times,
            } => {
                let label = |number| match are_times {
                    true => time(number, high - low),
                    false => short(number),
                };
                draw_scale(&mut svg, top + LINE, (*low, *high), *kind, colors, &label);
            }
            ColorMeaning::Categories(categories) => {
                draw_categories(&mut svg, top + LINE, categories);
            }
        }
        top += height(&colors.meaning) + GAP;
    }
    Ok(svg.finish())
}

/// The name of the column with its unit, or else of the table.
fn title(colors: &ColorDescription, file: &str) -> String {
    match &colors.column {
        Some(column) => column.clone(),
        None => format!("length of a vector, {file}"),
    }
}

fn height(meaning: &ColorMeaning) -> f64 {
    match meaning {
        ColorMeaning::Scale { .. } => LINE + SCALE.1 + LINE,
        ColorMeaning::Categories(categories) => {
            let more = usize::from(categories.len() > MOST_CATEGORIES);
            LINE * (1 + categories.len().min(MOST_CATEGORIES) + more) as f64
        }
    }
}

fn draw_scale(
    svg: &mut Svg,
    top: f64,
    (low, high): (f64, f64),
    kind: ScaleKind,
    colors: &[Color],
    label: &dyn Fn(f64) -> String,
) {
    let (width, height) = SCALE;
    let step = width / colors.len().max(1) as f64;
    for (index, color) in colors.iter().enumerate() {
        let left = MARGIN + step * index as f64;
        svg.rectangle((left, top), (step, height), &hexadecimal(*color));
    }
    let mut taken = f64::NEG_INFINITY;
    for number in marks(low, high, kind) {
        let at = MARGIN + width * place(number, low, high, kind);
        let label = label(number);
        let half = 0.5 * DIGIT * label.len() as f64;
        if at - half < taken {
            continue;
        }
        taken = at + half + DIGIT;
        svg.line(
            &[(at, top + height), (at, top + height + 4.0)],
            1.0,
            "#000000",
        );
        let style = Style {
            anchor: Anchor::Middle,
            size: 12.0,
            ..PLAIN
        };
        svg.text((at, top + height + 16.0), style, &label);
    }
}

fn draw_categories(svg: &mut Svg, top: f64, categories: &[(String, Color)]) {
    for (index, (name, color)) in categories.iter().take(MOST_CATEGORIES).enumerate() {
        let line = top + LINE * index as f64;
        svg.rectangle((MARGIN, line), (14.0, 14.0), &hexadecimal(*color));
        svg.text((MARGIN + 22.0, line + 12.0), PLAIN, name);
    }
    if let Some(more) = categories
        .len()
        .checked_sub(MOST_CATEGORIES)
        .filter(|more| *more > 0)
    {
        let line = top + LINE * MOST_CATEGORIES as f64;
        svg.text(
            (MARGIN + 22.0, line + 12.0),
            PLAIN,
            &format!("and {more} more"),
        );
    }
}

/// A label for a time on a scale that covers some seconds: the date, or the time of day if the scale covers less than
/// two days.
fn time(seconds: f64, length: f64) -> String {
    const TWO_DAYS: f64 = 172_800.0;
    let text = written_time(seconds);
    let parts = text.split_once(' ');
    let (date, time) = parts.map_or((&*text, "00:00:00"), |parts| parts);
    let shown = if length >= TWO_DAYS { date } else { time };
    shown.to_owned()
}

/// The position of a number on a scale, from 0 to 1.
fn place(number: f64, low: f64, high: f64, kind: ScaleKind) -> f64 {
    if low == high {
        return 0.5;
    }
    match kind {
        ScaleKind::Log => libm::log(number / low) / libm::log(high / low),
        ScaleKind::Linear | ScaleKind::Diverging(_) => (number - low) / (high - low),
    }
}

/// The labels of a scale: round numbers within its range, or its ends.
fn marks(low: f64, high: f64, kind: ScaleKind) -> Vec<f64> {
    if low == high {
        return vec![low];
    }
    let marks: Vec<f64> = match kind {
        ScaleKind::Log => {
            let decades =
                libm::floor(libm::log10(low)) as i32..=libm::ceil(libm::log10(high)) as i32;
            let is_long = libm::log10(high / low) >= 3.0;
            let multiples: &[f64] = if is_long { &[1.0] } else { &[1.0, 2.0, 5.0] };
            let numbers = decades.flat_map(|decade| {
                let power = libm::pow(10.0, f64::from(decade));
                multiples.iter().map(move |multiple| multiple * power)
            });
            numbers
                .filter(|number| (low..=high).contains(number))
                .collect()
        }
        ScaleKind::Linear | ScaleKind::Diverging(_) => {
            let step = round_step((high - low) / 4.0);
            let first = libm::ceil(low / step) as i64;
            let last = libm::floor(high / step) as i64;
            // Of numbers far from 0 beside their range there may be none, or very many by rounding.
            let numbers = (first..=last).take(12).map(|index| index as f64 * step);
            numbers
                .filter(|number| (low..=high).contains(number))
                .collect()
        }
    };
    if marks.len() < 2 {
        vec![low, high]
    } else {
        marks
    }
}

/// The largest product of 1, 2 or 5 and a power of ten that is not above a number.
pub(super) fn round_step(number: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(number)));
    let multiple = [5.0, 2.0]
        .into_iter()
        .find(|multiple| multiple * power <= number);
    multiple.unwrap_or(1.0) * power
}

/// A color in the syntax of SVG.
fn hexadecimal(color: DVec3) -> String {
    let [red, green, blue] = color.to_array().map(srgb::encode_8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_numbers_between_the_ends() {
        let linear = ScaleKind::Linear;
        assert_eq!(marks(0.0, 40.0, linear), [0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!(marks(-3.0, 5.0, linear), [-2.0, 0.0, 2.0, 4.0]);
        assert_eq!(
            marks(1.0, 1000.0, ScaleKind::Log),
            [1.0, 10.0, 100.0, 1000.0]
        );
        assert_eq!(marks(3.0, 60.0, ScaleKind::Log), [5.0, 10.0, 20.0, 50.0]);
        assert_eq!(marks(7.0, 7.0, linear), [7.0]);
        assert_eq!(marks(7.1, 7.9, ScaleKind::Log), [7.1, 7.9]);
        assert_eq!(place(100.0, 1.0, 1e4, ScaleKind::Log), 0.5);
        assert_eq!(round_step(0.0399), 0.02);
        assert_eq!(round_step(1.0), 1.0);
    }
}
