//! Legacy VTK: what its numbers mean, and where they begin.

use super::compressed::gzip;
use super::*;

/// A file of so many points, the numbers `0 0 0`, in text or in bytes.
fn points(format: &str, count: usize, rest: &[u8]) -> Vec<u8> {
    let head = format!(
        "# vtk DataFile Version 3.0\np\n{format}\nDATASET POLYDATA\nPOINTS {count} float\n"
    );
    let numbers = match format {
        "ASCII" => b"0 0 0\n".repeat(count),
        _ => vec![0; 12 * count],
    };
    let data = format!("\nPOINT_DATA {count}\n");
    [head.as_bytes(), &numbers, data.as_bytes(), rest].concat()
}

/// Every code of a color, as a byte, as its digits, and as the fraction that VTK writes.
#[test]
fn colors_are_codes_in_text_and_in_bytes() {
    let codes = || (0..=255_u8).flat_map(|code| [code, 255 - code, 128]);
    let bytes: Vec<u8> = codes().collect();
    let digits: String = codes().map(|code| format!("{code}\n")).collect();
    let fractions = codes().map(|code| format!("{:.5} ", f64::from(code) / 255.0));
    let fractions = fractions.collect::<String>();
    let scalars = "SCALARS color unsigned_char 3\nLOOKUP_TABLE default\n";
    let color = "COLOR_SCALARS color 3\n";
    let expected: Vec<Color> = (0..=255)
        .map(|code| from_srgb(code << 16 | (255 - code) << 8 | 128))
        .map(|color| color.as_vec3().as_dvec3())
        .collect();
    for (format, head, numbers) in [
        ("BINARY", color, &bytes[..]),
        ("BINARY", scalars, &bytes),
        ("ASCII", color, fractions.as_bytes()),
        ("ASCII", scalars, digits.as_bytes()),
    ] {
        let file = points(format, 256, &[head.as_bytes(), numbers].concat());
        let scene = scene("a.vtk", file, "radius: 1");
        assert!(albedos(&scene) == expected, "{format}, {head}");
    }
    let linear = points("ASCII", 1, b"VECTORS color float\n0.25 0.5 1\n");
    let linear = scene("a.vtk", linear, "radius: 1");
    assert_eq!(albedos(&linear), [Color::new(0.25, 0.5, 1.0)]);
    for (rest, expected) in [
        (
            "COLOR_SCALARS color 3\n0.5 128 0\n",
            "a.vtk:10:5: expected a number from 0 to 1 for `COLOR_SCALARS`, found 128",
        ),
        (
            "SCALARS color unsigned_char 3\nLOOKUP_TABLE default\n1 256 3\n",
            "expected a whole number from 0 to 255 for `green`, found 256",
        ),
    ] {
        let message = refusal("a.vtk", points("ASCII", 1, rest.as_bytes()), "radius: 1");
        assert!(message.ends_with(expected), "{message}");
    }
}

#[test]
fn scalars_without_a_lookup_table_are_refused() {
    let head = b"SCALARS radius float 1\n";
    // The second number holds a line feed.
    let bytes = [[0x3f, 0x80, 0, 0], [0x40, b'\n', 0, 0], [0x40, 0, 0, 0]].concat();
    let behind = b"\nSCALARS b float 1\nLOOKUP_TABLE default\n";
    let all = [&head[..], &bytes, behind, &bytes].concat();
    let expected = "expected `LOOKUP_TABLE \u{2026}` on the line after `SCALARS \u{2026}`, found ";
    let message = refusal("a.vtk", points("BINARY", 3, &all), "");
    assert!(message.contains(expected), "{message}");
    assert_eq!(
        refusal(
            "a.vtk",
            points("ASCII", 2, &[&head[..], b"1\n2\n3\n"].concat()),
            ""
        ),
        format!("a.vtk:11:1: {expected}1")
    );
    for format in ["BINARY", "ASCII"] {
        assert_eq!(
            refusal("a.vtk", points(format, 0, head), "")
                .split(": ")
                .nth(1),
            Some(&*format!("{expected}the end of the file"))
        );
    }
    for line in ["lookup_table default\n", "\nLOOKUP_TABLE default\n"] {
        let all = [&head[..], line.as_bytes(), &bytes].concat();
        let scene = scene("a.vtk", points("BINARY", 3, &all), "");
        let radii: Vec<f64> = spheres(&scene).iter().map(|sphere| sphere[3]).collect();
        assert_eq!(radii, [1.0, 2.156_25, 2.0]);
    }
}

