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
const MOST_CATEGORIES: usize = 24;
/// The number of colors between which a gradient is linear: the steps of a colormap are far finer than those of a
/// screen.
const STOPS: usize = 33;
/// The width of the picture for which a drawing has the sizes above. For wider pictures it is larger.
const PICTURE_WIDTH: f64 = 640.0;
/// Smaller texts are not readable.
const LEAST_SCALE: f64 = 0.5;
/// The approximate width of a digit in labels.
const DIGIT: f64 = 7.0;

const PLAIN: Style = Style {
    anchor: Anchor::Start,
    size: 13.0,
    is_bold: false,
    color: "#000000",
};

/// The factor on the sizes of a drawing next to a picture of this width in pixels.
pub(super) fn scale_for(width: u32) -> f64 {
    (f64::from(width) / PICTURE_WIDTH).max(LEAST_SCALE)
}

/// Draws the legend of a scene, for a picture of this width.
///
/// # Errors
/// Refuses scenes whose colors have no meaning.
pub(super) fn draw(scene: &Scene, width: u32, path: &Path) -> Result<Svg, Failure> {
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
    let whole = whole - GAP + 2.0 * MARGIN;
    let mut svg = Svg::scaled(WIDTH, whole, scale_for(width), "Legend");
    let mut top = MARGIN;
    for (index, (file, colors)) in all.iter().enumerate() {
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
                draw_gradient(&mut svg, top + LINE, colors, index + 1);
                draw_marks(&mut svg, top + LINE, (*low, *high), *kind, &label);
            }
            ColorMeaning::Categories(categories) => {
                draw_categories(&mut svg, top + LINE, categories);
            }
        }
        top += height(&colors.meaning) + GAP;
    }
    Ok(svg)
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

fn draw_gradient(svg: &mut Svg, top: f64, colors: &[Color], number: usize) {
    let last = colors.len().saturating_sub(1);
    let stops = STOPS.min(colors.len());
    let color = |stop: usize| hexadecimal(colors[stop * last / stops.saturating_sub(1).max(1)]);
    let colors: Vec<String> = (0..stops).map(color).collect();
    svg.gradient((MARGIN, top), SCALE, &colors, &format!("colors-{number}"));
}

fn draw_marks(
    svg: &mut Svg,
    top: f64,
    (low, high): (f64, f64),
    kind: ScaleKind,
    label: &dyn Fn(f64) -> String,
) {
    let (width, height) = SCALE;
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
        svg.swatch((MARGIN, line), 14.0, &hexadecimal(*color));
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
            &match more {
                1 => "… and 1 other".to_owned(),
                _ => format!("… and {more} others"),
            },
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
    fn more_categories_than_can_be_read_are_counted() {
        let drawn = |count: usize| {
            let category = |index: usize| (format!("<{index}>"), Color::splat(0.5));
            let categories: Vec<(String, Color)> = (0..count).map(category).collect();
            let mut svg = Svg::new(1.0, 1.0, "");
            draw_categories(&mut svg, 0.0, &categories);
            svg.finish()
        };
        let all = drawn(24);
        assert_eq!(all.matches("<text").count(), 24);
        assert!(all.contains(">&lt;23&gt;<") && !all.contains("other"));
        assert!(drawn(25).contains(">… and 1 other<"));
        let most = drawn(300);
        assert_eq!(most.matches("<text").count(), 25);
        assert!(most.contains(">… and 276 others<"));
        // A swatch for each name, whose edge shows white on white.
        assert_eq!(most.matches("stroke=").count(), 24);
    }

    #[test]
    fn a_colormap_is_one_gradient() {
        let colors: Vec<Color> = (0..256)
            .map(|step| Color::splat(f64::from(step) / 255.0))
            .collect();
        let mut svg = Svg::new(1.0, 1.0, "");
        draw_gradient(&mut svg, 0.0, &colors, 3);
        let drawn = svg.finish();
        assert_eq!(drawn.matches("<linearGradient id=\"colors-3\">").count(), 1);
        assert_eq!(drawn.matches("fill=\"url(#colors-3)\"").count(), 1);
        assert_eq!(drawn.matches("<stop ").count(), STOPS);
        assert!(drawn.contains("<stop offset=\"0%\" stop-color=\"#000000\"/>"));
        assert!(drawn.contains("<stop offset=\"100%\" stop-color=\"#ffffff\"/>"));
        // 127 of 255 by the definition of sRGB: 187.4 of 255.
        assert!(drawn.contains("<stop offset=\"50%\" stop-color=\"#bbbbbb\"/>"));
    }

    #[test]
    fn drawings_grow_with_their_picture() {
        assert_eq!([640, 1280, 100].map(scale_for), [1.0, 2.0, 0.5]);
    }

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
