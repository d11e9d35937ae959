//! Arrays and records.

use super::*;

#[test]
fn npy_is_read() {
    let flat = TWO.concat();
    let single: Vec<f32> = flat.iter().map(|x| *x as f32).collect();
    let columns: Vec<f64> = (0..4)
        .flat_map(|column| TWO.map(|row| row[column]))
        .collect();
    let header = |descr: &str, order: &str, shape: &str| {
        format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}   \n")
    };
    for bytes in [
        npy(&header("'<f8'", "False", "(2, 4)"), &doubles(&flat)),
        npy(&header("'<f8'", "True", "(2, 4)"), &doubles(&columns)),
    ] {
        assert_eq!(spheres(&scene("a.npy", bytes, "")), TWO);
    }
    let bytes = npy(&header("'<f4'", "False", "(2, 4)"), &floats(&single));
    for (found, expected) in spheres(&scene("a.npy", bytes, "")).iter().zip(TWO) {
        assert_eq!(*found, expected.map(|x| f64::from(x as f32)));
    }
    let three = npy(
        &header("'<f8'", "False", "(1, 3)"),
        &doubles(&[1.0, 2.0, 3.0]),
    );
    assert_eq!(
        spheres(&scene("a.npy", three, "radius: 4")),
        [[1.0, 2.0, 3.0, 4.0]]
    );
    let seven = [1.0, 2.0, 3.0, 4.0, 0.25, 0.5, 1.0];
    let seven = scene(
        "a.npy",
        npy(&header("'<f8'", "False", "(1, 7)"), &doubles(&seven)),
        "",
    );
    assert_eq!(albedos(&seven), [Color::new(0.25, 0.5, 1.0)]);
    let five = [0.0, 0.0, 0.0, 1.0, 10.0, 0.0, 0.0, 0.0, 1.0, 20.0];
    let five = npy(&header("'<f8'", "False", "(2, 5)"), &doubles(&five));
    let five = scene("a.npy", five, "colormap: Grey");
    assert_eq!(albedos(&five), [Color::ZERO, Color::ONE]);
}

#[test]
fn npy_of_records_is_read() {
    let header = "{'descr': [('name', '<U2'), ('pos', '<f4', (3,)), ('radius', '<f8'), \
                  ('rgb', '|u1', (3,)), ('element', '<i4')], 'fortran_order': False, 'shape': (1,)}";
    let mut row = vec![b'x'; 8];
    row.extend(floats(&[1.0, 2.0, 3.0]));
    row.extend(doubles(&[4.0]));
    row.extend([255, 0, 255]);
    row.extend(18_i32.to_le_bytes());
    let scene = scene("a.npy", npy(header, &row), "");
    assert_eq!(spheres(&scene), [[1.0, 2.0, 3.0, 4.0]]);
    assert_eq!(albedos(&scene), [Color::new(1.0, 0.0, 1.0)]);
    let argon = self::scene("a.npy", npy(header, &row), "color: Element");
    assert_eq!(albedos(&argon), [from_srgb(0x80d1e3)]);
    let header = header.replace("'radius'", "'charge'");
    let argon = self::scene("a.npy", npy(&header, &row), "");
    assert_eq!(spheres(&argon), [[1.0, 2.0, 3.0, 1.88]]);
    let at = row.len() - 4;
    // The radius of the last element is unknown, and there is none behind it.
    for number in [118, 119] {
        row[at] = number;
        let bytes = npy(&header, &row);
        let byte = bytes.len() - 4;
        let expected = format!(
            "a.npy: row 1, column 9, byte {byte}: expected elements with known radii and colors, found `{number}` (1 row)"
        );
        let scene = self::scene("a.npy", bytes, "");
        let told = warnings(&scene);
        assert!(told.starts_with(&expected), "{told}");
        assert_eq!(spheres(&scene)[0][3], 1.0);
    }
}

