//! Tests of `csv.rs`.

use super::*;
use crate::commands::report::tests::report;

#[test]
fn cells_are_quoted_where_they_must_be() {
    assert_eq!(quoted("a b.ron"), "a b.ron");
    assert_eq!(quoted("a,b"), "\"a,b\"");
    assert_eq!(quoted("5\" ball"), "\"5\"\" ball\"");
    assert_eq!(quoted("two\nlines"), "\"two\nlines\"");
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
    let columns = COLUMNS.len();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 6);
    assert_eq!(lines[0], COLUMNS.join(","));
    for line in &lines[1..] {
        let cells: Vec<&str> = line
            .strip_prefix("\"ball, red.ron\",")
            .unwrap()
            .split(',')
            .collect();
        assert_eq!(cells.len() + 1, columns, "{line}");
    }
    // Every cell has a column.
    for cells in [reference(&report()), setting(&report().rows[0], &report())] {
        assert!(cells.iter().all(|(name, _)| COLUMNS.contains(name)));
    }
    assert!(lines[1].contains(",reference,"));
    assert!(lines[3].contains(",tolerance,0.01,,1,4,"), "{}", lines[3]);
    assert!(
        lines[5].contains(",samples,,2,1,2000,1,false,0.001,"),
        "{}",
        lines[5]
    );
}
