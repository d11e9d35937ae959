//! VTK XML: files of the packages `vtk` 9.7.2 and `meshio` 5.3.5, in every encoding; damaged files.

use super::super::{Coloring, ColumnRef, Frames, Paint, Request, Value};
use super::compressed::gzip;
use super::*;

/// A file for tests, its bytes, and the number of its points.
macro_rules! file {
    ($name:literal, $count:literal) => {
        (
            $name,
            include_bytes!(concat!("../../../../../tests/seeds/tables/", $name)) as &[u8],
            $count,
        )
    };
}
/// The files of a cloud of points whose numbers follow from their index, and how many points there are. `vtk` reads the
/// same numbers from each.
pub(super) const FILES: [(&str, &[u8], usize); 14] = [
    file!("ascii.vtu", 5),
    file!("binary.vtu", 5),
    file!("binary_big_64.vtu", 5),
    file!("binary_zlib.vtu", 5),
    file!("raw.vtu", 5),
    file!("raw_64_big.vtu", 5),
    file!("raw_zlib.vtu", 150),
    file!("base64.vtu", 5),
    file!("base64_zlib.vtu", 150),
    file!("points.vtp", 5),
    file!("pieces.vtu", 24),
    file!("meshio.vtu", 5),
    file!("meshio_ascii.vtu", 5),
    file!("meshio_plain.vtu", 5),
];

/// Centers and radii of so many points. Three pieces have the same eight.
fn expected(count: usize) -> Vec<[f64; 4]> {
    let sphere = |index: usize| {
        let index = if count == 24 { index % 8 } else { index };
        let i = index as f64;
        let turn = (index % 3) as f64;
        let size = (index % 4) as f64;
        [0.5 * i + 0.25, -1.25 * i, turn + 0.125, 0.25 + 0.125 * size]
    };
    (0..count).map(sphere).collect()
}

#[test]
fn every_encoding_is_read() {
    for (name, bytes, count) in FILES {
        let plain = scene(name, bytes, "");
        assert_eq!(spheres(&plain), expected(count), "{name}");
        assert_eq!(warnings(&plain), "", "{name}");
        let packed = scene(&format!("{name}.gz"), gzip(bytes), "");
        assert_eq!(spheres(&packed), expected(count), "{name}.gz");
        // Contents tell the format.
        assert_eq!(spheres(&scene("a", bytes, "")), expected(count), "{name}");
    }
}

#[test]
fn arrays_of_points_are_columns() {
    let folder = Folder::new();
    let velocity = [1, 2, 3].map(|part| ColumnRef::Name(format!("velocity_{part}")));
    for (name, bytes, count) in FILES.into_iter().filter(|file| !file.0.contains("meshio")) {
        let path = folder.0.join(name);
        fs::write(&path, bytes).unwrap();
        let values = |value: Value| {
            let request = Request {
                coloring: Some(Coloring::Value),
                value: Some(value),
                ..Request::default()
            };
            let rows = Frames::open(&path, &|_, _| {}).unwrap().read(&request);
            match rows.unwrap().unwrap().paint {
                Paint::Values(values) => values,
                other => panic!("{other:?}"),
            }
        };
        let lengths = values(Value::Length(velocity.clone()));
        let numbers = values(Value::Column(ColumnRef::Name(String::from("id"))));
        for index in 0..count {
            let i = if count == 24 { index % 8 } else { index } as f64;
            assert!(
                (lengths[index] - i * libm::sqrt(6.0)).abs() < 1e-9,
                "{name}"
            );
            assert_eq!(numbers[index], 7.0 * i, "{name}");
        }
    }
}

/// The rows of the bytes, as a table of this name.
fn read(path: &Path, bytes: &[u8]) -> Option<Vec<Sphere>> {
    fs::write(path, bytes).unwrap();
    let rows =
        Frames::open(path, &|_, _| {}).and_then(|mut frames| frames.read(&Request::default()));
    // To write over a file takes longer than to write another one.
    fs::remove_file(path).unwrap();
    Some(rows.ok()??.spheres)
}

/// Files below this size are cut at each of their bytes, and altered at one in five.
const SMALL: usize = 1200;

#[test]
fn files_that_are_cut_or_altered_are_refused_or_read() {
    let folder = Folder::new();
    for (number, (name, bytes, count)) in FILES.into_iter().enumerate() {
        let path = folder.0.join(name);
        // Every byte of small files; of large ones, which have much in common, others in each.
        let step = if bytes.len() < SMALL { 1 } else { 7 };
        let whole = read(&path, bytes).unwrap();
        assert_eq!(whole.len(), count);
        for end in (number % step..bytes.len()).step_by(step) {
            if let Some(found) = read(&path, &bytes[..end]) {
                // What points do not need may be missing.
                assert!(found == whole, "{name} cut at byte {end}");
            }
        }
        for at in (number % 5..bytes.len()).step_by(3 * step) {
            let mut altered = bytes.to_vec();
            altered[at] ^= 1 << (at % 8);
            let found = read(&path, &altered).unwrap_or_default();
            assert!(found.len() <= 1000, "{name} altered at byte {at}");
        }
    }
}

