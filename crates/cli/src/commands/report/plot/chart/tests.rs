use super::*;
use crate::commands::report::tests::report;

/// The elements of a well-formed document, each with its attributes; panics on any other.
fn elements(document: &str) -> Vec<String> {
    let (mut open, mut found) = (Vec::new(), Vec::new());
    let mut rest = document;
    while let Some(start) = rest.find('<') {
        let between = &rest[..start];
        assert!(!between.contains('>'), "{between}");
        assert!(!open.is_empty() || between.trim().is_empty(), "{between}");
        for entity in between.split('&').skip(1) {
            let known = ["amp;", "lt;", "gt;", "quot;", "apos;"];
            assert!(
                known.iter().any(|name| entity.starts_with(name)),
                "{entity}"
            );
        }
        let end = rest.find('>').expect("an end of the tag");
        let tag = &rest[start + 1..end];
        assert!(
            !tag.contains('<') && tag.matches('"').count().is_multiple_of(2),
            "{tag}"
        );
        let name = |tag: &str| tag.split([' ', '/']).next().unwrap_or_default().to_owned();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(closed));
        } else {
            found.push(tag.to_owned());
            if !tag.ends_with('/') {
                open.push(name(tag));
            }
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty() && rest.trim().is_empty());
    found
}

/// The numbers in an attribute of an element, if it has this attribute.
fn numbers(element: &str, attribute: &str) -> Vec<f64> {
    let value = element.split_once(&format!(" {attribute}=\""));
    let value = value.and_then(|(_, rest)| rest.split_once('"'));
    let numbers = value.map_or("", |(value, _)| value).split([',', ' ']);
    numbers
        .filter(|number| !number.is_empty())
        .map(|number| number.parse().unwrap())
        .collect()
}

#[test]
fn documents_are_well_formed() {
    let mut report = report();
    report.title = "a < b & \"c\" > 'd'\u{1}, \n".to_owned();
    let document = draw(&report);
    let elements = elements(&document);
    assert!(elements[0].starts_with("svg xmlns="));
    let count = |name: &str| {
        let of_name = |tag: &&String| tag.split(' ').next() == Some(name);
        elements.iter().filter(of_name).count()
    };
    // Two points and the mark of the legend; two points, the mark and the background.
    assert_eq!((count("circle"), count("rect")), (3, 4));
    assert!(count("text") > 20 && count("tspan") >= 5 && count("polyline") > 20);
    assert!(document.contains("a &lt; b &amp; &quot;c&quot; &gt; &apos;d&apos;\u{fffd},  <"));
}

#[test]
fn settings_and_distance_are_labeled() {
    let document = draw(&report());
    for expected in [
        "1e-1",
        "1e-2",
        "1",
        "2×2",
        "10 s",
        "100 times faster",
        "extrapolated",
    ] {
        let text = format!(">{expected}</text>");
        assert!(document.contains(&text), "no {expected} in {document}");
    }
}

#[test]
fn nothing_leaves_the_picture() {
    let mut report = report();
    // So far beyond the samples that the extrapolation leaves the axes.
    report.measurement.settings[1].accuracy.rmse = 1e-12;
    report.rows = Row::all(&report.measurement.settings);
    let mut seen = 0;
    for element in elements(&draw(&report)) {
        let points = numbers(&element, "points");
        let across = points.iter().step_by(2).copied();
        let down = points.iter().skip(1).step_by(2).copied();
        let of = |names: [&str; 2]| names.map(|name| numbers(&element, name)).concat();
        for x in across.chain(of(["x", "cx"])) {
            assert!((0.0..=WIDTH).contains(&x), "{element}");
            seen += 1;
        }
        for y in down.chain(of(["y", "cy"])) {
            assert!((0.0..=HEIGHT).contains(&y), "{element}");
            seen += 1;
        }
    }
    assert!(seen > 200);
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
