//! Vertices, as text and as bytes.

use super::*;

const PLY_FIELDS: &str = "comment by hand
element vertex 2
property float x
property float y
property double z
property float32 radius
property uchar red
property uint8 green
property uchar blue
property short charge
element face 1
property list uchar int vertex_indices
end_header
";

/// The rows of [`TWO`], colored.
fn ply_rows() -> Vec<u8> {
    let mut bytes = Vec::new();
    for ([x, y, z, radius], color) in TWO.iter().zip([[255, 0, 128], [1, 2, 3]]) {
        bytes.extend(floats(&[*x as f32, *y as f32]));
        bytes.extend(doubles(&[*z]));
        bytes.extend(floats(&[*radius as f32]));
        bytes.extend(color);
        bytes.extend((-3_i16).to_le_bytes());
    }
    bytes
}

pub(super) fn binary_ply() -> Vec<u8> {
    let header = format!("ply\nformat binary_little_endian 1.0\n{PLY_FIELDS}");
    let mut bytes = header.into_bytes();
    bytes.extend(ply_rows());
    bytes
}

#[test]
fn ply_is_read() {
    let text = format!(
        "ply\nformat ascii 1.0\n{PLY_FIELDS}1 -2.5 3e-3 0.5 255 0 128 -3\n4 5 6 7 1 2 3 -3\n3 0 1 2\n"
    );
    let windows = text.replace('\n', "\r\n");
    for bytes in [text.into_bytes(), windows.into_bytes(), binary_ply()] {
        let scene = scene("a.ply", bytes, "");
        assert_eq!(spheres(&scene), TWO);
        let expected = [0xff0080, 0x010203].map(from_srgb);
        for (found, expected) in albedos(&scene).into_iter().zip(expected) {
            assert!((found - expected).abs().max_element() < 1e-7);
        }
    }
    let scene = scene("a.ply", binary_ply(), "value: \"charge\", radius: 2");
    let middle = Colormap::Viridis.colors()[128];
    assert_eq!(albedos(&scene), [middle; 2]);
    assert_eq!(spheres(&scene)[0][3], 2.0);
}

#[test]
fn ply_is_refused_at_its_place() {
    for (text, expected) in [
        ("", "a.ply:1:1: expected `ply`, found the end of the file"),
        (
            "plyx\n",
            "a.ply:1:1: expected `ply`, the first line of a PLY file, found `plyx`",
        ),
        (
            "ply\n",
            "a.ply:2:1: expected `end_header`, found the end of the file",
        ),
        (
            "ply\nformat binary 1.0\n",
            "a.ply:2:8: expected `ascii 1.0`, `binary_little_endian 1.0` or `binary_big_endian 1.0`, found `binary`",
        ),
        (
            "ply\nelement face 3\n",
            "a.ply:2:9: expected the element `vertex` before all others, found `face`",
        ),
        (
            "ply\nelement vertex -3\n",
            "a.ply:2:16: expected the number of vertices, found -3",
        ),
        (
            "ply\nelement vertex 3\nproperty list uchar int x\n",
            "a.ply:3:10: expected a number as the property of a vertex, found `list`",
        ),
        (
            "ply\nelement vertex 3\nproperty flat x\n",
            "a.ply:3:10: expected a type (`char`, `uchar`, `short`, `ushort`, `int`, `uint`, `float` or `double`), found `flat`",
        ),
        (
            "ply\nend_header\n",
            "a.ply:2:1: expected a line `format …` before, found `end_header`",
        ),
        (
            "ply\nformat ascii 1.0\nend_header\n",
            "a.ply:3:1: expected a line `element vertex …` before, found `end_header`",
        ),
        (
            "ply\nvertices\n",
            "a.ply:2:1: expected `element …`, `property …`, `comment …` or `end_header`, found `vertices`",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
            "a.ply:5:1: expected a column `y`, found `x`",
        ),
    ] {
        assert_eq!(refusal("a.ply", text, ""), expected);
    }
    let head = format!("ply\nformat ascii 1.0\n{PLY_FIELDS}");
    let rows = "1 2 3 4 5 6 7 8\n";
    for (body, expected) in [
        (
            String::from(rows),
            "a.ply:17:1: expected 2 vertices, according to the header (1 read), found the end \
             of the file",
        ),
        (
            format!("{rows}1 2 3 4 5 6 256 8\n"),
            "a.ply:17:13: expected a whole number from 0 to 255 for `blue`, found 256",
        ),
        (
            format!("{rows}1 2 3 4 5 6\n"),
            "a.ply:17:12: expected a number for `blue`, found the end of the line",
        ),
    ] {
        assert_eq!(refusal("a.ply", format!("{head}{body}"), ""), expected);
    }
}

#[test]
fn binary_ply_is_refused_by_row_and_byte() {
    let good = binary_ply();
    let start = good.len() - 2 * 25;
    let cut = &good[..good.len() - 1];
    assert_eq!(
        refusal("a.ply", cut, ""),
        "a.ply: expected 2 vertices of 25 bytes, 50 bytes in all, found 49"
    );
    let mut bad = good.clone();
    let at = start + 25 + 16;
    bad[at..at + 4].copy_from_slice(&0_f32.to_le_bytes());
    let expected = format!(
        "a.ply: row 2, column 4, byte {at}: expected a radius greater than 0 for `radius`, found 0"
    );
    assert_eq!(refusal("a.ply", bad, ""), expected);
    let text = String::from_utf8_lossy(&good[..start]).into_owned();
    for (count, size) in [
        ("99999999999", "2499999999975"),
        ("18446744073709551615", "461168601842738790375"),
    ] {
        let header = text.replace("vertex 2", &format!("vertex {count}"));
        let expected =
            format!("a.ply: expected {count} vertices of 25 bytes, {size} bytes in all, found 0");
        assert_eq!(refusal("a.ply", header, ""), expected);
    }
}
