//! What the columns of a table hold.

use super::*;
use crate::ColumnContents::{self, Numbers, Other, Texts};

/// The columns of a table, by name.
fn columns(name: &str, bytes: &[u8], fields: &str) -> Vec<(String, ColumnContents)> {
    let folder = Folder::new();
    fs::write(folder.0.join(name), bytes).unwrap();
    let text = format!(
        "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(), clouds: [(file: {name:?}, {fields})])"
    );
    let scene = Scene::parse(&text, &folder.0.join("scene.ron")).unwrap();
    let columns = scene.columns(0).unwrap();
    columns
        .into_iter()
        .map(|column| (column.name, column.contents))
        .collect()
}

fn numbers(low: f64, high: f64, missing: usize) -> ColumnContents {
    Numbers {
        low,
        high,
        missing,
        are_times: false,
    }
}

fn texts(count: usize, examples: &[&str]) -> ColumnContents {
    let examples = examples.iter().map(|text| (*text).to_owned()).collect();
    Texts { count, examples }
}

#[test]
fn columns_hold_numbers_times_or_texts() {
    let table = b"x,y,z,r,mass,note,day,part\n0,1,2,1,inf,a,2020-01-01,1\n3,-4,5,1,2,7,2020-01-02,\n1,1,1,1,3,b,1970-01-01,3\n";
    let found = columns("a.csv", table, "");
    let (times, rest): (Vec<_>, Vec<_>) = found.into_iter().partition(|(name, _)| name == "day");
    let rest: Vec<ColumnContents> = rest.into_iter().map(|(_, contents)| contents).collect();
    let expected = [
        numbers(0.0, 3.0, 0),
        numbers(-4.0, 1.0, 0),
        numbers(1.0, 5.0, 0),
        numbers(1.0, 1.0, 0),
        // Only finite numbers are looked at as numbers.
        texts(3, &["inf", "2", "3"]),
        texts(3, &["a", "7", "b"]),
        numbers(1.0, 3.0, 1),
    ];
    assert_eq!(rest, expected);
    let Numbers {
        low,
        high,
        are_times: true,
        ..
    } = times[0].1
    else {
        panic!("{times:?}")
    };
    assert_eq!((low, high), (0.0, 1_577_923_200.0));
}

#[test]
fn columns_of_arrays_hold_numbers_texts_or_neither() {
    let header = "{'descr': [('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ('r', '<f8'), ('n', 'S2'), ('c', '<c16')], \
                  'fortran_order': False, 'shape': (2,)}";
    let mut records = Vec::new();
    for (row, name) in [
        ([1.0, f64::NAN, 3.0, 0.5], b"ab"),
        ([2.0, 7.0, 3.0, 0.5], b"cd"),
    ] {
        records.extend(doubles(&row));
        records.extend(name);
        records.extend([0; 16]);
    }
    let found = columns("a.npy", &npy(header, &records), "columns: (y: 0.0)");
    let found: Vec<ColumnContents> = found.into_iter().map(|(_, contents)| contents).collect();
    let expected = [
        numbers(1.0, 2.0, 0),
        numbers(7.0, 7.0, 1),
        numbers(3.0, 3.0, 0),
        numbers(0.5, 0.5, 0),
        texts(2, &["ab", "cd"]),
        Other,
    ];
    assert_eq!(found, expected);
}

#[test]
fn columns_of_a_table_with_faults_in_rows_that_are_not_kept_are_not_told() {
    let table = b"n,x,y,z,r\n1,1,2,3,0.5\n0,1\n";
    let found = columns("a.csv", table, "keep: [(\"n\", Is(1))]");
    assert_eq!(found.len(), 5);
    assert!(
        found.iter().all(|(_, contents)| *contents == Other),
        "{found:?}"
    );
}
