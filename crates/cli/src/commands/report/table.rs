//! The output of `marbles report`: facts, a table in Markdown that is readable as plain text, and notes.

use super::measure::name;
use super::results::Report;
use super::row::{Row, supersampling};
use crate::base::numbers::{bound, duration, factor, fraction};
use crate::sequence::messages;

/// Width of the column with the names of facts.
const NAMES: usize = 12;
const TITLES: [&str; 11] = [
    "setting",
    "time",
    "speed-up",
    "RMSE",
    "largest",
    "over",
    "true/claimed",
    "largest/claimed",
    "bound",
    "samples",
    "lines",
];

/// The mark after an extrapolated number.
const EXTRAPOLATED: &str = " *";
/// The mark after an RMSE that is no larger than the error of the reference may be.
const BELOW_REFERENCE: &str = " ?";

/// The lines of the output. With a limit, no table is wider than `columns` characters.
pub(super) fn lines(report: &Report, columns: Option<usize>) -> Vec<String> {
    let mut lines = facts(report);
    lines.push(String::new());
    let rows = report.rows.iter().map(|row| cells(row, report));
    let table = [TITLES.map(str::to_owned)].into_iter().chain(rows);
    lines.extend(markdown(&table.collect::<Vec<_>>(), columns));
    let notes = notes(report);
    if !notes.is_empty() {
        lines.push(String::new());
    }
    lines.extend(notes);
    lines
}

fn facts(report: &Report) -> Vec<String> {
    let reference = report.reference();
    let summary = reference.image.summary();
    let mut facts = vec![
        ("scene", report.title.clone()),
        (
            "reference",
            format!(
                "tolerance {:e}: {}, RMS {}, in {}",
                reference.tolerance,
                messages::claim(&summary),
                bound(reference.claimed_rms()),
                duration(reference.time.as_secs_f64())
            ),
        ),
    ];
    if !reference.is_complete() {
        let unknown = summary.pixels - reference.known;
        let text = format!(
            "{unknown} of {} pixels excluded: the reference is not accurate enough there",
            summary.pixels
        );
        facts.push(("", text));
    }
    let measurement = &report.measurement;
    let (runs, planned) = (measurement.runs(), measurement.runs_planned);
    let plural = if runs == 1 { "" } else { "s" };
    let mut text = format!("median of {runs} run{plural}");
    if runs < planned {
        text.push_str(&format!("; there was no time for {planned}"));
    }
    facts.push(("times", text));
    let lines = facts.into_iter();
    lines
        .map(|(name, text)| format!("{name:NAMES$}{text}"))
        .collect()
}

fn cells(row: &Row, report: &Report) -> [String; 11] {
    let setting = &row.setting;
    let (accuracy, work) = (&setting.accuracy, &setting.work);
    let nothing = || "-".to_owned();
    let pixels = setting.summary.pixels as f64;
    let a_pixel = |count: u64| match count {
        0 => nothing(),
        _ => factor(count as f64 / pixels),
    };
    let mut rmse = bound(accuracy.rmse);
    if is_below_reference(row, report) {
        rmse.push_str(BELOW_REFERENCE);
    }
    [
        name(setting.method),
        duration(row.seconds),
        row.speed_up().map_or_else(nothing, |(ratio, beyond)| {
            format!(
                "{}{}",
                factor(ratio),
                if beyond { EXTRAPOLATED } else { "" }
            )
        }),
        rmse,
        bound(accuracy.largest),
        match setting.tolerance() {
            Some(_) => accuracy.over.to_string(),
            None => nothing(),
        },
        accuracy.median_of_claimed.map_or_else(nothing, fraction),
        accuracy.largest_of_claimed().map_or_else(nothing, fraction),
        match setting.summary.bounds {
            0 => nothing(),
            _ => format!("{} %", messages::bound_percent(&setting.summary)),
        },
        a_pixel(work.samples),
        a_pixel(work.lines),
    ]
}

/// Returns whether an RMSE is no larger than the error of the reference may be.
fn is_below_reference(row: &Row, report: &Report) -> bool {
    row.setting.accuracy.rmse <= report.reference().claimed_rms()
}

fn notes(report: &Report) -> Vec<String> {
    let mut notes = Vec::new();
    let rows = &report.rows;
    let speed_ups = rows.iter().filter_map(Row::speed_up);
    if speed_ups.into_iter().any(|(_, beyond)| beyond)
        && let Some(slope) = supersampling(&report.measurement.settings).slope()
    {
        notes.push(format!(
            "* extrapolated: the time of supersampling grows as RMSE^{slope:.2} at the end of its curve"
        ));
    }
    if rows.iter().any(|row| is_below_reference(row, report)) {
        notes.push(
            "? not known exactly: the error of the reference may be just as large".to_owned(),
        );
    }
    for row in rows {
        let not_met = row.setting.summary.over_tolerance;
        if not_met > 0 {
            let name = name(row.setting.method);
            let pixels = if not_met == 1 { "pixel" } else { "pixels" };
            notes.push(format!(
                "{name}: {not_met} {pixels} reported as over the tolerance"
            ));
        }
    }
    notes
}

/// The lines of a table in Markdown, whose first row contains the titles.
///
/// The first column is aligned to the left, the others to the right; a column is as wide as its widest cell. A table wider than the
/// limit becomes several tables, each with the first column.
fn markdown<const N: usize>(rows: &[[String; N]], limit: Option<usize>) -> Vec<String> {
    let mut widths = [0; N];
    for row in rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = (*width).max(cell.chars().count());
        }
    }
    let mut lines = Vec::new();
    let mut next = 1;
    while next < N {
        let mut columns = vec![0];
        let mut width = 4 + widths[0];
        while next < N {
            width += 3 + widths[next];
            if columns.len() > 1 && limit.is_some_and(|limit| width > limit) {
                break;
            }
            columns.push(next);
            next += 1;
        }
        if !lines.is_empty() {
            lines.push(String::new());
        }
        lines.extend(table(rows, &columns, &widths));
    }
    lines
}

/// The lines of a table of some of the columns.
fn table<const N: usize>(
    rows: &[[String; N]],
    columns: &[usize],
    widths: &[usize; N],
) -> Vec<String> {
    let line = |row: &[String; N]| {
        let cells = columns.iter().map(|&column| {
            let (cell, width) = (&row[column], widths[column]);
            match column {
                0 => format!("| {cell:<width$} |"),
                _ => format!(" {cell:>width$} |"),
            }
        });
        cells.collect::<String>()
    };
    let rule = columns.iter().map(|&column| match column {
        0 => format!("|{}|", "-".repeat(widths[0] + 2)),
        _ => format!("{}:|", "-".repeat(widths[column] + 1)),
    });
    let mut lines: Vec<String> = rows.iter().map(line).collect();
    lines.insert(1, rule.collect());
    lines
}

#[cfg(test)]
mod tests;
