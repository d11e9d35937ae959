//! The numbers of a report as CSV (RFC 4180, with line feeds at the ends of lines).

use marbles_core::{Evidence, Method, Summary, Work};

use super::results::Report;
use super::row::Row;

const COLUMNS: [&str; 25] = [
    "scene",
    "frame",
    "width",
    "height",
    "threads",
    "method",
    "tolerance",
    "samples_a_side",
    "runs",
    "seconds",
    "speed_up",
    "speed_up_is_extrapolated",
    "rmse",
    "largest_error",
    "pixels_measured",
    "pixels_over_tolerance",
    "pixels_not_met",
    "largest_claimed",
    "evidence",
    "pixels_bound",
    "median_true_over_claimed",
    "largest_true_over_claimed",
    "samples_per_pixel",
    "lines_per_pixel",
    "candidate_tests_per_pixel",
];

/// Cells of a line, each with its column.
type Cells = Vec<(&'static str, String)>;

/// The file: a line of titles, one for the reference, and one for every setting.
///
/// Cells without a value are empty. Numbers have all their digits.
pub(super) fn bytes(report: &Report) -> Vec<u8> {
    let mut text = COLUMNS.join(",") + "\n";
    let settings = report.rows.iter().map(|row| setting(row, report));
    for cells in [reference(report)].into_iter().chain(settings) {
        let cell = |column: &&str| cells.iter().find(|(name, _)| name == column);
        let cells = COLUMNS.iter().map(cell);
        let cells = cells.map(|cell| cell.map_or(String::new(), |(_, cell)| quoted(cell)));
        text.push_str(&cells.collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text.into_bytes()
}

/// The cells of any picture.
fn picture(report: &Report, summary: &Summary, work: &Work) -> Cells {
    let view = &report.view;
    let a_pixel = |count: u64| number(count as f64 / summary.pixels as f64);
    let evidence = match summary.evidence() {
        Evidence::Bound => "bound",
        Evidence::Estimate => "estimate",
    };
    vec![
        ("scene", report.scene.clone()),
        ("frame", view.frame.to_string()),
        ("width", view.width.to_string()),
        ("height", view.height.to_string()),
        ("threads", report.threads.to_string()),
        ("pixels_measured", report.reference().known.to_string()),
        ("evidence", evidence.to_owned()),
        ("pixels_bound", summary.bounds.to_string()),
        ("samples_per_pixel", a_pixel(work.samples)),
        ("lines_per_pixel", a_pixel(work.lines)),
        ("candidate_tests_per_pixel", a_pixel(work.candidate_tests)),
    ]
}

/// The error of the reference cannot be measured.
fn reference(report: &Report) -> Cells {
    let reference = report.reference();
    let (summary, work) = (reference.image.summary(), reference.image.work());
    let mut cells = picture(report, &summary, &work);
    cells.extend([
        ("method", "reference".to_owned()),
        ("tolerance", number(reference.tolerance)),
        ("runs", 1.to_string()),
        ("seconds", number(reference.time.as_secs_f64())),
        ("pixels_not_met", summary.over_tolerance.to_string()),
        ("largest_claimed", number(summary.largest_error)),
    ]);
    cells
}

fn setting(row: &Row, report: &Report) -> Cells {
    let setting = &row.setting;
    let (accuracy, summary) = (&setting.accuracy, &setting.summary);
    let mut cells = picture(report, summary, &setting.work);
    cells.extend([
        ("runs", setting.times.len().to_string()),
        ("seconds", number(row.seconds)),
        ("rmse", number(accuracy.rmse)),
        ("largest_error", number(accuracy.largest)),
        ("largest_claimed", number(accuracy.largest_claimed)),
    ]);
    match setting.method {
        Method::Tolerance(tolerance) => cells.extend([
            ("method", "tolerance".to_owned()),
            ("tolerance", number(tolerance)),
            ("pixels_over_tolerance", accuracy.over.to_string()),
            ("pixels_not_met", summary.over_tolerance.to_string()),
        ]),
        Method::Samples(sides) => cells.extend([
            ("method", "samples".to_owned()),
            ("samples_a_side", sides.to_string()),
        ]),
    }
    if let Some((ratio, beyond)) = row.speed_up() {
        cells.push(("speed_up", number(ratio)));
        cells.push(("speed_up_is_extrapolated", beyond.to_string()));
    }
    for (column, ratio) in [
        ("median_true_over_claimed", accuracy.median_of_claimed),
        ("largest_true_over_claimed", accuracy.largest_of_claimed()),
    ] {
        cells.extend(ratio.map(|ratio| (column, number(ratio))));
    }
    cells
}

/// A number in a form that every program reads.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e9).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A cell, quoted if necessary.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

#[cfg(test)]
mod tests;