/// Eight to a byte where they are binary, of points and of cells.
#[test]
fn bits_are_unpacked() {
    let table = "LOOKUP_TABLE default\n";
    let bits = format!("SCALARS m bit 1\n{table}");
    let field = "FIELD f 2\na 3 2 bit\n";
    let radii = format!("\nSCALARS radius float 1\n{table}");
    let cells = format!("\nCELL_DATA 9\n{bits}");
    let values = [1.0_f32; 10].iter().flat_map(|x| x.to_be_bytes());
    let values: Vec<u8> = values.collect();
    let binary = [
        bits.as_bytes(),
        &[0b0100_0000, 0b0100_0000],
        radii.as_bytes(),
        &values,
        cells.as_bytes(),
        &[0xff, 0x80],
        b"\n",
    ];
    let digits = format!("{bits}0 1 0 0 0 0 0 0 0 1{radii}{}", "1 ".repeat(10));
    for file in [
        points("BINARY", 10, &binary.concat()),
        points("ASCII", 10, digits.as_bytes()),
    ] {
        let scene = scene("a.vtk", file, "keep: [(\"m\", Is(1))]");
        assert_eq!(spheres(&scene).len(), 2);
        assert_eq!(warnings(&scene), "");
    }
    let file = [
        field.as_bytes(),
        &[0b1000_0100],
        b"\nradius 1 2 bit\n",
        &[0xc0],
    ]
    .concat();
    for (column, expected) in [("a_1", 1), ("a_2", 0), ("a_3", 1)] {
        let fields = format!("keep: [(\"{column}\", Is(1))]");
        let kept = load("a.vtk", points("BINARY", 2, &file), &fields);
        assert_eq!(
            kept.map_or(0, |scene| spheres(&scene).len()),
            expected,
            "{column}"
        );
    }
    assert_eq!(
        refusal(
            "a.vtk",
            points("BINARY", 10, &[bits.as_bytes(), &[0]].concat()),
            "radius: 1"
        ),
        "a.vtk: expected 2 bytes of numbers, found 1"
    );
}

#[test]
fn numbers_of_compressed_files_are_counted() {
    let refused = |file: &[u8], expected: &str| {
        let message = refusal("a.vtk.gz", gzip(file), "radius: 1");
        let words = message.contains(expected) && message.contains("decompress it if you want");
        assert!(words, "{message}");
    };
    for format in ["ASCII", "BINARY"] {
        let most = "expected at most 131072 points in a compressed file of";
        refused(&points(format, 140_000, b""), most);
        let few = gzip(&points(format, 130_000, b""));
        assert_eq!(spheres(&scene("a.vtk.gz", few, "radius: 1")).len(), 130_000);
    }
    let wide = points("ASCII", 1000, b"FIELD f 1\nv 9000 1000 float\n");
    refused(
        &wide,
        "expected numbers of at most 67108864 bytes in a compressed file of",
    );
    // Those of cells are not kept.
    let cells = "CELL_DATA 9000000\nSCALARS position float\nLOOKUP_TABLE default\n1 2\n";
    let message = refusal(
        "a.vtk.gz",
        gzip(&points("ASCII", 1, cells.as_bytes())),
        "radius: 1",
    );
    assert!(
        message.contains("expected 9000000 numbers (2 read)"),
        "{message}"
    );
}

#[test]
fn numbers_of_cells_are_no_positions() {
    let cells = b"CELL_DATA 1\nVECTORS position float\n4 5 6\n";
    let scene = scene("a.vtk", points("ASCII", 2, cells), "radius: 1");
    assert_eq!(spheres(&scene), [[0.0, 0.0, 0.0, 1.0]; 2]);
}

/// A small file may leave out millions of arrays.
#[test]
fn arrays_that_are_left_out_are_said_up_to_a_hundred_times() {
    let arrays = format!("FIELD f 1000\n{}", "a 1 0 float\n".repeat(1000));
    let scene = scene("a.vtk", points("ASCII", 1, arrays.as_bytes()), "radius: 1");
    assert_eq!(
        warnings(&scene).matches("the array `a` has 0 rows").count(),
        100
    );
}

/// Every component has the name of its array.
#[test]
fn long_names_are_not_multiplied() {
    let arrays = format!("FIELD f 1\n{} 9000 1 float\n", "n".repeat(500_000));
    let file = points("ASCII", 1, (arrays + &"0 ".repeat(9000)).as_bytes());
    let scene = scene("a.vtk", file, "radius: 1");
    assert_eq!(spheres(&scene).len(), 1);
    let long = crate::table::columns::components(&"n".repeat(500_000), 9);
    assert!(long.iter().all(|name| name.len() < 1010));
    assert!(long[8].ends_with("n_9"));
}

/// Components lie side by side.
#[test]
fn binary_numbers_are_refused_by_their_byte() {
    let mut file = points("BINARY", 2, b"");
    let start = file.len() - b"\nPOINT_DATA 2\n".len() - 24;
    let at = start + 4 * 4;
    file[at..at + 4].copy_from_slice(&f32::NAN.to_be_bytes());
    let message = refusal("a.vtk", file, "radius: 1");
    assert!(message.contains(&format!("byte {at}")), "{message}");
}