#[test]
fn what_is_not_read_is_refused_with_its_place() {
    let bytes = |name: &str| {
        let mut files = FILES.iter();
        let (_, bytes, _) = files.find(|file| file.0 == name).unwrap();
        String::from_utf8_lossy(bytes).into_owned()
    };
    for (_, bytes, _) in [file!("lz4.vtu", 5), file!("lzma.vtu", 5)] {
        let message = refusal("a.vtu", bytes, "");
        assert!(
            message.starts_with("a.vtu:1:1: expected no compressor, or `vtkZLibDataCompressor`"),
            "{message}"
        );
    }
    let ascii = bytes("ascii.vtu");
    let altered = |from: &str, to: &str| {
        assert!(ascii.contains(from), "{from}");
        refusal("a.vtu", ascii.replacen(from, to, 1), "")
    };
    for (from, to, expected) in [
        (
            "NumberOfPoints=\"5\"",
            "NumberOfPoints=\"6\"",
            "a.vtu:31:9: expected 18 numbers for this array, found 15",
        ),
        (
            "NumberOfPoints=\"5\"",
            "",
            "a.vtu:3:5: expected a whole number as `NumberOfPoints`",
        ),
        (
            "NumberOfPoints=\"5\"",
            "NumberOfPoints=\"99999999999\"",
            "expected at most 131072 points in a file of 2180 bytes, found 99999999999",
        ),
        (
            "0.375",
            "0.3x75",
            "expected 5 numbers for this array (1 read), found 0.3x75",
        ),
        (
            "0.375",
            "-0.375",
            "a.vtu: row 2, column 4: expected a radius greater than 0 for `radius`, found -0.375",
        ),
        (
            "Float64",
            "Float80",
            "a.vtu:5:9: expected a type of numbers such as",
        ),
        (
            "\"ascii\"",
            "\"hex\"",
            "a.vtu:5:9: expected the format `ascii`, `binary` or `appended`",
        ),
        (
            "LittleEndian",
            "MiddleEndian",
            "a.vtu:1:1: expected the byte order",
        ),
        ("UInt32", "UInt8", "a.vtu:1:1: expected the header type"),
        (
            "<Points>",
            "<Ponts>",
            "a.vtu:3:5: expected `<Points>` with an array in this piece",
        ),
    ] {
        let message = altered(from, to);
        assert!(message.contains(expected), "{message}");
    }
    let raw = include_bytes!("../../../../../tests/seeds/tables/raw.vtu");
    let mut negative = raw.to_vec();
    let start = memchr::memmem::find(raw, b" _").unwrap() + 2;
    // The length of the radii, and the second of them.
    let second = start + 4 + 8;
    negative[second..second + 8].copy_from_slice(&(-1.5_f64).to_le_bytes());
    assert_eq!(
        refusal("a.vtu", negative, ""),
        format!(
            "a.vtu: row 2, column 4, byte {second}: expected a radius greater than 0 for `radius`, found -1.5"
        )
    );
    let mut short = raw.to_vec();
    short[start] = 39;
    assert_eq!(
        refusal("a.vtu", short, ""),
        "a.vtu:5:9: expected 40 bytes of numbers for this array, found 39"
    );
}

/// Pieces may refer to the same numbers, as often as there is room for tags.
#[test]
fn pieces_do_not_multiply_points() {
    let piece = "<Piece NumberOfPoints=\"10000\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" \
                 format=\"appended\" offset=\"0\"/></Points></Piece>\n";
    let mut file = format!(
        "<VTKFile type=\"PolyData\"><PolyData>\n{}</PolyData><AppendedData encoding=\"raw\">_",
        piece.repeat(1000)
    )
    .into_bytes();
    file.extend(120_000_u32.to_le_bytes());
    file.extend([0; 120_000]);
    let message = refusal("a.vtp", file, "radius: 1");
    assert!(message.contains("expected at most"), "{message}");
}

#[test]
fn pieces_have_the_same_arrays() {
    let array = |name: &str, numbers: &str| {
        format!(
            "<DataArray type=\"Float32\" Name=\"{name}\" format=\"ascii\">{numbers}</DataArray>"
        )
    };
    let piece = |points: usize, rest: &str| {
        let numbers = "1 2 3 ".repeat(points);
        format!(
            "<Piece NumberOfPoints=\"{points}\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">{numbers}\
             </DataArray></Points><PointData>{rest}</PointData></Piece>\n"
        )
    };
    let file = |pieces: &[String]| {
        let pieces = pieces.concat();
        format!("<VTKFile type=\"PolyData\"><PolyData>\n{pieces}</PolyData></VTKFile>")
    };
    let radii = array("radius", "4 5");
    let both = file(&[
        piece(0, ""),
        piece(2, &radii),
        piece(1, &array("radius", "6")),
    ]);
    let found = spheres(&scene("a.vtp", both, ""));
    assert_eq!(
        found.iter().map(|sphere| sphere[3]).collect::<Vec<_>>(),
        [4.0, 5.0, 6.0]
    );
    let other = file(&[piece(2, &radii), piece(1, &array("size", "6"))]);
    assert_eq!(
        refusal("a.vtp", &other, ""),
        "a.vtp:3:1: expected the array `radius` of 1 components in this piece as in the first one, found none"
    );
    assert_eq!(spheres(&scene("a.vtp", other, "radius: 1")).len(), 3);
    let text = "<Array type=\"String\" Name=\"label\" format=\"ascii\">65 0 66 0</Array>";
    let scene = scene("a.vtp", file(&[piece(2, text)]), "radius: 1");
    assert!(warnings(&scene).ends_with("an array of texts: it is not read"));
}