/// A header of a hundred bytes does not make the program look for 2⁶³ tables.
#[test]
fn npy_of_more_tables_than_the_file_has_is_refused() {
    let of_tables = |tables: u64| {
        let shape = format!("'shape': ({tables}, 2, 4)");
        let header = format!("{{'descr': '<f8', 'fortran_order': False, {shape}}}");
        npy(&header, &doubles(&TWO.concat()))
    };
    let whole = scene("a.npy", of_tables(1), "frames: All");
    assert!(whole.has_steps());
    for tables in [2, 1 << 63] {
        let expected =
            format!("a.npy: expected {tables} tables of 64 bytes, found the end of the file");
        assert_eq!(refusal("a.npy", of_tables(tables), "frames: All"), expected);
    }
}

#[test]
fn npy_is_refused() {
    let header = |descr: &str, shape: &str| {
        format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}")
    };
    let f8 = |shape: &str| header("'<f8'", shape);
    let cases = [
        (
            Vec::new(),
            "expected an NPY file, which starts with \\x93NUMPY, found ``",
        ),
        (
            b"PK\x03\x04".to_vec(),
            "expected an archive of arrays, found a damaged one: Missing end of central directory",
        ),
        (
            b"\x93NUMPY\x09\x00\x00\x00".to_vec(),
            "expected version 1, 2 or 3 of the format, found 9",
        ),
        (
            b"\x93NUMPY\x01\x00\xff\x00{}".to_vec(),
            "expected a header, found the end of the file",
        ),
        (
            b"\x93NUMPY\x02\x00\xff\xff\xff\xff{}".to_vec(),
            "expected a header of at most 1 MiB, found 4294967295 bytes",
        ),
        (
            npy("{'descr'", &[]),
            "expected a header that describes an array, found `{'descr'`",
        ),
        (
            npy("{}", &[]),
            "expected `descr`, `fortran_order` and `shape` in the header, found `{}`",
        ),
        (
            npy(&header("'>f8'", "(1, 3)"), &[]),
            "expected a column `radius`, or else `radius: …` in the scene, found `x`, `y`, `z`",
        ),
        (
            npy(&f8("(10, 2)"), &[]),
            "expected an array of shape (rows, 3), (rows, 4), (rows, 5), (rows, 7), or of more columns, found (10, 2)",
        ),
        (
            npy(&f8("(10,)"), &[]),
            "expected an array of shape (rows, 3), (rows, 4), (rows, 5), (rows, 7), or of more columns, found (10)",
        ),
        (
            npy(&f8("(3, 4)"), &[0; 95]),
            "expected 3 rows of 32 bytes, 96 bytes in all, found 95",
        ),
        (
            npy(&f8("(18446744073709551615, 4)"), &[0; 95]),
            "expected 18446744073709551615 rows of 32 bytes, 590295810358705651680 bytes in all, found 95",
        ),
        (
            npy(&f8("(1, 3)"), &[0; 24]),
            "expected a column `radius`, or else `radius: …` in the scene, found `x`, `y`, `z`",
        ),
        (
            npy(&header("[('x', '>q8')]", "(1,)"), &[]),
            "expected a type such as `<f8`, `>f4`, `<i4` or `|u1`, found `>q8`",
        ),
        (
            npy(&header("[('x', '<f8')]", "(1, 1)"), &[]),
            "expected records in an array of one dimension, found more",
        ),
        (
            npy(&header("[('x', '<f8')]", "(1,)"), &[0; 8]),
            "expected a column `y`, found `x`",
        ),
        (
            npy(
                &header(
                    "[('x', '<f8'), ('y', '<f8'), ('z', '|S5'), ('r', '<f8')]",
                    "(1,)",
                ),
                &[0; 29],
            ),
            "expected numbers in the column `z`, found something else",
        ),
        (
            npy(&header("[('x', '<f8', (1000000000000,))]", "(1,)"), &[0; 8]),
            "expected at most 1000 values in a field, found more in `x`",
        ),
        (
            npy(
                &header(
                    "[('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ('r', '<f8'), ('big', 'V99999999999999999999')]",
                    "(1,)",
                ),
                &[0; 8],
            ),
            "expected a type such as `<f8`, `>f4`, `<i4` or `|u1`, found `V99999999999999999999`",
        ),
    ];
    for (bytes, expected) in cases {
        assert_eq!(refusal("a.npy", bytes, ""), format!("a.npy: {expected}"));
    }
    let bytes = npy(
        &f8("(2, 4)"),
        &doubles(&[1.0, 2.0, 3.0, 4.0, 5.0, f64::NAN, 7.0, 8.0]),
    );
    let at = bytes.len() - 24;
    let expected =
        format!("a.npy: row 2, column 2, byte {at}: expected a finite number for `y`, found NaN");
    assert_eq!(refusal("a.npy", bytes, ""), expected);
    let header = f8("(2, 4)").replace("False", "True");
    let bytes = npy(
        &header,
        &doubles(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, -8.0]),
    );
    let at = bytes.len() - 8;
    let expected = format!(
        "a.npy: row 2, column 4, byte {at}: expected a radius greater than 0 for `radius`, found -8"
    );
    assert_eq!(refusal("a.npy", bytes, ""), expected);
}

