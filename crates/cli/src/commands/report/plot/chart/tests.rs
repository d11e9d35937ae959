use super::*;
use crate::commands::report::results::tests::report;

fn texts(drawing: Drawing) -> Vec<String> {
    let text = |shape| match shape {
        Shape::Text(text) => Some(text.text),
        _ => None,
    };
    drawing.shapes.into_iter().filter_map(text).collect()
}

#[test]
fn settings_and_distance_are_labeled() {
    let texts = texts(draw(&report()));
    for expected in [
        "1e-1",
        "1e-2",
        "1",
        "2×2",
        "10 s",
        "100 times faster",
        "extrapolated",
    ] {
        assert!(
            texts.contains(&expected.to_owned()),
            "no {expected} in {texts:?}"
        );
    }
}

#[test]
fn nothing_leaves_the_picture() {
    let mut report = report();
    // So far beyond the samples that the extrapolation leaves the axes.
    report.measurement.settings[1].accuracy.rmse = 1e-12;
    report.rows = Row::all(&report.measurement.settings);
    let inside = |(x, y): Place| {
        assert!(
            (0.0..=WIDTH).contains(&x) && (0.0..=HEIGHT).contains(&y),
            "{x}, {y}"
        );
    };
    for shape in draw(&report).shapes {
        match shape {
            Shape::Line { places, .. } => places.into_iter().for_each(inside),
            Shape::Disk { center, .. } | Shape::Square { center, .. } => inside(center),
            Shape::Text(text) => inside(text.place),
        }
    }
}

#[test]
fn times_have_names() {
    let names = [-7, -6, -3, 0, 3, 4].map(time);
    let expected = [
        None,
        Some("1 µs"),
        Some("1 ms"),
        Some("1 s"),
        Some("1000 s"),
        None,
    ];
    assert_eq!(names, expected);
}
