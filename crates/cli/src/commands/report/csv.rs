//! The numbers of a report as a table with commas (RFC 4180, lines ending in a line feed).

use marbles_core::{Evidence, Method};

use super::results::Report;
use super::row::Row;

const TITLES: &str = "scene,frame,width,height,threads,method,tolerance,samples_a_side,runs,\
seconds,speed_up,speed_up_is_extrapolated,rmse,largest_error,pixels_measured,pixels_over_tolerance,\
pixels_not_met,largest_claimed,evidence,median_true_over_claimed,largest_true_over_claimed,\
samples_per_pixel,lines_per_pixel,candidate_tests_per_pixel";

/// The file: a line of titles, one for the reference, and one for every setting.
///
/// What is unknown or has no meaning is empty. Numbers have all their digits.
pub(super) fn bytes(report: &Report) -> Vec<u8> {
    let mut text = format!("{TITLES}\n{}\n", line(&reference(report)));
    for row in &report.rows {
        text.push_str(&line(&cells(row, report)));
        text.push('\n');
    }
    text.into_bytes()
}

fn common(report: &Report) -> Vec<String> {
    let view = &report.view;
    let numbers = [view.width, view.height].map(|side| side.to_string());
    let mut cells = vec![report.scene.clone(), view.frame.to_string()];
    cells.extend(numbers);
    cells.push(report.threads.to_string());
    cells
}

/// The reference has no error that could be measured.
fn reference(report: &Report) -> Vec<String> {
    let reference = report.reference();
    let (summary, work) = (reference.image.summary(), reference.image.work());
    let a_pixel = |count: u64| number(count as f64 / summary.pixels as f64);
    let nothing = String::new;
    let mut cells = common(report);
    cells.extend([
        "reference".to_owned(),
        number(reference.tolerance),
        nothing(),
        1.to_string(),
        number(reference.time.as_secs_f64()),
        nothing(),
        nothing(),
        nothing(),
        nothing(),
        reference.known.to_string(),
        nothing(),
        summary.over_tolerance.to_string(),
        number(summary.largest_error),
        evidence(summary.evidence),
        nothing(),
        nothing(),
        a_pixel(work.samples),
        a_pixel(work.lines),
        a_pixel(work.candidate_tests),
    ]);
    cells
}

fn cells(row: &Row, report: &Report) -> Vec<String> {
    let setting = &row.setting;
    let (accuracy, summary, work) = (&setting.accuracy, &setting.summary, &setting.work);
    let nothing = String::new;
    let a_pixel = |count: u64| number(count as f64 / summary.pixels as f64);
    let is_tolerance = setting.tolerance().is_some();
    let if_tolerance = |count: u64| match is_tolerance {
        true => count.to_string(),
        false => nothing(),
    };
    let (method, tolerance, sides) = match setting.method {
        Method::Tolerance(tolerance) => ("tolerance", number(tolerance), nothing()),
        Method::Samples(sides) => ("samples", nothing(), sides.to_string()),
    };
    let speed_up = row.speed_up();
    let mut cells = common(report);
    cells.extend([
        method.to_owned(),
        tolerance,
        sides,
        setting.times.len().to_string(),
        number(row.seconds),
        speed_up.map_or_else(nothing, |(ratio, _)| number(ratio)),
        speed_up.map_or_else(nothing, |(_, beyond)| beyond.to_string()),
        number(accuracy.rmse),
        number(accuracy.largest),
        report.reference().known.to_string(),
        if_tolerance(accuracy.over),
        if_tolerance(summary.over_tolerance),
        number(accuracy.largest_claimed),
        evidence(summary.evidence),
        accuracy.median_of_claimed.map_or_else(nothing, number),
        accuracy.largest_of_claimed().map_or_else(nothing, number),
        a_pixel(work.samples),
        a_pixel(work.lines),
        a_pixel(work.candidate_tests),
    ]);
    cells
}

fn evidence(evidence: Evidence) -> String {
    match evidence {
        Evidence::Bound => "bound",
        Evidence::Estimate => "estimate",
    }
    .to_owned()
}

/// A number as every program reads it.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e9).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

fn line(cells: &[String]) -> String {
    let cells: Vec<String> = cells.iter().map(|cell| quoted(cell)).collect();
    cells.join(",")
}

/// A cell, between quotes where it needs them.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::report::results::tests::report;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        assert_eq!(quoted("a b.ron"), "a b.ron");
        assert_eq!(quoted("a,b"), "\"a,b\"");
        assert_eq!(quoted("5\" ball"), "\"5\"\" ball\"");
        assert_eq!(quoted("two\nlines"), "\"two\nlines\"");
        assert_eq!(line(&["a".into(), String::new(), "1".into()]), "a,,1");
    }

    #[test]
    fn numbers_come_back() {
        for value in [0.0, 1.0, 0.1, 1.0 / 3.0, 1e-9, 6.02e23, f64::INFINITY] {
            assert_eq!(number(value).parse(), Ok(value));
        }
    }

    #[test]
    fn every_line_has_every_cell() {
        let text = String::from_utf8(bytes(&report())).unwrap();
        let columns = TITLES.split(',').count();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 6);
        assert_eq!(lines[0], TITLES);
        for line in &lines[1..] {
            let cells: Vec<&str> = line
                .strip_prefix("\"ball, red.ron\",")
                .unwrap()
                .split(',')
                .collect();
            assert_eq!(cells.len() + 1, columns, "{line}");
        }
        assert!(lines[1].contains(",reference,"));
        assert!(lines[3].contains(",tolerance,0.01,,1,4,"), "{}", lines[3]);
        assert!(
            lines[5].contains(",samples,,2,1,2000,1,false,0.001,"),
            "{}",
            lines[5]
        );
    }
}
