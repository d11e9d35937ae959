//! Tests of `table.rs`.

use super::*;
use crate::commands::report::tests::report;

#[test]
fn tables_are_aligned() {
    let row = |cells: [&str; 3]| cells.map(str::to_owned);
    let rows = [
        row(["setting", "t", "x"]),
        row(["a", "1.0 µs", "10"]),
        row(["longer name", "2", ""]),
    ];
    let lines = markdown(&rows, None);
    let expected = [
        "| setting     |      t |  x |",
        "|-------------|-------:|---:|",
        "| a           | 1.0 µs | 10 |",
        "| longer name |      2 |    |",
    ];
    assert_eq!(lines, expected);
    assert_eq!(markdown(&rows, Some(29)), expected);
    let narrow = [
        "| setting     |      t |",
        "|-------------|-------:|",
        "| a           | 1.0 µs |",
        "| longer name |      2 |",
        "",
        "| setting     |  x |",
        "|-------------|---:|",
        "| a           | 10 |",
        "| longer name |    |",
    ];
    assert_eq!(markdown(&rows, Some(28)), narrow);
    assert_eq!(markdown(&rows, Some(9)), narrow);
}

#[test]
fn marks_are_explained_and_nothing_else() {
    let text = lines(&report(), None).join("\n");
    assert!(text.contains(" 5000 * |"), "{text}");
    assert!(text.contains("\n* extrapolated: the time of supersampling grows as RMSE^-1.00 at"));
    assert!(text.contains("times       median of 1 run; there was no time for 5\n"));
    assert!(!text.contains('?'), "{text}");
    let table = text.lines().filter(|line| line.starts_with('|'));
    let columns: Vec<usize> = table.map(|line| line.matches('|').count()).collect();
    assert_eq!(columns, [TITLES.len() + 1; 6]);
}