#[test]
fn many_binary_rows_come_in_their_order() {
    let count = 100_000;
    let number = |row: usize, column: usize| (4 * row + column + 1) as f64;
    let by_row: Vec<f64> = (0..4 * count).map(|at| number(at / 4, at % 4)).collect();
    let by_column: Vec<f64> = (0..4 * count)
        .map(|at| number(at % count, at / count))
        .collect();
    for (order, numbers) in [("False", by_row), ("True", by_column)] {
        let header = format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': ({count}, 4)}}");
        let found = spheres(&scene("a.npy", npy(&header, &doubles(&numbers)), ""));
        assert_eq!(found.len(), count);
        for (row, sphere) in found.iter().enumerate() {
            assert_eq!(*sphere, [0, 1, 2, 3].map(|column| number(row, column)));
        }
    }
}

/// A header of any number of rows without bytes is no longer than others.
#[test]
fn rows_without_bytes_are_refused() {
    let constants = "columns: (x: Constant(0), y: Constant(0), z: Constant(0)), radius: 1";
    let header = |kind: &str, rows: u64| {
        format!("{{'descr': [('a', '{kind}')], 'fortran_order': False, 'shape': ({rows},)}}")
    };
    let many = 1_000_000_000_000_000;
    for kind in ["|S0", "<U0", "|V0"] {
        assert_eq!(
            refusal("a.npy", npy(&header(kind, many), b""), constants),
            "a.npy: expected rows of at least 1 byte, found 1000000000000000 of none"
        );
    }
    // No room is made for rows that may not be kept.
    let kept = format!("{constants}, keep: [(\"a\", Is(\"b\"))]");
    let message = refusal("a.npy", npy(&header("|S0", many), b""), &kept);
    assert!(
        message.ends_with("found 1000000000000000 of none"),
        "{message}"
    );
    let archive = formats::npz(&[("a", npy(&header("|S0", 1000), b""))]);
    assert_eq!(
        refusal("a.npz", archive, constants),
        "a.npz: expected rows of at least 1 byte, found 1000 of none"
    );
    for format in ["binary_little_endian", "binary_big_endian"] {
        let ply = format!("ply\nformat {format} 1.0\nelement vertex {many}\nend_header\n");
        assert_eq!(
            refusal("a.ply", ply, constants),
            "a.ply: expected vertices of at least 1 byte, found 1000000000000000 of none"
        );
    }
    let ply = format!("ply\nformat ascii 1.0\nelement vertex {many}\nend_header\n\n\n");
    assert!(refusal("a.ply", ply, constants).contains("found the end of the file"));
    let one = npy(&header("|S1", 2), b"ab");
    assert_eq!(spheres(&scene("a.npy", one, constants)).len(), 2);
}
